// The life of a transmission: Air's other half.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/units/constants.h"
#include "netsim/air/air.h"
#include "netsim/air/event_rank.h"

namespace cuscus::netsim {
namespace {

/// Whether a frame on the air stands for one that waits at its sender.
bool belongs_to_pending(const MacFrame& frame) {
  return frame.kind == MacFrame::Kind::kData || frame.kind == MacFrame::Kind::kRts;
}

constexpr std::uint64_t rank_of_finish(std::uint32_t transmission) {
  // After the senders' own ends at that instant, of which there are fewer than 2^16.
  return event_rank(EventRank::kFinish, 0x8000'0000U | transmission);
}

}  // namespace

void Air::update_reach(std::uint32_t sender) {
  const auto& positions = positions_->positions(now_);
  Station& station = stations_[sender];
  if (station.reach_version == positions_->version() && !station.reach.empty()) {
    return;
  }
  if (station.reach.empty()) {
    for (std::uint32_t node = 0; node < stations_.size(); ++node) {
      if (node != sender) {
        station.reach.push_back(
            {.receiver = node, .delay = {}, .received_dbm = 0, .received_mw = 0});
      }
    }
  }
  station.reach_version = positions_->version();
  const AirNode& radio = radios_[sender];
  const auto attitudes = positions_->attitudes();
  const auto pose = [&](std::uint32_t node) {
    return attitudes.empty() ? AntennaPose{.p_WB = positions[node]}
                             : AntennaPose{.p_WB = positions[node], .q_WB = attitudes[node]};
  };
  for (Reach& reach : station.reach) {
    const Decibel loss = links_.loss(
        Link::between(sender, positions[sender], reach.receiver, positions[reach.receiver]));
    DecibelMilliwatt received =
        radio.tx_power + radio.antenna_gain + radios_[reach.receiver].antenna_gain - loss;
    if (antenna_) {
      received = received + gain_of_both(*antenna_, pose(sender), pose(reach.receiver));
    }
    const double distance_m = (positions[sender] - positions[reach.receiver]).norm();
    reach.delay = Duration{std::llround(distance_m / kSpeedOfLight_mps * 1e9)};
    reach.received_dbm = received.value;
    reach.received_mw = received.milliwatts();
  }
  // The order of last time is nearly right: insertion sort is linear then.
  for (std::size_t i = 1; i < station.reach.size(); ++i) {
    const Reach reach = station.reach[i];
    std::size_t j = i;
    for (; j > 0 && station.reach[j - 1].delay > reach.delay; --j) {
      station.reach[j] = station.reach[j - 1];
    }
    station.reach[j] = reach;
  }
}

/// Works out who gets how much of a transmission.
void Air::spread(Transmission& transmission, std::uint32_t sender) {
  update_reach(sender);
  Station& station = stations_[sender];
  const auto* const positions =
      channel_.varies_per_frame() ? &positions_->positions(now_) : nullptr;
  transmission.arrivals.clear();
  for (const Reach& reach : station.reach) {
    double power_mw = reach.received_mw;
    if (positions != nullptr && power_mw >= reach_floor_mw_) {
      const Decibel variation =
          channel_.frame_loss({.link = Link::between(sender, (*positions)[sender], reach.receiver,
                                                     (*positions)[reach.receiver]),
                               .from_low = sender < reach.receiver,
                               .transmission = transmission.ppdu.number,
                               .time = now_});
      power_mw = (DecibelMilliwatt{reach.received_dbm} - variation).milliwatts();
    }
    if (power_mw >= floor_mw_) {
      transmission.arrivals.push_back({.sender = sender,
                                       .receiver = reach.receiver,
                                       .delay = reach.delay,
                                       .power_mw = power_mw});
    } else if (belongs_to_pending(transmission.ppdu.frame) &&
               meant_for(transmission.ppdu.frame, reach.receiver)) {
      leave_out(transmission.ppdu, reach.receiver);
    }
  }
}

/// A frame arrives below the floor at a node that it is meant for.
void Air::leave_out(const Ppdu& ppdu, std::uint32_t receiver) {
  if (ppdu.frame.receiver == kGroup) {
    stations_[receiver].tally.count(LossCause::kBelowFloor);
  } else {
    pending_[ppdu.frame.frame].report.last_loss = LossCause::kBelowFloor;
  }
  if (monitor_ != nullptr) {
    monitor_->unreached(ppdu, receiver);
  }
}

void Air::transmit(std::uint32_t node, const MacFrame& frame, const Mode& mode,
                   std::uint32_t psdu_bytes) {
  const std::uint32_t index = transmissions_.take();
  Transmission& transmission = transmissions_[index];
  const PpduFormat& format = *mode.format;
  const Duration duration = airtime(mode, psdu_bytes);
  const SimTime header = now_ + format.preamble;
  const SimTime payload = header + format.header;
  const SimTime end = now_ + duration;
  transmission.timing = {.header_begins = header,
                         .payload_begins = payload,
                         .energy_ends = end - format.extension,
                         .mode = &mode};
  transmission.phase_at = {now_, now_ + standard_->cca_time, payload, end - format.extension, end};
  transmission.next = {};
  transmission.active = true;

  Station& station = stations_[node];
  transmission.ppdu = {.frame = frame,
                       .mode = &mode,
                       .psdu_bytes = psdu_bytes,
                       .number = station.transmissions++,
                       .begins = now_,
                       .ends = end};
  station.receiver.start_transmission();
  update_medium(node);
  if (belongs_to_pending(frame)) {
    ++pending_[frame.frame].references;
  }
  if (frame.kind == MacFrame::Kind::kData) {
    ++station.tally.transmissions;
    Pending& pending = pending_[frame.frame];
    station.tally.retries += pending.report.attempts > 0 ? 1 : 0;
    ++pending.report.attempts;
  }
  if (belongs_to_pending(frame)) {
    const FrameReport& report = pending_[frame.frame].report;
    transmission.ppdu.attempt = report.attempts;
    transmission.ppdu.offer_id = report.id;
  }
  if (monitor_ != nullptr) {
    static_cast<void>(positions_->positions(now_));
    transmission.ppdu.positions_version = positions_->version();
    monitor_->transmitted(transmission.ppdu);
  }
  spread(transmission, node);
  queue_.schedule(end, event_rank(EventRank::kFinish, node),
                  {.kind = Step::Kind::kTransmissionEnd, .index = node});
  if (transmission.arrivals.empty()) {
    // Nobody hears it; the frame is over when the sender says so.
    transmission.active = false;
    transmissions_.give_back(index);
    if (belongs_to_pending(frame)) {
      --pending_[frame.frame].references;
    }
    return;
  }
  queue_.schedule(now_ + transmission.arrivals.front().delay, rank_of_phase(Phase::kBegin, index),
                  {.kind = Step::Kind::kSweep,
                   .detail = static_cast<std::uint8_t>(Phase::kBegin),
                   .index = index});
}

std::uint64_t Air::rank_of_phase(Phase phase, std::uint32_t index) {
  switch (phase) {
    case Phase::kEnergyEnds:
      return event_rank(EventRank::kEnergyEnds, index);
    case Phase::kFinish:
      return rank_of_finish(index);
    default:
      return event_rank(EventRank::kSweep, index);
  }
}

void Air::sweep(std::uint32_t index, Phase phase, SimTime limit) {
  const auto p = static_cast<std::size_t>(phase);
  const std::uint64_t rank = rank_of_phase(phase, index);
  const Step step{
      .kind = Step::Kind::kSweep, .detail = static_cast<std::uint8_t>(phase), .index = index};
  for (;;) {
    // Looked up anew each time: what a sweep sets off may add transmissions.
    Transmission& transmission = transmissions_[index];
    const std::uint32_t i = transmission.next[p]++;
    if (i == 0 && phase != Phase::kFinish) {
      const auto following = static_cast<Phase>(p + 1);
      queue_.schedule(transmission.phase_at[p + 1] + transmission.arrivals.front().delay,
                      rank_of_phase(following, index),
                      {.kind = Step::Kind::kSweep,
                       .detail = static_cast<std::uint8_t>(following),
                       .index = index});
    }
    sweep_one(transmission, phase, transmission.arrivals[i]);
    const Transmission& after = transmissions_[index];
    if (i + 1 == after.arrivals.size()) {
      break;
    }
    const SimTime next = after.phase_at[p] + after.arrivals[i + 1].delay;
    if (next > now_ && (next > limit || (!queue_.empty() && next >= queue_.next_time()))) {
      queue_.schedule(next, rank, step);
      return;
    }
    now_ = next;
  }
  if (phase == Phase::kFinish) {
    end_of_sweeps(index);
  }
}

void Air::sweep_one(Transmission& transmission, Phase phase, Arrival& arrival) {
  Station& station = stations_[arrival.receiver];
  switch (phase) {
    case Phase::kBegin:
      station.receiver.begin(now_, arrival);
      break;
    case Phase::kDetect:
      station.receiver.detect(now_, arrival, transmission.timing);
      update_medium(arrival.receiver);
      break;
    case Phase::kHeader:
      switch (station.receiver.header(now_, arrival)) {
        case Receiver::Header::kNotMine:
          break;
        case Receiver::Header::kDecoded:
          station.mac->reception_started(now_);
          update_medium(arrival.receiver);
          break;
        case Receiver::Header::kFailed:
          station.mac->reception_failed(now_);
          update_medium(arrival.receiver);
          break;
      }
      break;
    case Phase::kEnergyEnds:
      station.receiver.energy_ends(now_, arrival);
      break;
    case Phase::kFinish:
      finish_arrival(transmission, arrival);
      break;
  }
}

/// Nobody receives a frame any part of which is on the air while the network is disrupted. Carrier
/// sense is as ever: what is cut is the connectivity, not the power.
bool Air::disrupted(const Transmission& transmission, const Arrival& arrival) const {
  return disruption_ &&
         disruption_->overlaps(
             transmission.phase_at[static_cast<std::size_t>(Phase::kBegin)] + arrival.delay,
             transmission.phase_at[static_cast<std::size_t>(Phase::kEnergyEnds)] + arrival.delay);
}

void Air::report_reception(const Transmission& transmission, const Arrival& arrival) {
  monitor_->received(transmission.ppdu,
                     {.receiver = arrival.receiver,
                      .time = now_,
                      .cause = arrival.cause,
                      .power = DecibelMilliwatt::from_milliwatts(arrival.power_mw),
                      .sinr = Decibel::from_ratio(arrival.sinr_ratio),
                      .interferer = arrival.interferer});
}

void Air::finish_arrival(Transmission& transmission, Arrival& arrival) {
  const MacFrame frame = transmission.ppdu.frame;
  const std::uint32_t receiver = arrival.receiver;
  const double power_mw = arrival.power_mw;
  Station& station = stations_[receiver];
  Receiver::End end = station.receiver.finish(arrival);
  if (end == Receiver::End::kDecoded && disrupted(transmission, arrival)) {
    end = Receiver::End::kFailed;
    arrival.cause = LossCause::kJammed;
  }
  if (monitor_ != nullptr) {
    report_reception(transmission, arrival);
  }
  const bool data = frame.kind == MacFrame::Kind::kData;
  if (end != Receiver::End::kDecoded) {
    if (data && frame.receiver == kGroup) {
      station.tally.count(arrival.cause);
    } else if (belongs_to_pending(frame) && meant_for(frame, receiver)) {
      pending_[frame.frame].report.last_loss = arrival.cause;
    }
    if (end == Receiver::End::kFailed) {
      station.mac->reception_failed(now_);
    }
    update_medium(receiver);
    return;
  }
  station.rates->heard(frame.sender, power_mw / receiver_model_.noise_mw());
  const bool deliver = station.mac->received(now_, frame, *transmission.timing.mode);
  update_medium(receiver);
  if (deliver) {
    ++station.tally.received;
    FrameReport& report = pending_[frame.frame].report;
    if (report.deliveries++ == 0) {
      report.first_delivery = now_;
    }
    listener_->delivered({.time = now_,
                          .id = report.id,
                          .sender = frame.sender,
                          .receiver = receiver,
                          .received_power = DecibelMilliwatt::from_milliwatts(power_mw),
                          .rate_kbps = transmission.timing.mode->rate_kbps});
  }
}

void Air::end_of_sweeps(std::uint32_t index) {
  Transmission& transmission = transmissions_[index];
  transmission.active = false;
  transmissions_.give_back(index);
  if (belongs_to_pending(transmission.ppdu.frame)) {
    release(transmission.ppdu.frame.frame);
  }
}

void Air::update_medium(std::uint32_t node) {
  Station& station = stations_[node];
  const bool busy = station.receiver.medium_busy();
  if (busy == station.busy) {
    return;
  }
  station.busy = busy;
  if (busy) {
    station.mac->medium_busy(now_);
  } else {
    station.mac->medium_idle(now_);
  }
}

}  // namespace cuscus::netsim
