#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "netsim/air/air_monitor.h"
#include "netsim/air/frame_carrier.h"
#include "netsim/air/jamming.h"
#include "netsim/air/tally.h"
#include "netsim/channel/antenna.h"
#include "netsim/channel/channel.h"
#include "netsim/channel/disruption.h"
#include "netsim/channel/link_terms.h"
#include "netsim/kernel/event_queue.h"
#include "netsim/kernel/slot_pool.h"
#include "netsim/mac/mac.h"
#include "netsim/phy/receiver.h"

namespace cuscus::netsim {

/// Where the nodes are.
class PositionSource {
 public:
  virtual ~PositionSource() = default;

  /// Of all nodes, by number, ENU [m]; valid until the next call. Asked again for the same instant
  /// it gives the same.
  [[nodiscard]] virtual const std::vector<Eigen::Vector3d>& positions(SimTime now) = 0;
  /// How they are turned, q_WB by number, at the latest positions(); valid as long. Empty: all are
  /// level and face east.
  [[nodiscard]] virtual std::span<const Eigen::Quaterniond> attitudes() const { return {}; }
  /// Changes whenever positions() or attitudes() has changed: link losses are kept while it stays.
  [[nodiscard]] virtual std::uint64_t version() const = 0;
};

/// Nodes that do not move.
class FixedPositions final : public PositionSource {
 public:
  /// `q_WN` may be empty (see attitudes()).
  explicit FixedPositions(std::vector<Eigen::Vector3d> p_WN,
                          std::vector<Eigen::Quaterniond> q_WN = {})
      : p_WN_{std::move(p_WN)}, q_WN_{std::move(q_WN)} {}

  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions(SimTime /*now*/) override {
    return p_WN_;
  }
  [[nodiscard]] std::span<const Eigen::Quaterniond> attitudes() const override { return q_WN_; }
  [[nodiscard]] std::uint64_t version() const override { return 1; }

