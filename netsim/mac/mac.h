#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "common/random/counter_stream.h"
#include "common/units/sim_time.h"
#include "netsim/mac/rate_control.h"
#include "netsim/makers/maker.h"
#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// To whom a frame goes: a node's number, or one of these.
inline constexpr std::int32_t kGroup = -1;   ///< Broadcast or multicast.
inline constexpr std::int32_t kNobody = -2;  ///< An address that no node has.

/// 802.1D user priorities, 0 ... 7.
inline constexpr std::size_t kPriorities = 8;

/// A frame in a station's queue.
struct Msdu {
  std::uint32_t frame{};  ///< The caller's number for it.
  std::int32_t destination{kGroup};
  std::uint32_t psdu_bytes{};  ///< With a non-QoS header.
  std::uint8_t priority{};     ///< Below kPriorities.
  SimTime queued_at{};
};

/// A frame on the air.
struct MacFrame {
  enum class Kind : std::uint8_t { kData, kAck, kRts, kCts };
  Kind kind{Kind::kData};
  std::uint32_t sender{};
  std::int32_t receiver{kGroup};
  std::uint32_t frame{};     ///< Of the Msdu; data and RTS only.
  std::uint32_t sequence{};  ///< Per sender and category, kept in retries; data only.
  std::uint8_t category{};   ///< Access category; 0 where there is but one.
  Duration duration{};  ///< The Duration field: for how long after its end the medium is taken.
};

/// What became of an Msdu at its sender.
enum class SendOutcome : std::uint8_t {
  kSent,          ///< Put on the air once, and nobody is asked: group frames, and all of TDMA.
  kAcknowledged,  ///< Individually addressed: confirmed.
  kQueueFull,
  kLifetime,  ///< Waited too long for its first attempt.
  kRetryLimit,
  kTooLong,  ///< Longer than a slot: TDMA only.
};

/// Who may transmit when, by time division.
struct TdmaSchedule {
  Duration slot{std::chrono::microseconds{2500}};
  Duration guard{std::chrono::microseconds{10}};  ///< At the end of every slot nobody transmits.
  /// Owner of each slot, over and over from SimTime 0; kNobody: none. Empty: every node in turn.
  std::vector<std::int32_t> frame{};
};

/// How frames of one access category contend.
struct EdcaCategory {
  std::uint32_t aifsn{};  ///< Slots of AIFS, after SIFS.
  std::uint32_t cw_min{};
  std::uint32_t cw_max{};

  [[nodiscard]] bool operator==(const EdcaCategory&) const = default;
};
/// Background, best effort, video, voice.
using EdcaParameters = std::vector<EdcaCategory>;
inline constexpr std::size_t kAccessCategories = 4;

/// Of a station; all stations of a run share one.
struct MacParameters {
  Duration slot{};
  Duration sifs{};
  Duration difs{};
  Duration eifs{};
  std::uint32_t cw_min{};
  std::uint32_t cw_max{};
  std::uint32_t short_retry_limit{};    ///< Attempts of RTS, and of data without.
  std::uint32_t long_retry_limit{};     ///< Attempts of data after an RTS.
  std::uint32_t rts_threshold_bytes{};  ///< PSDUs above this are sent after RTS and CTS.
  std::uint32_t queue_frames{};
  Duration queue_lifetime{};  ///< Until the first attempt; after that the retry limit rules.
  const Mode*
      data_mode{};  ///< Of individually addressed frames, until a rate control knows better.
  const Mode* group_mode{};
  const Mode* rts_mode{};
  const Standard* standard{};
  std::vector<const Mode*> answers{};  ///< To frames of each mode of the standard.
  TdmaSchedule tdma{};
  EdcaParameters edca{};

  /// DIFS, EIFS and control rates that follow from a standard and its basic rates. RTS is sent at
  /// the rate at which the data would be answered.
  [[nodiscard]] static MacParameters from(const Standard& standard, Duration slot,
                                          std::uint32_t data_rate_kbps,
                                          std::uint32_t group_rate_kbps,
                                          std::span<const std::uint32_t> basic_rates_kbps,
                                          ControlAnswerRule rule = ControlAnswerRule::kSameClass);

  /// At what rate a frame of this mode is answered.
  [[nodiscard]] const Mode& answer_to(const Mode& mode) const {
    return *answers[static_cast<std::size_t>(&mode - standard->modes.data())];
  }
  /// From the end of one's own frame to giving up on the PHY-RXSTART of its answer (10.3.2.9).
  [[nodiscard]] Duration answer_timeout(const Mode& mode) const {
    return sifs + slot + answer_to(mode).format->receive_start_delay;
  }
};

enum class MacTimer : std::uint8_t { kAccess, kResponse, kAnswerTimeout, kNavReset };
inline constexpr std::size_t kMacTimers = 4;

/// What a station asks of the world around it.
class MacHost {
 public:
  virtual ~MacHost() = default;

  /// Puts a frame on the air at once. The host calls transmission_ended() after its airtime.
  virtual void transmit(std::uint32_t node, const MacFrame& frame, const Mode& mode,
                        std::uint32_t psdu_bytes) = 0;
  /// Calls timer() at `time`; replaces the timer of that kind.
  virtual void set_timer(std::uint32_t node, MacTimer timer, SimTime time) = 0;
  virtual void cancel_timer(std::uint32_t node, MacTimer timer) = 0;
  /// The station is done with an Msdu.
  virtual void finished(std::uint32_t node, const Msdu& msdu, SendOutcome outcome,
                        std::uint32_t attempts) = 0;
};

/// One station's medium access. Times must not decrease from call to call.
class Mac {
 public:
  virtual ~Mac() = default;

  /// A program sent a frame; MacHost::finished() says what became of it.
  virtual void enqueue(SimTime now, const Msdu& msdu) = 0;

  // What the PHY says.
  virtual void medium_busy(SimTime now) = 0;
  virtual void medium_idle(SimTime now) = 0;
  virtual void reception_started(SimTime now) = 0;  ///< SIGNAL field decoded: PHY-RXSTART.
  virtual void reception_failed(SimTime now) = 0;
  /// True when the frame is for this station and is not a repetition.
  virtual bool received(SimTime now, const MacFrame& frame, const Mode& mode) = 0;
  virtual void transmission_ended(SimTime now) = 0;

  virtual void timer(SimTime now, MacTimer timer) = 0;
};

/// What a MAC is made of. `parameters`, `host` and `rates` must outlive it.
struct MacSetting {
  std::uint32_t node{};
  const MacParameters* parameters{};
  MacHost* host{};
  RateControl* rates{};
  random::CounterStream draws{0, 0};
};

using MacMaker = Maker<Mac, MacSetting>;

/// The MAC of that name: "dcf", "edca", "tdma", or one of `more`. "ideal" is listed and refused: it
/// is an air of its own (IdealAir).
/// @throws std::invalid_argument naming those that exist.
[[nodiscard]] std::unique_ptr<Mac> make_mac(std::string_view name, const MacSetting& setting,
                                            std::span<const MacMaker> more = {});

}  // namespace cuscus::netsim
