#pragma once

#include <cstdint>

#include "common/units/decibel.h"
#include "netsim/channel/gaussian_field.h"

namespace cuscus::netsim {

/// Large-scale variation around the basic loss: σ G(r_L, r_H) dB, G a GaussianField, so that it
/// falls to 1/e of its correlation when an end moves by the decorrelation distance, and links whose
/// ends are near those of another see nearly the same shadows, as in a real place.
///
/// Source: M. Gudmundson, Electronics Letters 27(23), 1991. Decorrelation distances of 3GPP TR
/// 38.901: 37 to 50 m urban macro, 10 to 13 m urban micro.
class Shadowing final {
 public:
  struct Parameters {
    double deviation_db{0.0};
    double decorrelation_m{20.0};
    std::uint64_t seed{1};
  };

  explicit Shadowing(const Parameters& parameters)
      : deviation_db_{parameters.deviation_db},
        field_{{.purpose = kStream,
                .decorrelation_m = parameters.decorrelation_m,
                .seed = parameters.seed}} {}

  [[nodiscard]] Decibel loss(const Link& link) const {
    return {deviation_db_ * field_.value(link.p_WL, link.p_WH)};
  }

 private:
  static constexpr std::uint16_t kStream = 0x1007;

  double deviation_db_;
  GaussianField field_;
};

}  // namespace cuscus::netsim