 private:
  std::vector<Eigen::Vector3d> p_WN_;
  std::vector<Eigen::Quaterniond> q_WN_;
};

/// Radio of one node.
struct AirNode {
  DecibelMilliwatt tx_power{16.0206};
  Decibel antenna_gain{0.0};  ///< At either end of a link, besides AirParameters::antenna.
};

/// Of the MAC "ideal", which is an air of its own (IdealAir).
struct IdealParameters {
  Duration delay{0};
  Duration jitter{0};  ///< At most the delay.
  double loss{0.0};    ///< Probability, 0 ... 1.
  double range_m{std::numeric_limits<double>::infinity()};
};

/// What a scenario says about the air.
struct AirParameters {
  std::uint64_t seed{1};
  std::string standard{"802.11g"};
  std::uint32_t data_rate_kbps{6'000};
  std::uint32_t group_rate_kbps{6'000};
  std::string rate_control{"constant"};  ///< Of individually addressed frames.
  std::vector<std::uint32_t> basic_rates_kbps{6'000, 12'000, 24'000};
  ControlAnswerRule control_answer{ControlAnswerRule::kSameClass};
  DsssPreamble dsss_preamble{DsssPreamble::kLong};
  Decibel noise_figure{7.0};
  Duration slot{0};                   ///< 0: the standard's.
  std::uint32_t retry_limit{7};       ///< Attempts of RTS, and of data without.
  std::uint32_t long_retry_limit{7};  ///< Attempts of data after an RTS.
  /// PSDUs above this many bytes are sent after RTS and CTS.
  std::uint32_t rts_threshold_bytes{std::numeric_limits<std::uint32_t>::max()};
  std::string mac{"dcf"};
  TdmaSchedule tdma{};    ///< Of the MAC "tdma".
  EdcaParameters edca{};  ///< Of the MAC "edca"; empty: default_edca() of the standard.
  IdealParameters ideal{};
  std::uint32_t queue_frames{500};
  Duration queue_lifetime{std::chrono::milliseconds{500}};
  std::string error_model{"nist"};
  DecibelMilliwatt cca_preamble{-82.0};
  DecibelMilliwatt cca_energy{-62.0};
  DecibelMilliwatt sensitivity{-101.0};
  DecibelMilliwatt detection_minimum{-82.0};
  Decibel detection_minimum_sinr{4.0};
  Decibel capture_in_preamble{std::numeric_limits<double>::infinity()};  ///< +inf: never.
  Decibel capture_in_frame{std::numeric_limits<double>::infinity()};     ///< +inf: never.
  /// Transmissions that arrive with less than noise less this are left out at a receiver: they are
  /// not interference either. One adds less than 1 % to the noise.
  Decibel arrival_floor_below_noise{20.0};
  ChannelParameters channel{};
  DisruptionParameters disruption{};
  std::vector<JammerParameters> jammers{};
  AntennaParameters antenna{};
  std::vector<AirNode> nodes{};
  std::vector<ErrorModelMaker> more_error_models{};  ///< That `error_model` may name besides ours.
  std::vector<MacMaker> more_macs{};                 ///< That `mac` may name besides ours.
};

/// A frame handed to the air.
struct OfferedFrame {
  std::uint64_t id{};  ///< The caller's; not interpreted.
  std::int32_t destination{kGroup};
  std::uint32_t psdu_bytes{};  ///< With a non-QoS header, whatever the MAC sends.
  std::uint8_t priority{};     ///< 802.1D user priority, 0 ... 7.
};

/// A frame arrived at a node that it was meant for.
struct Delivery {
  SimTime time;
  std::uint64_t id;
  std::uint32_t sender;
  std::uint32_t receiver;
  DecibelMilliwatt received_power;
  std::uint32_t rate_kbps{};
};

/// A frame is over: nothing of it is on the air or will be.
struct FrameReport {
  std::uint64_t id{};
  std::uint32_t sender{};
  std::int32_t destination{};
  std::uint32_t psdu_bytes{};
  std::uint8_t priority{};
  SimTime sent_at{};
  std::uint32_t attempts{};
  SendOutcome outcome{};
  std::uint32_t deliveries{};
  SimTime first_delivery{};  ///< Valid when there are deliveries.
  /// Why its last attempt did not get through, of an individually addressed frame without
  /// deliveries; kNone when no attempt was made or an RTS that arrived was not answered.
  LossCause last_loss{LossCause::kNone};

  /// Of a frame that is just offered. No radio answers one that is addressed to its own sender.
  [[nodiscard]] static FrameReport of(std::uint32_t node, SimTime sent_at,
                                      const OfferedFrame& frame) {
    return {.id = frame.id,
            .sender = node,
            .destination =
                frame.destination == static_cast<std::int32_t>(node) ? kNobody : frame.destination,
            .psdu_bytes = frame.psdu_bytes,
            .priority = frame.priority,
            .sent_at = sent_at};
  }
};

/// Whoever is told what becomes of frames. May call Air::offer() from within.
class AirListener {
 public:
  virtual ~AirListener() = default;
  virtual void delivered(const Delivery& delivery) = 0;
  virtual void finished(const FrameReport& report) = 0;
};

/// The air of a run: every node's MAC and PHY and the channel between them.
///
/// A transmission is five sweeps over the nodes that it reaches, in the order of their distance:
/// energy begins, preamble detected, SIGNAL field over, energy ends, PPDU over. A sweep is
/// interrupted wherever another event comes first, so the order of events is exact, and costs one
/// entry in the event queue where it is not.
class Air final : public FrameCarrier, private MacHost {
 public:
  /// `positions`, `listener` and `monitor`, if any, must outlive this object.
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  Air(const AirParameters& parameters, PositionSource& positions, AirListener& listener,
      AirMonitor* monitor = nullptr);

  void offer(std::uint32_t node, SimTime sent_at, const OfferedFrame& frame) override;
  bool run_next(SimTime limit) override;
  void run_until(SimTime limit) override;
  [[nodiscard]] SimTime now() const override { return now_; }
  [[nodiscard]] std::optional<SimTime> next_event() const override;
  [[nodiscard]] std::optional<SimTime> next_delivery_bound() const override;
  [[nodiscard]] std::uint32_t node_count() const override {
    return static_cast<std::uint32_t>(stations_.size());
  }
  [[nodiscard]] std::uint32_t queue_places() const override;
  [[nodiscard]] const Tally& tally(std::uint32_t node) const override {
    return stations_[node].tally;
  }
  [[nodiscard]] std::uint64_t events() const override { return events_; }
  [[nodiscard]] const MacParameters& mac() const { return mac_; }
  [[nodiscard]] DecibelMilliwatt noise() const;

 private:
  /// How a sender reaches a receiver, while nobody moves.
  struct Reach {
    std::uint32_t receiver;
    Duration delay;
    double received_dbm;
    double received_mw;
  };
  struct Station {
    Station(const ReceiverModel& model, std::uint32_t node, std::uint64_t seed,
            std::unique_ptr<RateControl> rate_control);
    Receiver receiver;
    std::unique_ptr<RateControl> rates;
    std::unique_ptr<Mac> mac;
    Tally tally{};
    bool busy{false};
    std::array<EventId, kMacTimers> timers{};
    std::uint64_t transmissions{0};
    std::uint64_t reach_version{0};
    std::vector<Reach> reach;  ///< By delay.
  };
  enum class Phase : std::uint8_t { kBegin, kDetect, kHeader, kEnergyEnds, kFinish };
  static constexpr std::size_t kPhases = 5;
  struct Transmission {
    Ppdu ppdu;
    PpduTiming timing;
    std::array<SimTime, kPhases> phase_at{};  ///< At the antenna of the sender.
    std::array<std::uint32_t, kPhases> next{};
    std::vector<Arrival> arrivals;  ///< By delay.
    bool active{false};
  };
  /// A frame between offer() and finished().
  struct Pending {
    FrameReport report;
    std::uint32_t references{0};  ///< The MAC, and transmissions that carry it.
  };
  struct Step {
    enum class Kind : std::uint8_t { kOffer, kSweep, kTransmissionEnd, kTimer, kJamming };
    Kind kind{Kind::kOffer};
    std::uint8_t detail{0};  ///< Phase or MacTimer.
    std::uint32_t index{0};  ///< Pending frame, transmission, or node.
  };

  // MacHost
  void transmit(std::uint32_t node, const MacFrame& frame, const Mode& mode,
                std::uint32_t psdu_bytes) override;
  void set_timer(std::uint32_t node, MacTimer timer, SimTime time) override;
  void cancel_timer(std::uint32_t node, MacTimer timer) override;
  void finished(std::uint32_t node, const Msdu& msdu, SendOutcome outcome,
                std::uint32_t attempts) override;

  void update_reach(std::uint32_t sender);
  void spread(Transmission& transmission, std::uint32_t sender);
  [[nodiscard]] static std::uint64_t rank_of_phase(Phase phase, std::uint32_t index);
  void sweep(std::uint32_t index, Phase phase, SimTime limit);
  void leave_out(const Ppdu& ppdu, std::uint32_t receiver);
  void report_reception(const Transmission& transmission, const Arrival& arrival);
  void sweep_one(Transmission& transmission, Phase phase, Arrival& arrival);
  [[nodiscard]] bool disrupted(const Transmission& transmission, const Arrival& arrival) const;
  void finish_arrival(Transmission& transmission, Arrival& arrival);
  void end_of_sweeps(std::uint32_t index);
  void update_jamming();
  void update_medium(std::uint32_t node);
  void release(std::uint32_t frame);
  [[nodiscard]] bool meant_for(const MacFrame& frame, std::uint32_t node) const;

  std::uint64_t seed_;
  const Standard* standard_;
  MacParameters mac_;
  std::unique_ptr<const ErrorModel> errors_;
  ReceiverModel receiver_model_;
  Channel channel_;
  LinkTerms links_;
  std::unique_ptr<const Antenna> antenna_;  ///< Nothing: isotropic.
  std::optional<Disruption> disruption_;
  std::optional<Jamming> jamming_;
  double floor_mw_;
  double reach_floor_mw_;  ///< What is below on average is below the floor in every frame.
  Duration shortest_airtime_;
  std::vector<AirNode> radios_;
  PositionSource* positions_;
  AirListener* listener_;
  AirMonitor* monitor_;  ///< Nothing: nobody asks.

  EventQueue<Step> queue_;
  SimTime now_{};
  std::uint64_t events_{0};
  std::vector<Station> stations_;
  SlotPool<Transmission> transmissions_;
  SlotPool<Pending> pending_;
};

}  // namespace cuscus::netsim
