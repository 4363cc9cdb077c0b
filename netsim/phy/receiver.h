#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/random/counter_stream.h"
#include "common/units/decibel.h"
#include "netsim/phy/error_model.h"
#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// Why a frame was not received.
enum class LossCause : std::uint8_t {
  kNone,
  kBelowFloor,      ///< So weak that the receiver was left out of it.
  kBelowDetection,  ///< Too weak for its preamble to be detected.
  kNoise,           ///< Detected; decoding would have failed without interference too.
  kCollision,       ///< The receiver was with another frame, or that one hid the preamble.
  kInterference,    ///< Detected, and spoilt by other frames.
  kHalfDuplex,      ///< The node was transmitting.
  kJammed,          ///< Would have been received, had nobody jammed.
};

/// What all receivers of a run have in common.
struct ReceiverParameters {
  DecibelMilliwatt noise{};              ///< Thermal noise and noise figure in the bandwidth.
  DecibelMilliwatt cca_preamble{};       ///< A detected preamble at or above makes the medium busy.
  DecibelMilliwatt cca_energy{};         ///< Any energy at or above makes the medium busy.
  DecibelMilliwatt sensitivity{};        ///< Nothing below is ever detected.
  DecibelMilliwatt detection_minimum{};  ///< Preamble detection; -inf: none.
  Decibel detection_minimum_sinr{};      ///< Preamble detection; -inf: none.
  /// Capture: SINR from which a later frame takes the receiver from the one that it is locked on,
  /// during that one's preamble and after it (message in message); +inf: never.
  Decibel capture_in_preamble{std::numeric_limits<double>::infinity()};
  Decibel capture_in_frame{std::numeric_limits<double>::infinity()};
};

/// k T0 B and a noise figure. (At 20 MHz and 7 dB: -93.97 dBm.)
[[nodiscard]] DecibelMilliwatt noise_floor(double bandwidth_hz, Decibel noise_figure);

/// Parameters in linear units, with what follows from them; shared by all receivers.
class ReceiverModel {
 public:
  /// `errors` must outlive this object.
  ReceiverModel(const ReceiverParameters& parameters, const ErrorModel& errors);

  [[nodiscard]] double noise_mw() const { return noise_mw_; }
  [[nodiscard]] double cca_preamble_mw() const { return cca_preamble_mw_; }
  [[nodiscard]] double cca_energy_mw() const { return cca_energy_mw_; }
  [[nodiscard]] bool detectable(double signal_mw, double interference_mw) const {
    return signal_mw >= minimum_mw_ && signal_mw >= minimum_sinr_ * (noise_mw_ + interference_mw);
  }
  /// Whether a frame takes the receiver from another, whose preamble is still heard or not.
  [[nodiscard]] bool captures(bool in_preamble, double signal_mw, double interference_mw) const {
    return signal_mw >=
           (in_preamble ? capture_in_preamble_ : capture_in_frame_) * (noise_mw_ + interference_mw);
  }
  /// ln of the probability that `bits` survive at this SINR.
  [[nodiscard]] double log_success_of(Modulation modulation, CodeRate code_rate, double sinr_ratio,
                                      double bits) const;

 private:
  double noise_mw_;
  double cca_preamble_mw_;
  double cca_energy_mw_;
  double minimum_mw_;
  double minimum_sinr_;
  double capture_in_preamble_;
  double capture_in_frame_;
  const ErrorModel* errors_;
  /// Per modulation and code rate: from this SINR on no bit fails, to double precision.
  std::array<std::array<double, kCodeRates>, kModulations> certain_sinr_{};
};

inline constexpr std::uint32_t kNoSender = std::numeric_limits<std::uint32_t>::max();

/// One transmission as one receiver gets it.
struct Arrival {
  std::uint32_t sender{};
  std::uint32_t receiver{};
  Duration delay{};  ///< Propagation.
  double power_mw{};
  /// The worst of what was decided on: detection or its failure, and all chunks after it.
  float sinr_ratio{};
  /// Sender of the strongest other frame heard meanwhile, or of the one preferred to this one.
  std::uint32_t interferer{kNoSender};
  LossCause cause{LossCause::kNone};
  bool decoded{false};
};

