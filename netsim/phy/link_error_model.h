#pragma once

#include "netsim/phy/error_model.h"

namespace cuscus::netsim {

/// OFDM in white noise with a receiver of soft decisions: rates found by simulating the link bit by
/// bit (OfdmLink: the standard's code, interleaver and mapping, a channel estimated from the long
/// training symbols, Viterbi), and interpolated.
///
///   lg p   linear in the SINR [dB] between points 0.5 dB apart; beyond them as between the last
///   two
///
/// where a share (1 - p)^n of frames of n bits survived at each point: n = 11 680 (1458 B and the
/// SERVICE field), or 272 (32 B) where nearly all of those were lost. Sampled until 200 frames were
/// lost, or 20 000 sent: to 7 % of p, 20 % at the last point. γ is the SINR in the channel's
/// bandwidth, 64/52 of it in a subcarrier.
///
/// Source: netsim/phy/link_error_table.inc, as `cuscus-link` prints it. Leaves out what OfdmLink
/// does. A frame's estimate of the channel is good or bad as a whole, so that losses are not quite
/// independent from bit to bit: other lengths than the sampled one are off by up to 0.2 dB. Checked
/// in tests/validation/netsim/link_test.cc against the simulation and against rates published for
/// another one.
/// DSSS and CCK: dsss_bit_failure().
class LinkErrorModel final : public ErrorModel {
 public:
  [[nodiscard]] double bit_failure(Modulation modulation, CodeRate code_rate,
                                   double sinr_ratio) const override;
};

}  // namespace cuscus::netsim
