#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cuscus::scenario {

/// One unit of a dimension: `value` of it are value * numerator / denominator of the SI unit. Two
/// numbers instead of one factor, because 1/1000 has no exact double and 50 / 1000 rounds only
/// once.
struct Unit {
  std::string_view name;
  double numerator;
  double denominator;
};

/// A kind of quantity and the units in which a scenario may give it.
struct Dimension {
  std::string_view name;     ///< With its article: "a time".
  std::string_view example;  ///< As it is written: "50 ms".
  std::span<const Unit> units;
};

/// A text that is no quantity of the dimension asked for; what() says what is allowed.
struct UnitError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What the SI value of each dimension is measured in stands after its name; times are in ns.
extern const Dimension kTime;             ///< [ns]
extern const Dimension kLength;           ///< [m]
extern const Dimension kSpeed;            ///< [m/s]
extern const Dimension kAcceleration;     ///< [m/s^2]
extern const Dimension kMass;             ///< [kg]
extern const Dimension kMomentOfInertia;  ///< [kg m^2]
extern const Dimension kDrag;             ///< Force per speed [N s/m].
extern const Dimension kAngle;            ///< [rad]
extern const Dimension kAngularRate;      ///< [rad/s]
extern const Dimension kFrequency;        ///< [Hz]
extern const Dimension kBitRate;          ///< [kb/s]
extern const Dimension kPower;            ///< A level [dBm].
extern const Dimension kPowerRatio;       ///< [dB]
extern const Dimension kVariance;         ///< Of a power ratio [dB^2].

/// The value of `text`, a decimal number and a unit such as "50 ms" or "50ms", in SI.
/// @throws UnitError when it is anything else, infinite and NaN included.
[[nodiscard]] double parse_quantity(std::string_view text, const Dimension& dimension);

/// `value` as text in the unit that reads best; parse_quantity() gives back the same double.
[[nodiscard]] std::string format_quantity(double value, const Dimension& dimension);

/// The names of the dimension's units: "ns, us, ms, s, min, h".
[[nodiscard]] std::string unit_names(const Dimension& dimension);

}  // namespace cuscus::scenario
