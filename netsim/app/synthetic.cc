#include "netsim/app/synthetic.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "netsim/air/ideal_air.h"

namespace cuscus::netsim {
namespace {

constexpr std::uint16_t kPhaseStream = 0x1101;

std::vector<Eigen::Vector3d> positions_of(const Layout& layout, std::uint32_t nodes) {
  if (layout.kind == Layout::Kind::kGiven) {
    return layout.p_WN_m;
  }
  std::vector<Eigen::Vector3d> positions;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    switch (layout.kind) {
      case Layout::Kind::kEqualPower:
        positions.emplace_back(0.0, 0.0, 0.0);
        break;
      case Layout::Kind::kCircle: {
        const double angle_rad = 2.0 * std::numbers::pi * i / nodes;
        positions.emplace_back(layout.circle_radius_m * std::cos(angle_rad),
                               layout.circle_radius_m * std::sin(angle_rad), 0.0);
        break;
      }
      case Layout::Kind::kHidden: {
        // Two senders on either side of the sink, which is the last node; see with_nodes().
        const double side = i + 1 == nodes ? 0.0 : (i % 2 == 0 ? -1.0 : 1.0);
        positions.emplace_back(side, 0.0, 0.0);
        break;
      }
      case Layout::Kind::kLine:
        positions.emplace_back(layout.line_spacing_m * i, 0.0, 0.0);
        break;
      case Layout::Kind::kGiven:
        break;
    }
  }
  return positions;
}

/// The traffic of a run and what is counted of it.
class Run final : public AirListener {
 public:
  explicit Run(const SyntheticParameters& parameters)
      : parameters_{parameters},
        nodes_{node_count(parameters)},
        positions_{positions_of(parameters.layout, nodes_), parameters.layout.q_WN},
        air_{make_air(with_nodes(parameters, nodes_), positions_, *this)},
        measured_from_{SimTime{} + parameters.warm_up},
        until_{measured_from_ + parameters.duration},
        delivered_(nodes_, 0),
        beacons_(nodes_, 0) {}

  SyntheticResult run() {
    for (const std::uint32_t node : senders()) {
      switch (parameters_.traffic.kind) {
        case Traffic::Kind::kBeacons:
          offer_next_beacon(node);
          break;
        case Traffic::Kind::kSaturated:
          offer(node, SimTime{});
          offer(node, SimTime{});
          break;
        case Traffic::Kind::kFlow:
        case Traffic::Kind::kPing:
          offer(node, SimTime{});
          break;
      }
    }
    air_->run_until(measured_from_);
    const Attempts before = attempts();
    air_->run_until(until_);
    return result(before);
  }

  void delivered(const Delivery& delivery) override {
    if (parameters_.traffic.kind == Traffic::Kind::kPing) {
      if (delivery.receiver == parameters_.traffic.to) {
        offer(delivery.receiver, delivery.time, static_cast<std::int64_t>(delivery.id));
      } else if (delivery.receiver == parameters_.traffic.from) {
        round_trips_us_.push_back(
            to_seconds(delivery.time - sim_time(static_cast<std::int64_t>(delivery.id))) * 1e6);
      }
    }
    if (delivery.time >= measured_from_) {
      ++delivered_[delivery.sender];
      ++receptions_;
      delays_us_.push_back(
          to_seconds(delivery.time - sim_time(static_cast<std::int64_t>(delivery.id))) * 1e6);
    }
  }

  void finished(const FrameReport& report) override {
    if (report.sent_at >= measured_from_) {
      ++finished_;
      frame_deliveries_ += report.deliveries;
      attempts_ += report.attempts;
      given_up_ += report.outcome == SendOutcome::kRetryLimit ? 1 : 0;
    }
    switch (parameters_.traffic.kind) {
      case Traffic::Kind::kSaturated:
        offer(report.sender, air_->now());
        break;
      case Traffic::Kind::kBeacons:
        offer_next_beacon(report.sender);
        break;
      case Traffic::Kind::kFlow:
      case Traffic::Kind::kPing:
        if (report.sender == parameters_.traffic.from) {
          offer(report.sender, std::max(air_->now(), report.sent_at + parameters_.traffic.period));
        }
        break;
    }
  }

