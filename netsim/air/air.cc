#include "netsim/air/air.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "netsim/air/event_rank.h"
#include "netsim/mac/edca.h"

namespace cuscus::netsim {
namespace {

// Purposes of random streams (see random::stream_id).
constexpr std::uint16_t kBackoffStream = 0x1002;
constexpr std::uint16_t kReceptionStream = 0x1003;
constexpr std::uint16_t kRateStream = 0x1008;

void require(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"radio: " + rule};
  }
}

TdmaSchedule tdma_schedule(const AirParameters& p) {
  TdmaSchedule tdma = p.tdma;
  require(tdma.guard >= Duration::zero() && tdma.guard < tdma.slot,
          "the guard time of TDMA must not be negative, and its slot must be longer");
  require(p.rate_control == "constant", "rate control '" + p.rate_control +
                                            "' needs ACKs, which TDMA has not; allowed: constant");
  const auto nodes = static_cast<std::int32_t>(p.nodes.size());
  if (tdma.frame.empty()) {
    tdma.frame.resize(p.nodes.size());
    std::iota(tdma.frame.begin(), tdma.frame.end(), 0);
  }
  for (const std::int32_t owner : tdma.frame) {
    require(owner == kNobody || (owner >= 0 && owner < nodes),
            "a slot of TDMA has the owner " + std::to_string(owner) +
                "; allowed: -2 for none, 0 ... " + std::to_string(nodes - 1));
  }
  return tdma;
}

EdcaParameters edca_parameters(const AirParameters& p, const Standard& standard) {
  if (p.edca.empty()) {
    return default_edca(standard);
  }
  require(p.edca.size() == kAccessCategories, "EDCA has 4 categories");
  for (const EdcaCategory& category : p.edca) {
    require(category.aifsn >= 2 && category.aifsn <= 15, "an AIFSN must be 2 ... 15");
    require(category.cw_min <= category.cw_max && category.cw_max <= 32'767,
            "a category's CWmin must not be above its CWmax, nor that above 32767");
  }
  return p.edca;
}

MacParameters mac_parameters(const AirParameters& p, const Standard& standard) {
  require(p.slot >= Duration::zero(), "the slot must not be negative");
  require(p.retry_limit >= 1 && p.long_retry_limit >= 1,
          "the retry limits count attempts and must be at least 1");
  require(p.queue_frames >= 1, "the queue must hold at least 1 frame");
  require(p.queue_lifetime > Duration::zero(), "the queue lifetime must be above 0");
  for (const std::uint32_t rate : p.basic_rates_kbps) {
    static_cast<void>(standard.mode(rate));  // throws on a rate that does not exist
  }
  const Duration slot = p.slot == Duration::zero() ? standard.slot : p.slot;
  auto mac = MacParameters::from(standard, slot, p.data_rate_kbps, p.group_rate_kbps,
                                 p.basic_rates_kbps, p.control_answer);
  mac.short_retry_limit = p.retry_limit;
  mac.long_retry_limit = p.long_retry_limit;
  mac.rts_threshold_bytes = p.rts_threshold_bytes;
  mac.queue_frames = p.queue_frames;
  mac.queue_lifetime = p.queue_lifetime;
  if (p.mac == "tdma") {
    mac.tdma = tdma_schedule(p);
  } else if (p.mac == "edca") {
    mac.edca = edca_parameters(p, standard);
  }
  return mac;
}

Duration shortest_airtime(const Standard& standard) {
  Duration shortest = Duration::max();
  for (const Mode& mode : standard.modes) {
    shortest = std::min(shortest, airtime(mode, kAckBytes));
  }
  return shortest;
}

ReceiverParameters receiver_parameters(const AirParameters& p, const Standard& standard) {
  require(std::isfinite(p.noise_figure.value), "the noise figure must be finite");
  return {.noise = noise_floor(standard.bandwidth_hz, p.noise_figure),
          .cca_preamble = p.cca_preamble,
          .cca_energy = p.cca_energy,
          .sensitivity = p.sensitivity,
          .detection_minimum = p.detection_minimum,
          .detection_minimum_sinr = p.detection_minimum_sinr,
          .capture_in_preamble = p.capture_in_preamble,
          .capture_in_frame = p.capture_in_frame};
}

}  // namespace

Air::Station::Station(const ReceiverModel& model, std::uint32_t node, std::uint64_t seed,
                      std::unique_ptr<RateControl> rate_control)
    : receiver{model, random::CounterStream{seed, random::stream_id(kReceptionStream, node)}},
      rates{std::move(rate_control)} {}

