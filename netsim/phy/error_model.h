#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "netsim/makers/maker.h"
#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// How likely a bit of a frame is to be wrong after decoding.
class ErrorModel {
 public:
  virtual ~ErrorModel() = default;

  /// Probability, 0 ... 1, that a decoded bit starts an error at this ratio of signal to noise and
  /// interference in the channel's bandwidth. n bits survive with probability (1 - p)^n.
  [[nodiscard]] virtual double bit_failure(Modulation modulation, CodeRate code_rate,
                                           double sinr_ratio) const = 0;
};

/// The NIST model of OFDM in white noise: hard decisions, union bound of a K = 7 convolutional
/// code.
///
///   p_b   BPSK ½ erfc √γ, QPSK ½ erfc √(γ/2), M-QAM with s = √M:
///         ((s-1) / (s log₂ s)) erfc √(γ / (2(M-1)/3))
///   D     √(4 p_b (1 - p_b))
///   p     (1/2b) Σ_d c_d D^d, b = 1, 2, 3 for code rates 1/2, 2/3, 3/4; at most 1
///
/// γ is the SINR in the channel's bandwidth; c_d is the bit weight spectrum of the punctured code.
/// Sources: G. Pei, T. R. Henderson, "Validation of OFDM error rate model in ns-3", 2010, after
/// L. E. Miller, "Validation of 802.11a/UWB coexistence simulation", NIST, 2003; weights: P.
/// Frenger et al., "Multi-rate convolutional codes", Chalmers, 1998, and D. Haccoun, G. Begin, IEEE
/// Trans. Commun. 37(11), 1989. Pessimistic by 3 to 4 dB against soft-decision receivers.
/// DSSS and CCK: dsss_bit_failure().
class NistErrorModel final : public ErrorModel {
 public:
  [[nodiscard]] double bit_failure(Modulation modulation, CodeRate code_rate,
                                   double sinr_ratio) const override;
};

/// The YANS model of OFDM in white noise: hard decisions, exact binomials of the free distance.
///
///   E_b/N_0  γ B / R_c: R_c the coded bit rate [b/s], B the channel's bandwidth
///   p_b      BPSK ½ erfc √(E_b/N_0); M-QAM (QPSK is M = 4) with m = log₂ M:
///            (1 - (1 - (1 - 1/√M) erfc √(1.5 m E_b/N_0 / (M-1)))²) / m
///   P(d)     Σ_{i > d/2} C(d,i) p_b^i (1-p_b)^(d-i), and half of the term i = d/2 where d is even
///   p        Σ a_d P(d): d = 10, a = 11 at code rate 1/2; d = 6, 7, a = 1, 16 at 2/3; d = 5, 6,
///            a = 8, 31 at 3/4, with BPSK the first term alone; at most 1
///
/// Source: M. Lacage, T. R. Henderson, "Yet another network simulator", WNS2 2006, as ns-3 has it.
/// R_c/B follows from the modulation: 12, 24, 48 and 72 Mb/s in 20 MHz. Closer to soft decisions
/// than NIST, by 3 dB.
/// DSSS and CCK: dsss_bit_failure().
class YansErrorModel final : public ErrorModel {
 public:
  [[nodiscard]] double bit_failure(Modulation modulation, CodeRate code_rate,
                                   double sinr_ratio) const override;
};

/// DSSS and CCK in white noise: the same in every error model.
///
///   1 Mb/s    DBPSK, ½ e^-γ_b
///   2 Mb/s    Gray-coded DQPSK, Q₁(a, b) - ½ I₀(ab) e^(-(a²+b²)/2),
///             a, b = √(2 γ_b (1 ∓ √½))
///   CCK       1 - (1 - min(1, Σ_c Q(√(d_c² E_c / 2N_0))))^(1/m): union bound over all other code
///             words, at squared distances d_c² from the transmitted one; m = 4 or 8 bits per word
///
/// γ_b = E_b/N_0 = γ · 20 MHz / R, the noise counted in 20 MHz; E_c/N_0 = γ · 20/11 per chip.
/// Sources: J. G. Proakis, "Digital Communications", 4th ed., 2001, section 5.2.8; code words: IEEE
/// Std 802.11-2016, 16.3.6.6. Coherent detection of the code words, whose first phase is
/// differential in the standard: optimistic by less than 1 dB.
[[nodiscard]] double dsss_bit_failure(Modulation modulation, double sinr_ratio);

using ErrorModelMaker = Maker<const ErrorModel>;

/// The error model of that name: "nist", "yans", "table", or one of `more`.
/// @throws std::invalid_argument naming those that exist.
[[nodiscard]] std::unique_ptr<const ErrorModel> make_error_model(
    std::string_view name, std::span<const ErrorModelMaker> more = {});

/// Probability that all of `bits` survive, (1 - p)^bits, as a natural logarithm: logarithms of the
/// pieces of a frame add.
[[nodiscard]] double log_success(double bit_failure, double bits);

}  // namespace cuscus::netsim
