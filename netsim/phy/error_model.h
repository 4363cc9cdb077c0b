#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

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
/// γ is the SINR in 20 MHz; c_d is the bit weight spectrum of the punctured code.
/// Sources: G. Pei, T. R. Henderson, "Validation of OFDM error rate model in ns-3", 2010, after
/// L. E. Miller, "Validation of 802.11a/UWB coexistence simulation", NIST, 2003; weights: P.
/// Frenger et al., "Multi-rate convolutional codes", Chalmers, 1998, and D. Haccoun, G. Begin, IEEE
/// Trans. Commun. 37(11), 1989. Pessimistic by 3 to 4 dB against soft-decision receivers.
class NistErrorModel final : public ErrorModel {
 public:
  [[nodiscard]] double bit_failure(Modulation modulation, CodeRate code_rate,
                                   double sinr_ratio) const override;
};

/// The error model of that name.
/// @throws std::invalid_argument naming those that exist.
[[nodiscard]] std::unique_ptr<const ErrorModel> make_error_model(std::string_view name);

/// Probability that all of `bits` survive, (1 - p)^bits, as a natural logarithm: logarithms of the
/// pieces of a frame add.
[[nodiscard]] double log_success(double bit_failure, double bits);

}  // namespace cuscus::netsim
