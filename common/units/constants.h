#pragma once

namespace cuscus {

/// Speed of light in vacuum (exact: BIPM, SI Brochure, 9th ed., 2019).
inline constexpr double kSpeedOfLight_mps = 299'792'458.0;

/// Boltzmann constant (exact: BIPM, SI Brochure, 9th ed., 2019).
inline constexpr double kBoltzmann_JpK = 1.380'649e-23;

/// Standard noise temperature T0 (IEEE Std 211).
inline constexpr double kNoiseTemperature_K = 290.0;

/// Standard acceleration of gravity, rounded as FL-AIR and most autopilots have it.
inline constexpr double kGravity_mps2 = 9.81;

}  // namespace cuscus
