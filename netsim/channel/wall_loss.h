#pragma once

#include <array>

#include "common/city/city.h"
#include "common/units/decibel.h"

namespace cuscus::netsim {

/// What a slab lets through that a wave meets at right angles,
///
///   T = (1 - r²) e^(-jq) / (1 - r² e^(-2jq)),   q = 2π d √η / λ,   r = (1 - √η) / (1 + √η),
///   η = a f^b - j 17.98 c f^d' / f,
///
/// with d its thickness [m], f the frequency [GHz], and the loss -20 log₁₀ |T|.
///
/// Source: Recommendation ITU-R P.2040-3 (2023), equations for a single slab, and table 3 for the
/// constants a to d'; valid from 1 to 40 GHz (brick) or 100 GHz (others). Reflections within the
/// slab make the loss ripple with the frequency and the thickness. Checked in wall_loss_test.cc.
struct SlabMaterial {
  double a;
  double b;
  double c;
  double d;
};
[[nodiscard]] Decibel slab_loss(const SlabMaterial& material, double thickness_m,
                                double carrier_hz);

/// What walls of buildings take, once each.
struct WallLosses {
  std::array<Decibel, city::kMaterials> outer{};  ///< By city::Material.
  Decibel inner{};
};

/// Those of the CUSCUS paper (section 4: stone 12 dB, concrete 15 dB) and of ns-3's buildings, from
/// which it took them (wood 4 dB, glass as concrete with windows, 7 dB; inner walls 5 dB); brick of
/// 36 cm and metal as p2040_walls().
[[nodiscard]] WallLosses paper_walls(double carrier_hz);

/// Slabs of ITU-R P.2040: stone as marble of 40 cm, concrete of 20 cm, brick of 36 cm, glass of 12
/// mm, wood of 10 cm; metal 60 dB, what comes through joints and openings of such a house; inner
/// walls of two plasterboards of 12.5 mm.
[[nodiscard]] WallLosses p2040_walls(double carrier_hz);

/// What a way of this length through leaves takes,
///
///   A = A_m (1 - exp(-d γ / A_m))  dB,
///
/// with γ and A_m of a mixed forest by frequency: 0.949 GHz 0.17 dB/m and 26.5 dB, 1.852 GHz 0.30
/// and 29.0, 2.117 GHz 0.34 and 34.1, above 2.4 GHz 0.36 and 35, between them in proportion.
/// Source: Recommendation ITU-R P.833-9, section 3 (terminal within the wood). Above 2.117 GHz the
/// constants are continued, not measured.
[[nodiscard]] Decibel foliage_loss(double length_m, double carrier_hz);

}  // namespace cuscus::netsim
