#pragma once

#include <cstdint>
#include <vector>

#include "netsim/link/ofdm_link.h"

namespace cuscus::netsim {

/// How thoroughly a curve is sampled.
struct LinkSampling {
  double step_db{0.5};
  std::uint64_t failures{200};       ///< Frames lost after which a point is good enough.
  std::uint64_t frames{20'000};      ///< Sent at most.
  std::uint64_t least_failures{30};  ///< A point with fewer ends the curve.
  std::uint64_t seed{1};
};

/// What frames of one length went through at one SNR.
struct LinkPoint {
  double snr_db{};
  std::uint64_t frame_bits{};
  std::uint64_t frames{};
  std::uint64_t failures{};

  /// Probability that a bit starts an error, p of (1 - p)^bits = share of frames that survive.
  [[nodiscard]] double bit_failure() const;
};

/// Sizes of the frames: SERVICE field and 32 B where nearly all longer ones are lost, else 1458 B.
inline constexpr std::uint64_t kShortFrameBits = 16 + 8 * 32;
inline constexpr std::uint64_t kLongFrameBits = 16 + 8 * 1458;

/// Sends frames until enough are lost.
[[nodiscard]] LinkPoint sample_link(const OfdmLink& link, double snr_db, std::uint64_t frame_bits,
                                    const LinkSampling& sampling);

/// From where even short frames are nearly all lost to where nearly no long one is.
[[nodiscard]] std::vector<LinkPoint> link_curve(Modulation modulation, CodeRate code_rate,
                                                const LinkSampling& sampling);

}  // namespace cuscus::netsim
