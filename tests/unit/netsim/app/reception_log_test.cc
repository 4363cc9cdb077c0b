#include "netsim/app/reception_log.h"

#include <sys/mman.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "common/posix/check.h"
#include "tests/unit/netsim/app/instants.h"

namespace cuscus::netsim {
namespace {

using logs::Cause;
using logs::ReceptionLogRecord;

/// Nodes that fly east at different speeds and turn, seen anew every millisecond.
class MovingFleet final : public PositionSource {
 public:
  explicit MovingFleet(std::vector<Eigen::Vector3d> starts)
      : starts_{std::move(starts)}, p_WN_{starts_}, q_WN_(starts_.size()) {}

  const std::vector<Eigen::Vector3d>& positions(SimTime now) override {
    const std::int64_t step = to_ns(now) / 1'000'000;
    if (step != step_) {
      step_ = step;
      ++version_;
      const double time_s = static_cast<double>(step) * 1e-3;
      for (std::size_t i = 0; i < starts_.size(); ++i) {
        p_WN_[i] = starts_[i] + Eigen::Vector3d{10.0 * static_cast<double>(i) * time_s, 0.0, 0.0};
        q_WN_[i] = Eigen::AngleAxisd{0.5 * time_s, Eigen::Vector3d::UnitX()};
      }
    }
    return p_WN_;
  }
  std::span<const Eigen::Quaterniond> attitudes() const override { return q_WN_; }
  std::uint64_t version() const override { return version_; }

 private:
  std::vector<Eigen::Vector3d> starts_;
  std::vector<Eigen::Vector3d> p_WN_;
  std::vector<Eigen::Quaterniond> q_WN_;
  std::int64_t step_{-1};
  std::uint64_t version_{1};
};

/// An air that is logged, and the log once it is over.
struct LoggedAir final : public AirListener {
  LoggedAir(std::vector<Eigen::Vector3d> p_WN, const AirParameters& parameters)
      : parameters_{with_nodes(parameters, p_WN.size())},
        names(p_WN.size(), "node"),
        positions{std::move(p_WN)},
        file{posix::check("memfd_create", ::memfd_create("receptions", MFD_CLOEXEC))},
        path{"/proc/self/fd/" + std::to_string(file.get())},
        log{posix::UniqueFd{posix::check("dup", ::dup(file.get()))}, parameters_, names, positions},
        air{parameters_, positions, *this, &log} {}

  void delivered(const Delivery& /*delivery*/) override {}
  void finished(const FrameReport& report) override { log.finished(report); }

  static AirParameters with_nodes(AirParameters parameters, std::size_t nodes) {
    parameters.nodes.assign(nodes, AirNode{.tx_power = {15.0}, .antenna_gain = {1.5}});
    return parameters;
  }

  /// Ends the log.
  std::vector<ReceptionLogRecord> records() {
    missing = log.finish();
    std::ifstream stream{path, std::ios::binary};
    logs::ReceptionLogHeader header{};
    stream.read(reinterpret_cast<char*>(&header), sizeof header);
    REQUIRE(header.magic == logs::ReceptionLogHeader::kMagic);
    REQUIRE(header.record_bytes == sizeof(ReceptionLogRecord));
    REQUIRE(header.name_bytes == 5 * names.size());
    stream.ignore(header.name_bytes);
    std::vector<ReceptionLogRecord> all;
    ReceptionLogRecord record{};
    while (stream.read(reinterpret_cast<char*>(&record), sizeof record)) {
      all.push_back(record);
    }
    return all;
  }

