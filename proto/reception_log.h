#pragma once

#include <cstdint>

#include "proto/shm/layout.h"

/// The reception log of a run: netsim writes it, `cuscus why` reads it. Little-endian, as written
/// by the machine that ran it:
///
///   ReceptionLogHeader
///   node_count names, each ended by a zero byte; together name_bytes
///   ReceptionLogRecords until the end of the file; a last one that is cut short is none
namespace cuscus::logs {

struct ReceptionLogHeader {
  static constexpr std::uint64_t kMagic = shm::magic_of("CUSRECEP");
  static constexpr std::uint32_t kVersion = 2;  ///< Any change of what follows raises it.

  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t record_bytes;
  std::uint32_t node_count;
  std::uint32_t name_bytes;
};
static_assert(sizeof(ReceptionLogHeader) == 24);

enum class RecordKind : std::uint8_t {
  kReception = 1,  ///< A PPDU at a node that it was meant for.
  kGivenUp = 2,    ///< A frame that its sender gave up; `cause` says why.
  /// A frame that a kReception says was received, and that did not get into the interface.
  kCopyLost = 3,
};

enum class PpduKind : std::uint8_t { kData = 0, kAck = 1, kRts = 2, kCts = 3 };

/// What became of it. Numbers stay what they are.
enum class Cause : std::uint8_t {
  kReceived = 0,
  // kReception; docs/models/reception.md
  kBelowFloor = 1,
  kBelowDetection = 2,
  kNoise = 3,
  kCollision = 4,
  kInterference = 5,
  kHalfDuplex = 6,
  kJammed = 7,
  // kCopyLost
  kLinkDown = 20,   ///< The interface was down or full.
  kLate = 21,       ///< The emulator was over 1 s late.
  kNeverCame = 22,  ///< The kernel lost its bytes between the sender and the emulator.
  // kGivenUp
  kQueueFull = 40,
  kLifetime = 41,
  kRetryLimit = 42,
  kTooLong = 43,  ///< Fits into no slot of TDMA.
};

/// Why a frame arrived as strong as it did: power = tx_power + tx_antenna + rx_antenna - basic_loss
/// - obstacle_loss - foliage_loss - shadowing_loss - fading_loss, to the rounding of float. dBm,
/// then dB.
struct LinkBudget {
  float tx_power_dbm;
  float tx_antenna_db;
  float rx_antenna_db;
  float basic_loss_db;
  float obstacle_loss_db;  ///< Of walls and what goes around them.
  float foliage_loss_db;
  float shadowing_loss_db;
  float fading_loss_db;  ///< Of this PPDU: fading, and the paper's Psi.

  [[nodiscard]] float power_dbm() const {
    return tx_power_dbm + tx_antenna_db + rx_antenna_db - basic_loss_db - obstacle_loss_db -
           foliage_loss_db - shadowing_loss_db - fading_loss_db;
  }
};

inline constexpr std::uint32_t kNoInterferer = 0xffff'ffffU;
inline constexpr std::int32_t kToGroup = -1;
inline constexpr std::int32_t kToNobody = -2;

struct ReceptionLogRecord {
  std::int64_t begins_ns;  ///< SimTime at the sender's antenna; kGivenUp: when it was sent.
  std::int64_t over_ns;    ///< SimTime at the receiver; kGivenUp: 0.
  std::uint64_t frame;     ///< The same in all records of one frame; 0: ACK or CTS.
  std::uint32_t sender;
  std::uint32_t receiver;    ///< kGivenUp: 0.
  std::int32_t destination;  ///< Node, kToGroup or kToNobody.
  std::uint32_t interferer;  ///< Sender of the strongest other frame, or kNoInterferer.
  std::uint32_t psdu_bytes;
  std::uint32_t rate_kbps;  ///< kReception only, as all that follows power_dbm.
  std::uint16_t attempt;    ///< From 1; kGivenUp: how many there were.
  RecordKind kind;
  PpduKind ppdu_kind;
  Cause cause;
  std::uint8_t reserved[3];
  float power_dbm;  ///< With which the air reckoned.
  float sinr_db;    ///< The worst that it was decided on; NaN where there was none.
  LinkBudget budget;
};
static_assert(sizeof(ReceptionLogRecord) == 96);

}  // namespace cuscus::logs