/// When the parts of a transmission leave its antenna.
struct PpduTiming {
  SimTime header_begins{};
  SimTime payload_begins{};
  SimTime energy_ends{};  ///< Without the signal extension.
  const Mode* mode{};
};

/// Reception at one node.
///
/// Interference is accumulated in chunks: whenever the total power on the antenna changes, the
/// stretch since the last change is charged with its own SINR. A frame is locked on when its
/// preamble has been heard for the CCA time, nothing else is being received and it is strong
/// enough. A locked receiver stays with its frame unless a later one captures it. SIGNAL field and
/// payload are decided apart. Jamming is noise that changes: it adds to the noise of every chunk
/// and to the energy of carrier sense.
///
/// The caller brings events in the order of their time: begin and, after the CCA time, detect;
/// header at the end of the SIGNAL field; energy_ends; finish after the signal extension. Arrivals
/// must stay where they are from begin to finish.
class Receiver {
 public:
  Receiver(const ReceiverModel& model, random::CounterStream draws)
      : model_{&model}, draws_{draws} {}

  void begin(SimTime now, Arrival& arrival);
  /// Whether the receiver locked on.
  bool detect(SimTime now, Arrival& arrival, const PpduTiming& timing);

  enum class Header : std::uint8_t { kNotMine, kDecoded, kFailed };
  Header header(SimTime now, Arrival& arrival);
  void energy_ends(SimTime now, Arrival& arrival);

  enum class End : std::uint8_t { kNotMine, kDecoded, kFailed };
  /// Frees the receiver if it was locked on this arrival.
  End finish(Arrival& arrival);

  /// Noise from jammers from now on; false when it is as before.
  bool jam(SimTime now, double power_mw);

  /// The node's own transmission; whatever was being received is lost.
  void start_transmission();
  void end_transmission() { transmitting_ = false; }

  [[nodiscard]] bool transmitting() const { return transmitting_; }
  /// Physical carrier sense.
  [[nodiscard]] bool medium_busy() const {
    return total_mw_ + jamming_mw_ >= model_->cca_energy_mw() || (locked_ != nullptr && carrier_);
  }

 private:
  /// ln of the probability that the bits so far have survived: with all that disturbs, with all but
  /// jammers, and with noise alone.
  struct Survival {
    double with_all{0.0};
    double without_jamming{0.0};
    double in_noise{0.0};
  };

  /// Whether the receiver locks on to a frame that it could hear in noise alone.
  [[nodiscard]] bool gets_receiver(SimTime now, const Arrival& arrival,
                                   double disturbance_mw) const;
  [[nodiscard]] const Arrival* strongest_other(const Arrival& arrival) const;
  void lock_on(SimTime now, Arrival& arrival, const PpduTiming& timing);
  void settle(SimTime now);
  void charge(SimTime from, SimTime to, double sinr_ratio, double sinr_without_jamming);
  void charge(Survival& field, Modulation modulation, CodeRate code_rate, double bits,
              double sinr_ratio, double sinr_without_jamming) const;
  bool decide(Arrival& arrival, const Survival& survival);

  const ReceiverModel* model_;
  random::CounterStream draws_;
  std::uint64_t draw_{0};
  double total_mw_{0.0};  ///< Of frames.
  double jamming_mw_{0.0};
  std::vector<const Arrival*> present_;  ///< Whose energy is on the antenna.
  bool transmitting_{false};
  // The frame being received.
  Arrival* locked_{nullptr};
  bool carrier_{false};
  PpduTiming timing_{};  ///< At this antenna.
  SimTime chunk_begins_{};
  Survival header_{};
  Survival payload_{};
  double interferer_mw_{0.0};  ///< Of locked_->interferer.
};

}  // namespace cuscus::netsim
