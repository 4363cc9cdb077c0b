#include "netsim/air/ideal_air.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "netsim/air/event_rank.h"

namespace cuscus::netsim {
namespace {

/// Purpose of a random stream (see random::stream_id).
constexpr std::uint16_t kIdealStream = 0x1040;
constexpr std::uint64_t kDrawsPerArrival = 2;

void require_ideal(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"radio: " + rule};
  }
}

/// Bits of the Ethernet frame that a PSDU carries, at a rate, rounded up to whole nanoseconds.
Duration sending_time(std::uint32_t psdu_bytes, const Mode& mode) {
  constexpr std::uint32_t kMoreInPsdu_bytes =
      psdu_bytes_of_ethernet(kEthernetHeaderBytes) - kEthernetHeaderBytes;
  assert(psdu_bytes >= kMoreInPsdu_bytes);
  const std::uint64_t bits_e6 = std::uint64_t{8'000'000} * (psdu_bytes - kMoreInPsdu_bytes);
  return Duration{static_cast<Duration::rep>((bits_e6 + mode.rate_kbps - 1) / mode.rate_kbps)};
}

}  // namespace

IdealAir::IdealAir(const AirParameters& parameters, PositionSource& positions,
                   AirListener& listener, AirMonitor* monitor)
    : ideal_{parameters.ideal},
      data_mode_{&standard_of(parameters.standard).mode(parameters.data_rate_kbps)},
      group_mode_{&standard_of(parameters.standard).mode(parameters.group_rate_kbps)},
      queue_frames_{parameters.queue_frames},
      queue_lifetime_{parameters.queue_lifetime},
      positions_{&positions},
      listener_{&listener},
      monitor_{monitor} {
  require_ideal(ideal_.jitter >= Duration::zero() && ideal_.jitter <= ideal_.delay,
                "the jitter of the ideal air must be 0 ... its delay");
  require_ideal(ideal_.loss >= 0.0 && ideal_.loss <= 1.0, "a loss must be 0 ... 1");
  require_ideal(ideal_.range_m > 0.0, "the range must be above 0 m");
  require_ideal(queue_frames_ >= 1, "the queue must hold at least 1 frame");
  require_ideal(!parameters.nodes.empty() && parameters.nodes.size() <= 65'535,
                "there must be 1 to 65535 nodes");
  require_ideal(positions.positions(SimTime{}).size() >= parameters.nodes.size(),
                "a node has no position");
  if (parameters.disruption.fraction != 0.0) {
    disruption_.emplace(parameters.disruption);
  }
  nodes_.resize(parameters.nodes.size());
  for (std::uint32_t node = 0; node < node_count(); ++node) {
    nodes_[node].tx_power = parameters.nodes[node].tx_power;
    nodes_[node].draws = {parameters.seed, random::stream_id(kIdealStream, node)};
  }
}

void IdealAir::offer(std::uint32_t node, SimTime sent_at, const OfferedFrame& offered) {
  assert(node < nodes_.size());
  const std::uint32_t number = frames_.take();
  Frame& frame = frames_[number];
  frame = {};
  frame.report = FrameReport::of(node, sent_at, offered);
  frame.queued_at = std::max(sent_at, now_);
  queue_.schedule(frame.queued_at, event_rank(EventRank::kOffer, node),
                  {.kind = Step::Kind::kOffer, .frame = number});
}

bool IdealAir::run_next(SimTime limit) {
  if (queue_.empty() || queue_.next_time() > limit) {
    return false;
  }
  const auto event = queue_.pop();
  now_ = event.time;
  ++events_;
  const Step& step = event.payload;
  switch (step.kind) {
    case Step::Kind::kOffer:
      enqueue(step.frame);
      break;
    case Step::Kind::kSent: {
      const std::uint32_t node = frames_[step.frame].report.sender;
      nodes_[node].queue.pop_front();
      send_next(node);
      ++nodes_[node].tally.sent;
      end(step.frame, SendOutcome::kSent);
      break;
    }
    case Step::Kind::kArrival:
      arrive(step);
      break;
  }
  return true;
}

void IdealAir::run_until(SimTime limit) {
  while (run_next(limit)) {
  }
  now_ = std::max(now_, limit);
}

std::optional<SimTime> IdealAir::next_event() const {
  return queue_.empty() ? std::nullopt : std::optional{queue_.next_time()};
}

/// Nothing arrives before the next event: it is an arrival itself, or lets a sending begin or end.
std::optional<SimTime> IdealAir::next_delivery_bound() const { return next_event(); }

void IdealAir::enqueue(std::uint32_t frame) {
  const std::uint32_t sender = frames_[frame].report.sender;
  Node& node = nodes_[sender];
  ++node.tally.offered;
  ++frames_[frame].under_way;
  if (node.queue.size() >= queue_frames_) {
    ++node.tally.dropped_queue_full;
    end(frame, SendOutcome::kQueueFull);
    return;
  }
  node.queue.push_back(frame);
  if (node.queue.size() == 1) {
    send_next(sender);
  }
}