Air::Air(const AirParameters& parameters, PositionSource& positions, AirListener& listener,
         AirMonitor* monitor)
    : seed_{parameters.seed},
      standard_{&standard_of(parameters.standard, parameters.dsss_preamble)},
      mac_{mac_parameters(parameters, *standard_)},
      errors_{make_error_model(parameters.error_model, parameters.more_error_models)},
      receiver_model_{receiver_parameters(parameters, *standard_), *errors_},
      channel_{parameters.channel},
      links_{channel_, static_cast<std::uint32_t>(parameters.nodes.size())},
      antenna_{make_antenna(parameters.antenna)},
      floor_mw_{receiver_model_.noise_mw() / parameters.arrival_floor_below_noise.ratio()},
      reach_floor_mw_{floor_mw_ / channel_.greatest_frame_gain().ratio()},
      shortest_airtime_{shortest_airtime(*standard_)},
      radios_{parameters.nodes},
      positions_{&positions},
      listener_{&listener},
      monitor_{monitor} {
  if (parameters.disruption.fraction != 0.0) {
    disruption_.emplace(parameters.disruption);
  }
  if (!parameters.jammers.empty()) {
    std::vector<Decibel> gains;
    std::transform(radios_.begin(), radios_.end(), std::back_inserter(gains),
                   [](const AirNode& radio) { return radio.antenna_gain; });
    jamming_.emplace(parameters.jammers,
                     Band{parameters.channel.carrier_hz, standard_->bandwidth_hz}, channel_,
                     antenna_.get(), std::move(gains));
    queue_.schedule(SimTime{}, event_rank(EventRank::kJamming, 0), {.kind = Step::Kind::kJamming});
  }
  require(!radios_.empty() && radios_.size() <= 65'535, "there must be 1 to 65535 nodes");
  require(positions.positions(SimTime{}).size() >= radios_.size(), "a node has no position");
  RateSetting rates = rate_setting(*standard_, *mac_.data_mode, *errors_);
  rates.attempts = std::min(mac_.short_retry_limit, mac_.long_retry_limit);
  stations_.reserve(radios_.size());
  for (std::uint32_t node = 0; node < radios_.size(); ++node) {
    require(std::isfinite(radios_[node].tx_power.value) &&
                std::isfinite(radios_[node].antenna_gain.value),
            "powers and gains must be finite");
    rates.draws = {seed_, random::stream_id(kRateStream, node)};
    Station& station = stations_.emplace_back(receiver_model_, node, seed_,
                                              make_rate_control(parameters.rate_control, rates));
    station.mac = make_mac(parameters.mac,
                           {.node = node,
                            .parameters = &mac_,
                            .host = this,
                            .rates = station.rates.get(),
                            .draws = {seed_, random::stream_id(kBackoffStream, node)}},
                           parameters.more_macs);
  }
}

DecibelMilliwatt Air::noise() const {
  return DecibelMilliwatt::from_milliwatts(receiver_model_.noise_mw());
}

std::uint32_t Air::queue_places() const {
  const auto queues = std::max<std::size_t>(1, mac_.edca.size());
  return mac_.queue_frames * static_cast<std::uint32_t>(queues);
}

void Air::offer(std::uint32_t node, SimTime sent_at, const OfferedFrame& frame) {
  assert(node < stations_.size());
  assert(frame.priority < kPriorities);
  const std::uint32_t slot = pending_.take();
  pending_[slot] = {.report = FrameReport::of(node, sent_at, frame), .references = 1};
  queue_.schedule(std::max(sent_at, now_), event_rank(EventRank::kOffer, node),
                  {.kind = Step::Kind::kOffer, .index = slot});
}

std::optional<SimTime> Air::next_event() const {
  if (queue_.empty()) {
    return std::nullopt;
  }
  return queue_.next_time();
}

std::optional<SimTime> Air::next_delivery_bound() const {
  // What is on the air ends at a known time; what is not needs an event and an airtime first.
  std::optional<SimTime> bound;
  if (!queue_.empty()) {
    bound = queue_.next_time() + shortest_airtime_;
  }
  for (const Transmission& transmission : transmissions_) {
    if (transmission.active && transmission.ppdu.frame.kind == MacFrame::Kind::kData &&
        !transmission.arrivals.empty()) {
      const auto next =
          std::min<std::size_t>(transmission.next[static_cast<std::size_t>(Phase::kFinish)],
                                transmission.arrivals.size() - 1);
      const SimTime end = transmission.phase_at[static_cast<std::size_t>(Phase::kFinish)] +
                          transmission.arrivals[next].delay;
      bound = bound ? std::min(*bound, end) : end;
    }
  }
  return bound;
}

void Air::run_until(SimTime limit) {
  while (run_next(limit)) {
  }
  now_ = std::max(now_, limit);
}

bool Air::run_next(SimTime limit) {
  if (queue_.empty() || queue_.next_time() > limit) {
    return false;
  }
  const auto event = queue_.pop();
  now_ = event.time;
  ++events_;
  const Step& step = event.payload;
  switch (step.kind) {
    case Step::Kind::kOffer: {
      const FrameReport& report = pending_[step.index].report;
      Station& station = stations_[report.sender];
      ++station.tally.offered;
      station.mac->enqueue(now_, {.frame = step.index,
                                  .destination = report.destination,
                                  .psdu_bytes = report.psdu_bytes,
                                  .priority = report.priority,
                                  .queued_at = now_});
      break;
    }
    case Step::Kind::kSweep:
      sweep(step.index, static_cast<Phase>(step.detail), limit);
      break;
    case Step::Kind::kTransmissionEnd:
      stations_[step.index].receiver.end_transmission();
      stations_[step.index].mac->transmission_ended(now_);
      update_medium(step.index);
      break;
    case Step::Kind::kTimer: {
      stations_[step.index].timers[step.detail] = {};
      stations_[step.index].mac->timer(now_, static_cast<MacTimer>(step.detail));
      break;
    }
    case Step::Kind::kJamming:
      update_jamming();
      break;
  }
  return true;
}

void Air::set_timer(std::uint32_t node, MacTimer timer, SimTime time) {
  cancel_timer(node, timer);
  const bool access = timer == MacTimer::kAccess || timer == MacTimer::kResponse;
  const EventRank rank = access ? EventRank::kAccess : EventRank::kTimeout;
  stations_[node].timers[static_cast<std::size_t>(timer)] = queue_.schedule(
      time, event_rank(rank, node),
      {.kind = Step::Kind::kTimer, .detail = static_cast<std::uint8_t>(timer), .index = node});
}

void Air::cancel_timer(std::uint32_t node, MacTimer timer) {
  queue_.cancel(stations_[node].timers[static_cast<std::size_t>(timer)]);
  stations_[node].timers[static_cast<std::size_t>(timer)] = {};
}

void Air::finished(std::uint32_t node, const Msdu& msdu, SendOutcome outcome,
                   std::uint32_t attempts) {
  Pending& pending = pending_[msdu.frame];
  pending.report.outcome = outcome;
  pending.report.attempts = attempts;
  Tally& tally = stations_[node].tally;
  switch (outcome) {
    case SendOutcome::kSent:
      ++tally.sent;
      break;
    case SendOutcome::kAcknowledged:
      ++tally.acknowledged;
      break;
    case SendOutcome::kQueueFull:
      ++tally.dropped_queue_full;
      break;
    case SendOutcome::kLifetime:
      ++tally.dropped_lifetime;
      break;
    case SendOutcome::kRetryLimit:
      ++tally.dropped_retry_limit;
      break;
    case SendOutcome::kTooLong:
      ++tally.dropped_too_long;
      break;
  }
  release(msdu.frame);
}

void Air::release(std::uint32_t frame) {
  Pending& pending = pending_[frame];
  if (--pending.references > 0) {
    return;
  }
  const FrameReport report = pending.report;
  if (report.destination >= 0 && report.deliveries == 0) {
    stations_[static_cast<std::size_t>(report.destination)].tally.count(report.last_loss);
  }
  pending_.give_back(frame);
  listener_->finished(report);
}

void Air::update_jamming() {
  const auto& positions = positions_->positions(now_);
  const auto received_mw = jamming_->received_mw(
      now_, {.p_WN = positions, .q_WN = positions_->attitudes(), .version = positions_->version()});
  if (const auto next = jamming_->next_change(now_)) {
    queue_.schedule(*next, event_rank(EventRank::kJamming, 0), {.kind = Step::Kind::kJamming});
  }
  for (std::uint32_t node = 0; node < stations_.size(); ++node) {
    if (stations_[node].receiver.jam(now_, received_mw[node])) {
      update_medium(node);
    }
  }
}

bool Air::meant_for(const MacFrame& frame, std::uint32_t node) const {
  return frame.receiver == kGroup || frame.receiver == static_cast<std::int32_t>(node);
}

}  // namespace cuscus::netsim
