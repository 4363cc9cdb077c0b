#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/units/decibel.h"

namespace cuscus::netsim {

/// Gain of an antenna by direction. A pure function; polarisation is not modelled.
class Antenna {
 public:
  virtual ~Antenna() = default;

  /// Over an isotropic one. `direction_B` in the body frame B (FLU), of any length above 0.
  [[nodiscard]] virtual Decibel gain(const Eigen::Vector3d& direction_B) const = 0;
};

/// A half-wave dipole along the body's z axis,
///
///   G = 1.64092 (cos(π/2 cos θ) / sin θ)²,   at least -30 dBi,
///
/// with θ the angle from the axis: 2.15 dBi at right angles to it.
///
/// Source: C. A. Balanis, "Antenna Theory", 4th ed., section 4.6; the factor is 4 / Cin(2π).
/// Far field, and no body around the antenna. Departs from it at the axis, where the formula is 0:
/// what surrounds a real antenna fills its nulls. Checked in antenna_test.cc.
class HalfWaveDipole final : public Antenna {
 public:
  static constexpr Decibel kFloor{-30.0};

  [[nodiscard]] Decibel gain(const Eigen::Vector3d& direction_B) const override;
};

/// A table of gains [dBi], by rows of one elevation each, evenly spaced from -90° to 90°; in a row
/// by azimuth, evenly spaced from 0° (ahead) counter-clockwise, 360° left out. Between entries
/// decibels are interpolated bilinearly, across 360° too. Checked in antenna_test.cc.
class AntennaPattern final : public Antenna {
 public:
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  AntennaPattern(std::vector<double> gains_dbi, std::uint32_t azimuths);

  [[nodiscard]] Decibel gain(const Eigen::Vector3d& direction_B) const override;

 private:
  [[nodiscard]] double in_row(std::size_t row, double column) const;

  std::vector<double> gains_dbi_;
  std::size_t azimuths_;
  std::size_t elevations_;
};

/// What a scenario says about antennas.
struct AntennaParameters {
  std::string model{"isotropic"};     ///< "isotropic", "dipole" or "pattern".
  std::vector<double> pattern_dbi{};  ///< See AntennaPattern.
  std::uint32_t pattern_azimuths{0};
};

/// Nothing for isotropic antennas.
/// @throws std::invalid_argument naming what is wrong and what is allowed.
[[nodiscard]] std::unique_ptr<const Antenna> make_antenna(const AntennaParameters& parameters);

/// Where an antenna is and how its body is turned.
struct AntennaPose {
  Eigen::Vector3d p_WB;
  Eigen::Quaterniond q_WB{Eigen::Quaterniond::Identity()};
};

/// Gains at both ends of a link, each towards the other: 0 dB where both are at one place, as there
/// is no direction then.
struct EndGains {
  Decibel at_a{};
  Decibel at_b{};
};
[[nodiscard]] EndGains gains_of_ends(const Antenna& antenna, const AntennaPose& a,
                                     const AntennaPose& b);
/// Their sum: the same in both directions.
[[nodiscard]] Decibel gain_of_both(const Antenna& antenna, const AntennaPose& a,
                                   const AntennaPose& b);

}  // namespace cuscus::netsim