  AirParameters parameters_;
  std::vector<std::string> names;
  MovingFleet positions;
  posix::UniqueFd file;
  std::string path;
  ReceptionLog log;
  Air air;
  std::uint64_t missing{0};
};

TEST_CASE("the terms of every budget add up to the power that the air reckoned with") {
  // Everything that the channel has, on nodes that move and turn while frames are on the air.
  AirParameters parameters;
  parameters.channel.model = "log-distance";
  parameters.channel.exponent = 2.5;
  parameters.channel.shadowing_db = 4.0;
  parameters.channel.fading = "rice";
  parameters.antenna.model = "dipole";
  LoggedAir field{{{0.0, 0.0, 20.0}, {60.0, 5.0, 30.0}, {150.0, 80.0, 60.0}, {400.0, 0.0, 40.0}},
                  parameters};

  for (int i = 0; i < 400; ++i) {
    const auto node = static_cast<std::uint32_t>(i) % 4;
    field.air.offer(node, at_us(std::int64_t{i} * 700),
                    {.id = static_cast<std::uint64_t>(i) + 1,
                     .destination = i % 2 == 0 ? kGroup : static_cast<std::int32_t>((node + 1) % 4),
                     .psdu_bytes = 1'000});
  }
  field.air.run_until(at_us(2'000'000));
  const auto records = field.records();

  REQUIRE(records.size() > 600);
  CHECK(field.missing == 0);
  std::size_t faded = 0;
  for (const ReceptionLogRecord& record : records) {
    if (record.kind != logs::RecordKind::kReception) {
      continue;
    }
    // Seven floats of some 100 dB, each rounded to 4e-6 dB.
    CHECK(record.budget.power_dbm() == Approx(record.power_dbm).margin(5e-5));
    CHECK(record.budget.tx_power_dbm == 15.0F);
    CHECK(record.budget.obstacle_loss_db == 0.0F);
    CHECK(record.budget.shadowing_loss_db != 0.0F);
    faded += std::abs(record.budget.fading_loss_db) > 1.0F ? 1U : 0U;
  }
  CHECK(faded > 100);
}

TEST_CASE("a frame out of reach is logged at each of its attempts, and as given up") {
  // Below the floor of -114 dBm.
  LoggedAir field{{{0.0, 0.0, 20.0}, {100'000.0, 0.0, 20.0}}, {}};

  field.air.offer(0, at_us(1'000), {.id = 9, .destination = 1, .psdu_bytes = 128});
  field.air.run_until(at_us(1'000'000));
  const auto records = field.records();

  REQUIRE(records.size() == 8);
  for (std::uint16_t i = 0; i < 7; ++i) {
    CHECK(records[i].cause == Cause::kBelowFloor);
    CHECK(records[i].attempt == i + 1);
    CHECK(records[i].receiver == 1);
    CHECK(records[i].frame == 9);
    // 15 dBm, 1.5 dB at each end, less 140.09 dB of free space at 100 km and 2.412 GHz.
    CHECK(records[i].power_dbm == Approx(15.0 + 3.0 - 140.09).margin(0.01));
    CHECK(std::isnan(records[i].sinr_db));
  }
  CHECK(records[7].kind == logs::RecordKind::kGivenUp);
  CHECK(records[7].cause == Cause::kRetryLimit);
  CHECK(records[7].attempt == 7);
  CHECK(records[7].begins_ns == 1'000'000);
  CHECK(records[7].destination == 1);
}

TEST_CASE("a collision names the other sender, and what was overheard is not logged") {
  // 0 and 2 send at once; 1, between them, hears neither.
  LoggedAir field{{{0.0, 0.0, 20.0}, {30.0, 0.0, 20.0}, {60.0, 0.0, 20.0}}, {}};

  field.air.offer(0, at_us(0), {.id = 1, .destination = kGroup, .psdu_bytes = 128});
  field.air.offer(2, at_us(0), {.id = 2, .destination = 1, .psdu_bytes = 128});
  field.air.run_until(at_us(260));
  const auto records = field.records();

  std::size_t at_1 = 0;
  for (const ReceptionLogRecord& record : records) {
    if (record.receiver == 1) {
      ++at_1;
      CHECK(record.cause == Cause::kCollision);
      CHECK(record.interferer == 2 - record.sender);
      CHECK(record.sinr_db == Approx(0.0).margin(0.1));
    } else {
      // The group frame at 2, which was sending; what 2 sent to 1 is not 0's affair.
      CHECK(record.sender == 0);
      CHECK(record.receiver == 2);
      CHECK(record.cause == Cause::kHalfDuplex);
    }
  }
  CHECK(at_1 == 2);
  CHECK(records.size() == 3);
}

TEST_CASE("what finds no place in the queue, or in the interface, is logged with its cause") {
  AirParameters parameters;
  parameters.queue_frames = 1;
  LoggedAir field{{{0.0, 0.0, 20.0}, {30.0, 0.0, 20.0}}, parameters};

  field.air.offer(0, at_us(0), {.id = 1, .destination = kGroup, .psdu_bytes = 128});
  field.air.offer(0, at_us(10), {.id = 2, .destination = kGroup, .psdu_bytes = 128});
  field.air.run_until(at_us(10'000));
  field.log.copy_lost(1, 0, 1, at_us(400), Cause::kLinkDown);
  const auto records = field.records();

  REQUIRE(records.size() == 3);
  CHECK(records[0].kind == logs::RecordKind::kGivenUp);
  CHECK(records[0].cause == Cause::kQueueFull);
  CHECK(records[0].frame == 2);
  CHECK(records[1].cause == Cause::kReceived);
  CHECK(records[1].frame == 1);
  CHECK(records[2].kind == logs::RecordKind::kCopyLost);
  CHECK(records[2].cause == Cause::kLinkDown);
  CHECK(records[2].frame == 1);
}

}  // namespace
}  // namespace cuscus::netsim