void IdealAir::send_next(std::uint32_t sender) {
  Node& node = nodes_[sender];
  while (!node.queue.empty() && now_ - frames_[node.queue.front()].queued_at > queue_lifetime_) {
    const std::uint32_t expired = node.queue.front();
    node.queue.pop_front();
    ++node.tally.dropped_lifetime;
    end(expired, SendOutcome::kLifetime);
  }
  if (node.queue.empty()) {
    return;
  }
  const std::uint32_t number = node.queue.front();
  Frame& frame = frames_[number];
  const Mode& mode = mode_of(frame.report);
  const auto& positions = positions_->positions(now_);
  ++node.tally.transmissions;
  frame.report.attempts = 1;
  frame.ppdu = {.frame = {.sender = sender,
                          .receiver = frame.report.destination,
                          .sequence = static_cast<std::uint32_t>(node.transmissions + 1)},
                .mode = &mode,
                .psdu_bytes = frame.report.psdu_bytes,
                .attempt = 1,
                .number = node.transmissions++,
                .offer_id = frame.report.id,
                .begins = now_,
                .ends = now_ + sending_time(frame.report.psdu_bytes, mode),
                .positions_version = positions_->version()};
  if (monitor_ != nullptr) {
    monitor_->transmitted(frame.ppdu);
  }
  queue_.schedule(frame.ppdu.ends, event_rank(EventRank::kFinish, sender),
                  {.kind = Step::Kind::kSent, .frame = number});
  spread(number, positions);
}

const Mode& IdealAir::mode_of(const FrameReport& report) const {
  return report.destination == kGroup ? *group_mode_ : *data_mode_;
}

/// Works out who gets a frame whose sending begins.
void IdealAir::spread(std::uint32_t number, const std::vector<Eigen::Vector3d>& positions) {
  const FrameReport& report = frames_[number].report;
  const auto reach = [&](std::uint32_t receiver) {
    schedule_arrival(number, receiver, (positions[receiver] - positions[report.sender]).norm());
  };
  if (report.destination >= 0) {
    reach(static_cast<std::uint32_t>(report.destination));
  } else if (report.destination == kGroup) {
    for (std::uint32_t receiver = 0; receiver < node_count(); ++receiver) {
      if (receiver != report.sender) {
        reach(receiver);
      }
    }
  }
}

void IdealAir::schedule_arrival(std::uint32_t number, std::uint32_t receiver, double distance_m) {
  Frame& frame = frames_[number];
  if (distance_m > ideal_.range_m) {
    nodes_[receiver].tally.count(LossCause::kBelowFloor);
    frame.report.last_loss = LossCause::kBelowFloor;
    if (monitor_ != nullptr) {
      monitor_->unreached(frame.ppdu, receiver);
    }
    return;
  }
  const random::CounterStream& draws = nodes_[frame.report.sender].draws;
  const std::uint64_t draw = (frame.ppdu.number * node_count() + receiver) * kDrawsPerArrival;
  LossCause cause = LossCause::kNone;
  if (disruption_ && disruption_->overlaps(frame.ppdu.begins, frame.ppdu.ends)) {
    cause = LossCause::kJammed;
  }
  if (draws.uniform(draw) < ideal_.loss) {
    cause = LossCause::kNoise;
  }
  const double jitter_ns =
      static_cast<double>(ideal_.jitter.count()) * (2.0 * draws.uniform(draw + 1) - 1.0);
  ++frame.under_way;
  queue_.schedule(
      frame.ppdu.ends + ideal_.delay + Duration{std::llround(jitter_ns)},
      event_rank(EventRank::kSweep, receiver),
      {.kind = Step::Kind::kArrival, .cause = cause, .frame = number, .receiver = receiver});
}

void IdealAir::arrive(const Step& step) {
  Frame& frame = frames_[step.frame];
  const DecibelMilliwatt power = nodes_[frame.report.sender].tx_power;
  if (monitor_ != nullptr) {
    monitor_->received(frame.ppdu, {.receiver = step.receiver,
                                    .time = now_,
                                    .cause = step.cause,
                                    .power = power,
                                    .sinr = {std::numeric_limits<double>::quiet_NaN()}});
  }
  if (step.cause != LossCause::kNone) {
    nodes_[step.receiver].tally.count(step.cause);
    frame.report.last_loss = step.cause;
  } else {
    ++nodes_[step.receiver].tally.received;
    if (frame.report.deliveries++ == 0) {
      frame.report.first_delivery = now_;
    }
    const Delivery delivery{.time = now_,
                            .id = frame.report.id,
                            .sender = frame.report.sender,
                            .receiver = step.receiver,
                            .received_power = power};
    listener_->delivered(delivery);
  }
  release(step.frame);
}

void IdealAir::end(std::uint32_t frame, SendOutcome outcome) {
  frames_[frame].report.outcome = outcome;
  release(frame);
}

void IdealAir::release(std::uint32_t number) {
  Frame& frame = frames_[number];
  if (--frame.under_way > 0) {
    return;
  }
  const FrameReport report = frame.report;
  frames_.give_back(number);
  listener_->finished(report);
}

std::unique_ptr<FrameCarrier> make_air(const AirParameters& parameters, PositionSource& positions,
                                       AirListener& listener, AirMonitor* monitor) {
  if (parameters.mac == "ideal") {
    return std::make_unique<IdealAir>(parameters, positions, listener, monitor);
  }
  return std::make_unique<Air>(parameters, positions, listener, monitor);
}

}  // namespace cuscus::netsim