 private:
  static std::uint32_t node_count(const SyntheticParameters& parameters) {
    if (parameters.layout.kind == Layout::Kind::kGiven) {
      return static_cast<std::uint32_t>(parameters.layout.p_WN_m.size());
    }
    return parameters.traffic.to_sink ? parameters.senders + 1 : std::max(parameters.senders, 2U);
  }

  /// Those that send of their own accord.
  [[nodiscard]] std::vector<std::uint32_t> senders() const {
    const Traffic& traffic = parameters_.traffic;
    if (traffic.kind == Traffic::Kind::kFlow || traffic.kind == Traffic::Kind::kPing) {
      return {traffic.from};
    }
    std::vector<std::uint32_t> all(parameters_.senders);
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }

  static AirParameters with_nodes(const SyntheticParameters& parameters, std::uint32_t nodes) {
    AirParameters air = parameters.air;
    if (parameters.layout.kind == Layout::Kind::kGiven) {
      return air;
    }
    air.nodes.assign(nodes, AirNode{});
    if (parameters.layout.kind == Layout::Kind::kEqualPower) {
      air.channel.model = "fixed";
      air.channel.reference_loss = air.nodes.front().tx_power - parameters.layout.equal_power;
    } else if (parameters.layout.kind == Layout::Kind::kHidden) {
      // 1 m from the sink, 2 m from one another: 10 n lg 2 = 120 dB less, far below the floor.
      air.channel.model = "log-distance";
      air.channel.exponent = 40.0;
      air.channel.reference_loss = air.nodes.front().tx_power - parameters.layout.equal_power;
    }
    air.channel.seed = air.seed;
    return air;
  }

  void offer(std::uint32_t node, SimTime at) { offer(node, at, to_ns(at)); }

  /// `id` says when the delay of the frame's delivery is counted from.
  void offer(std::uint32_t node, SimTime at, std::int64_t id) {
    const Traffic& traffic = parameters_.traffic;
    air_->offer(node, at,
                {.id = static_cast<std::uint64_t>(id),
                 .destination = destination_of(node),
                 .psdu_bytes = psdu_bytes_of_udp(traffic.udp_payload_bytes),
                 .priority = traffic.priorities[node % traffic.priorities.size()]});
  }

  [[nodiscard]] std::int32_t destination_of(std::uint32_t node) const {
    const Traffic& traffic = parameters_.traffic;
    const bool ping = traffic.kind == Traffic::Kind::kPing;
    if (traffic.group && !ping) {
      return kGroup;
    }
    if (traffic.to_sink) {
      return static_cast<std::int32_t>(nodes_ - 1);
    }
    if (ping || traffic.kind == Traffic::Kind::kFlow) {
      return static_cast<std::int32_t>(node == traffic.from ? traffic.to : traffic.from);
    }
    return static_cast<std::int32_t>((node + 1) % nodes_);
  }

  void offer_next_beacon(std::uint32_t node) {
    const random::CounterStream stream{parameters_.air.seed, random::stream_id(kPhaseStream, node)};
    const Traffic& traffic = parameters_.traffic;
    const auto scaled = [](Duration duration, double factor) {
      return Duration{static_cast<Duration::rep>(static_cast<double>(duration.count()) * factor)};
    };
    const std::uint64_t beacon = beacons_[node]++;
    const SimTime at = SimTime{} + scaled(traffic.period, stream.uniform(0)) +
                       traffic.period * static_cast<Duration::rep>(beacon) +
                       scaled(traffic.jitter, stream.uniform(beacon + 1));
    offer(node, at);
  }

