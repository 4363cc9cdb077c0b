#include "netsim/phy/receiver.h"

#include <algorithm>
#include <cmath>

#include "common/units/constants.h"

namespace cuscus::netsim {
namespace {

/// Bits on the air between two instants at the rate of the field they belong to.
double bits_of(const Mode& mode, Duration duration) {
  return to_seconds(duration) * 1e3 * static_cast<double>(mode.rate_kbps);
}

double header_bits_of(const Mode& mode, Duration duration) {
  return mode.format->header_bits * (to_seconds(duration) / to_seconds(mode.format->header));
}

}  // namespace

DecibelMilliwatt noise_floor(double bandwidth_hz, Decibel noise_figure) {
  constexpr double kMilliwattPerWatt = 1e3;
  return DecibelMilliwatt::from_milliwatts(kBoltzmann_JpK * kNoiseTemperature_K * bandwidth_hz *
                                           kMilliwattPerWatt) +
         noise_figure;
}

ReceiverModel::ReceiverModel(const ReceiverParameters& parameters, const ErrorModel& errors)
    : noise_mw_{parameters.noise.milliwatts()},
      cca_preamble_mw_{parameters.cca_preamble.milliwatts()},
      cca_energy_mw_{parameters.cca_energy.milliwatts()},
      minimum_mw_{std::max(parameters.sensitivity, parameters.detection_minimum).milliwatts()},
      minimum_sinr_{parameters.detection_minimum_sinr.ratio()},
      capture_in_preamble_{parameters.capture_in_preamble.ratio()},
      capture_in_frame_{parameters.capture_in_frame.ratio()},
      errors_{&errors} {
  // Below this, (1 - p)^n is 1 to double precision for every frame that fits the standard.
  constexpr double kNegligibleBitFailure = 1e-21;
  constexpr double kStep_db = 0.25;
  constexpr double kHighest_db = 60.0;
  for (std::size_t m = 0; m < certain_sinr_.size(); ++m) {
    for (std::size_t c = 0; c < certain_sinr_[m].size(); ++c) {
      Decibel sinr{0.0};
      while (sinr.value < kHighest_db &&
             errors.bit_failure(static_cast<Modulation>(m), static_cast<CodeRate>(c),
                                sinr.ratio()) > kNegligibleBitFailure) {
        sinr.value += kStep_db;
      }
      certain_sinr_[m][c] = sinr.ratio();
    }
  }
}

double ReceiverModel::log_success_of(Modulation modulation, CodeRate code_rate, double sinr_ratio,
                                     double bits) const {
  const double certain =
      certain_sinr_[static_cast<std::size_t>(modulation)][static_cast<std::size_t>(code_rate)];
  return sinr_ratio >= certain
             ? 0.0
             : log_success(errors_->bit_failure(modulation, code_rate, sinr_ratio), bits);
}

void Receiver::begin(SimTime now, Arrival& arrival) {
  settle(now);
  total_mw_ += arrival.power_mw;
  present_.push_back(&arrival);
  if (transmitting_) {
    arrival.cause = LossCause::kHalfDuplex;
  }
  if (locked_ != nullptr && arrival.power_mw > interferer_mw_) {
    interferer_mw_ = arrival.power_mw;
    locked_->interferer = arrival.sender;
  }
}

const Arrival* Receiver::strongest_other(const Arrival& arrival) const {
  const Arrival* strongest = nullptr;
  for (const Arrival* other : present_) {
    if (other != &arrival && (strongest == nullptr || other->power_mw > strongest->power_mw)) {
      strongest = other;
    }
  }
  return strongest;
}

bool Receiver::detect(SimTime now, Arrival& arrival, const PpduTiming& timing) {
  if (arrival.cause != LossCause::kNone) {
    return false;
  }
  const double interference_mw = std::max(0.0, total_mw_ - arrival.power_mw);
  arrival.sinr_ratio =
      static_cast<float>(arrival.power_mw / (model_->noise_mw() + interference_mw + jamming_mw_));
  const Arrival* const other = present_.size() > 1 ? strongest_other(arrival) : nullptr;
  arrival.interferer = other != nullptr ? other->sender : kNoSender;
  if (transmitting_) {
    arrival.cause = LossCause::kHalfDuplex;
  } else if (!model_->detectable(arrival.power_mw, 0.0)) {
    arrival.cause = LossCause::kBelowDetection;
  } else if (!gets_receiver(now, arrival, interference_mw)) {
    arrival.cause = LossCause::kCollision;
    arrival.interferer = locked_ != nullptr ? locked_->sender : arrival.interferer;
  } else if (jamming_mw_ > 0.0 && !gets_receiver(now, arrival, interference_mw + jamming_mw_)) {
    arrival.cause = LossCause::kJammed;
  } else {
    if (locked_ != nullptr) {
      locked_->cause = LossCause::kCollision;
      locked_->interferer = arrival.sender;
      locked_->decoded = false;
    }
    lock_on(now, arrival, timing);
    interferer_mw_ = other != nullptr ? other->power_mw : 0.0;
    return true;
  }
  return false;
}

bool Receiver::gets_receiver(SimTime now, const Arrival& arrival, double disturbance_mw) const {
  return model_->detectable(arrival.power_mw, disturbance_mw) &&
         (locked_ == nullptr ||
          model_->captures(now < timing_.header_begins, arrival.power_mw, disturbance_mw));
}

void Receiver::lock_on(SimTime now, Arrival& arrival, const PpduTiming& timing) {
  locked_ = &arrival;
  carrier_ = arrival.power_mw >= model_->cca_preamble_mw();
  timing_ = {.header_begins = timing.header_begins + arrival.delay,
             .payload_begins = timing.payload_begins + arrival.delay,
             .energy_ends = timing.energy_ends + arrival.delay,
             .mode = timing.mode};
  chunk_begins_ = now;
  header_ = {};
  payload_ = {};
}

Receiver::Header Receiver::header(SimTime now, Arrival& arrival) {
  if (locked_ != &arrival) {
    return Header::kNotMine;
  }
  settle(now);
  const PpduFormat& format = *timing_.mode->format;
  if (header_.with_all != 0.0) {
    header_.in_noise =
        model_->log_success_of(format.header_modulation, format.header_code_rate,
                               arrival.power_mw / model_->noise_mw(), format.header_bits);
  }
  if (!decide(arrival, header_)) {
    locked_ = nullptr;
    return Header::kFailed;
  }
  carrier_ = true;  // PHY-RXSTART: busy for the length that the SIGNAL field says
  return Header::kDecoded;
}

void Receiver::energy_ends(SimTime now, Arrival& arrival) {
  settle(now);
  present_.erase(std::find(present_.begin(), present_.end(), &arrival));
  if (present_.empty()) {
    total_mw_ = 0.0;  // no rounding error outlives the frames that caused it
  } else {
    total_mw_ = std::max(0.0, total_mw_ - arrival.power_mw);
  }
  if (locked_ != &arrival) {
    return;
  }
  const Mode& mode = *timing_.mode;
  if (payload_.with_all != 0.0) {
    payload_.in_noise = model_->log_success_of(
        mode.modulation, mode.code_rate, arrival.power_mw / model_->noise_mw(),
        bits_of(mode, timing_.energy_ends - timing_.payload_begins));
  }
  arrival.decoded = decide(arrival, payload_);
}

Receiver::End Receiver::finish(Arrival& arrival) {
  if (locked_ != &arrival) {
    return End::kNotMine;
  }
  locked_ = nullptr;
  return arrival.decoded ? End::kDecoded : End::kFailed;
}

void Receiver::start_transmission() {
  if (locked_ != nullptr) {
    locked_->cause = LossCause::kHalfDuplex;
    locked_->decoded = false;
    locked_ = nullptr;
  }
  transmitting_ = true;
}

bool Receiver::jam(SimTime now, double power_mw) {
  if (power_mw == jamming_mw_) {
    return false;
  }
  settle(now);
  jamming_mw_ = power_mw;
  return true;
}

void Receiver::settle(SimTime now) {
  if (locked_ == nullptr || now <= chunk_begins_) {
    return;
  }
  const double disturbance_mw = model_->noise_mw() + std::max(0.0, total_mw_ - locked_->power_mw);
  charge(chunk_begins_, now, locked_->power_mw / (disturbance_mw + jamming_mw_),
         locked_->power_mw / disturbance_mw);
  chunk_begins_ = now;
}

void Receiver::charge(SimTime from, SimTime to, double sinr_ratio, double sinr_without_jamming) {
  const Mode& mode = *timing_.mode;
  locked_->sinr_ratio = std::min(locked_->sinr_ratio, static_cast<float>(sinr_ratio));
  const Duration in_header =
      std::min(to, timing_.payload_begins) - std::max(from, timing_.header_begins);
  if (in_header > Duration::zero()) {
    charge(header_, mode.format->header_modulation, mode.format->header_code_rate,
           header_bits_of(mode, in_header), sinr_ratio, sinr_without_jamming);
  }
  const Duration in_payload =
      std::min(to, timing_.energy_ends) - std::max(from, timing_.payload_begins);
  if (in_payload > Duration::zero()) {
    charge(payload_, mode.modulation, mode.code_rate, bits_of(mode, in_payload), sinr_ratio,
           sinr_without_jamming);
  }
}

void Receiver::charge(Survival& field, Modulation modulation, CodeRate code_rate, double bits,
                      double sinr_ratio, double sinr_without_jamming) const {
  const double all = model_->log_success_of(modulation, code_rate, sinr_ratio, bits);
  field.with_all += all;
  field.without_jamming +=
      jamming_mw_ > 0.0 ? model_->log_success_of(modulation, code_rate, sinr_without_jamming, bits)
                        : all;
}

bool Receiver::decide(Arrival& arrival, const Survival& survival) {
  if (survival.with_all == 0.0) {
    return true;
  }
  const double u = draws_.uniform(draw_++);
  if (u < std::exp(survival.with_all)) {
    return true;
  }
  // The same draw decides who is to blame: the frame that would have come through without jammers
  // was jammed, and the one that noise alone would have spoilt too is charged to noise.
  if (u < std::exp(survival.without_jamming)) {
    arrival.cause = LossCause::kJammed;
  } else {
    arrival.cause = u < std::exp(survival.in_noise) ? LossCause::kInterference : LossCause::kNoise;
  }
  return false;
}

}  // namespace cuscus::netsim
