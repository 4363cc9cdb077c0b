#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "netsim/air/air.h"

namespace cuscus::netsim {
namespace {

constexpr std::uint8_t kUrgent = 7;
constexpr std::uint8_t kOrdinary = 0;

AirParameters edca_air(std::size_t nodes) {
  AirParameters p;
  p.mac = "edca";
  p.nodes.assign(nodes, AirNode{});
  return p;
}

/// Nodes on a line of 150 m steps, each of which always has two frames for its right neighbour or,
/// at every third node, for all.
class Chain final : public AirListener {
 public:
  Chain(const AirParameters& parameters, std::uint32_t psdu_bytes, std::uint8_t priority)
      : psdu_bytes_{psdu_bytes},
        priority_{priority},
        positions_{places(parameters.nodes.size())},
        air{parameters, positions_, *this} {
    for (std::uint32_t node = 0; node < air.node_count(); ++node) {
      offer(node);
      offer(node);
    }
  }
  void delivered(const Delivery& delivery) override { deliveries.push_back(delivery); }
  void finished(const FrameReport& report) override {
    reports.push_back(report);
    offer(report.sender);
  }

 private:
  static std::vector<Eigen::Vector3d> places(std::size_t nodes) {
    std::vector<Eigen::Vector3d> places;
    for (std::size_t i = 0; i < nodes; ++i) {
      places.emplace_back(150.0 * static_cast<double>(i), 0.0, 10.0);
    }
    return places;
  }
  void offer(std::uint32_t node) {
    const auto neighbour = static_cast<std::int32_t>((node + 1) % air.node_count());
    air.offer(node, air.now(),
              {.id = offered_++,
               .destination = node % 3 == 2 ? kGroup : neighbour,
               .psdu_bytes = psdu_bytes_,
               .priority = priority_});
  }

  std::uint32_t psdu_bytes_;
  std::uint8_t priority_;
  std::uint64_t offered_{0};
  FixedPositions positions_;

 public:
  std::vector<Delivery> deliveries;
  std::vector<FrameReport> reports;
  Air air;
};

TEST_CASE("one category with the DCF's parameters is the DCF, frame by frame") {
  // Six nodes over 750 m, 785 m being the range: collisions, retries, EIFS, NAV. QoS frames are 2 B
  // longer.
  const std::uint8_t priority = GENERATE(as<std::uint8_t>{}, 0, 1, 4, 7);
  const std::uint32_t rts_threshold = GENERATE(100U, 10'000U);
  AirParameters parameters = edca_air(6);
  parameters.rts_threshold_bytes = rts_threshold;
  parameters.edca.assign(kAccessCategories, {.aifsn = 2, .cw_min = 15, .cw_max = 1023});
  Chain edca{parameters, 198, priority};
  parameters.mac = "dcf";
  Chain dcf{parameters, 200, priority};

  edca.air.run_until(SimTime{} + std::chrono::milliseconds{500});
  dcf.air.run_until(SimTime{} + std::chrono::milliseconds{500});

  REQUIRE(dcf.reports.size() > 500);
  REQUIRE(edca.reports.size() == dcf.reports.size());
  REQUIRE(edca.deliveries.size() == dcf.deliveries.size());
  bool same = edca.air.events() == dcf.air.events();
  for (std::size_t i = 0; i < dcf.reports.size(); ++i) {
    const FrameReport& a = edca.reports[i];
    const FrameReport& b = dcf.reports[i];
    same = same && a.id == b.id && a.attempts == b.attempts && a.outcome == b.outcome &&
           a.first_delivery == b.first_delivery;
  }
  for (std::size_t i = 0; i < dcf.deliveries.size(); ++i) {
    const Delivery& a = edca.deliveries[i];
    const Delivery& b = dcf.deliveries[i];
    same = same && a.id == b.id && a.time == b.time && a.receiver == b.receiver;
  }
  CHECK(same);
}

TEST_CASE("urgent frames overtake those that wait at their own node") {
  struct Order final : AirListener {
    void delivered(const Delivery& delivery) override { ids.push_back(delivery.id); }
    void finished(const FrameReport& /*report*/) override {}
    std::vector<std::uint64_t> ids;
  } order;
  FixedPositions positions{{{0.0, 0.0, 10.0}, {20.0, 0.0, 10.0}}};
  Air air{edca_air(2), positions, order};

  for (std::uint64_t id = 0; id < 20; ++id) {
    air.offer(0, SimTime{}, {.id = id, .psdu_bytes = 1'000, .priority = kOrdinary});
  }
  air.offer(0, SimTime{}, {.id = 100, .psdu_bytes = 100, .priority = kUrgent});
  air.run_until(SimTime{} + std::chrono::seconds{1});

  // Voice waits for DIFS at most 3 slots long; behind the first frame at the latest comes its turn.
  REQUIRE(order.ids.size() == 21);
  CHECK((order.ids[0] == 100 || order.ids[1] == 100));
}

TEST_CASE("categories that cannot be are refused with what is allowed") {
  const auto error_of = [](const EdcaParameters& edca) {
    AirParameters parameters = edca_air(2);
    parameters.edca = edca;
    try {
      Chain chain{parameters, 200, kOrdinary};
    } catch (const std::invalid_argument& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };
  const EdcaCategory good{.aifsn = 2, .cw_min = 3, .cw_max = 7};

  CHECK(error_of({good, good, good, good}).empty());
  CHECK_THAT(error_of({good}), Catch::Contains("EDCA has 4 categories"));
  CHECK_THAT(error_of({good, good, good, {1, 3, 7}}), Catch::Contains("must be 2 ... 15"));
  CHECK_THAT(error_of({good, good, good, {2, 15, 7}}), Catch::Contains("must not be above"));
}

}  // namespace
}  // namespace cuscus::netsim
