#pragma once

#include <cstdint>

#include "common/units/sim_time.h"

namespace cuscus::gcs {

/// Which numbers of a sender's sequence have arrived: its loss, told from gaps.
///
/// Numbers may arrive late or twice. An old one that tells of a later time than the newest, or that
/// lies further back than the window, means that the sender began anew, and the tally does too.
/// Numbers wrap at 2^32 (RFC 1982).
class SequenceTally {
 public:
  enum class Arrival {
    kNewest,     ///< Later than all before.
    kLate,       ///< Overtaken by a later one.
    kDuplicate,  ///< Arrived before.
  };

  /// How many of the latest numbers recent_loss_ratio() looks at.
  static constexpr std::uint32_t kWindow = 64;

  /// Counts a number that arrived with something that was true at `at`.
  Arrival count(std::uint32_t sequence, SimTime at) noexcept;

  [[nodiscard]] std::uint64_t received() const noexcept { return received_; }
  /// Numbers from the first that arrived to the newest, both included.
  [[nodiscard]] std::uint64_t expected() const noexcept { return expected_; }
  /// Share of the expected numbers that did not arrive, 0 ... 1; 0 before the first.
  [[nodiscard]] double loss_ratio() const noexcept;
  /// The same of the latest kWindow numbers.
  [[nodiscard]] double recent_loss_ratio() const noexcept;

 private:
  void restart(std::uint32_t sequence) noexcept;

  std::uint32_t newest_{0};
  SimTime newest_at_;
  std::uint64_t window_{0};  // bit i: number newest_ - i has arrived
  std::uint64_t received_{0};
  std::uint64_t expected_{0};
};

}  // namespace cuscus::gcs