  /// Data frames on the air and those of them that were acknowledged, of all nodes until now.
  struct Attempts {
    std::uint64_t all{0};
    std::uint64_t acknowledged{0};
  };
  [[nodiscard]] Attempts attempts() const {
    Attempts sum;
    for (std::uint32_t node = 0; node < nodes_; ++node) {
      sum.all += air_->tally(node).transmissions;
      sum.acknowledged += air_->tally(node).acknowledged;
    }
    return sum;
  }

  SyntheticResult result(const Attempts& before) {
    SyntheticResult result;
    const double seconds = to_seconds(parameters_.duration);
    const bool group =
        parameters_.traffic.group && parameters_.traffic.kind != Traffic::Kind::kPing;
    const double receivers = group ? nodes_ - 1.0 : 1.0;
    const double mbps_per_reception =
        8.0 * parameters_.traffic.udp_payload_bytes / receivers / seconds / 1e6;
    const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
    result.goodput_mbps = static_cast<double>(receptions_) * mbps_per_reception;
    result.delivery_ratio =
        ratio(static_cast<double>(frame_deliveries_), static_cast<double>(finished_) * receivers);
    // Not of finished frames only: those that go on and on are not among them.
    const Attempts after = attempts();
    result.attempt_success = ratio(static_cast<double>(after.acknowledged - before.acknowledged),
                                   static_cast<double>(after.all - before.all));
    result.attempts_per_frame =
        ratio(static_cast<double>(attempts_), static_cast<double>(finished_));
    result.drops_per_s = static_cast<double>(given_up_) / seconds;
    double sum = 0.0;
    double squares = 0.0;
    for (const std::uint32_t node : senders()) {
      const double goodput_mbps = static_cast<double>(delivered_[node]) * mbps_per_reception;
      result.sender_goodputs_mbps.push_back(goodput_mbps);
      sum += goodput_mbps;
      squares += goodput_mbps * goodput_mbps;
    }
    result.jain =
        ratio(sum * sum, squares * static_cast<double>(result.sender_goodputs_mbps.size()));
    add_delays(result);
    result.round_trip_mean_us =
        ratio(std::accumulate(round_trips_us_.begin(), round_trips_us_.end(), 0.0),
              static_cast<double>(round_trips_us_.size()));
    result.receptions = receptions_;
    result.events = air_->events();
    for (std::uint32_t node = 0; node < nodes_; ++node) {
      result.tallies.push_back(air_->tally(node));
    }
    return result;
  }

  void add_delays(SyntheticResult& result) {
    if (delays_us_.empty()) {
      return;
    }
    std::sort(delays_us_.begin(), delays_us_.end());
    const auto at = [&](double q) {
      return delays_us_[static_cast<std::size_t>(q * static_cast<double>(delays_us_.size() - 1))];
    };
    result.delay_mean_us = std::accumulate(delays_us_.begin(), delays_us_.end(), 0.0) /
                           static_cast<double>(delays_us_.size());
    result.delay_p50_us = at(0.5);
    result.delay_p99_us = at(0.99);
    result.delay_max_us = delays_us_.back();
  }

  const SyntheticParameters& parameters_;
  std::uint32_t nodes_;
  FixedPositions positions_;
  std::unique_ptr<FrameCarrier> air_;
  SimTime measured_from_;
  SimTime until_;
  std::vector<std::uint64_t> delivered_;
  std::vector<std::uint64_t> beacons_;
  std::vector<double> delays_us_;
  std::vector<double> round_trips_us_;
  std::uint64_t receptions_{0};
  std::uint64_t finished_{0};
  std::uint64_t frame_deliveries_{0};
  std::uint64_t attempts_{0};
  std::uint64_t given_up_{0};
};

}  // namespace

SyntheticResult run_synthetic(const SyntheticParameters& parameters) {
  return Run{parameters}.run();
}

}  // namespace cuscus::netsim
