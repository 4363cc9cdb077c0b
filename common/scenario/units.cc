#include "common/scenario/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <system_error>

namespace cuscus::scenario {
namespace {

using std::numbers::pi;

// Within a dimension, from small to large; one has numerator = denominator: the SI unit. A second
// spelling of the same unit is accepted, never written.
constexpr std::array kTimeUnits{Unit{"ns", 1, 1},  Unit{"us", 1e3, 1},   Unit{"ms", 1e6, 1},
                                Unit{"s", 1e9, 1}, Unit{"min", 60e9, 1}, Unit{"h", 3600e9, 1}};
constexpr std::array kLengthUnits{Unit{"mm", 1, 1000}, Unit{"cm", 1, 100}, Unit{"m", 1, 1},
                                  Unit{"km", 1000, 1}};
constexpr std::array kSpeedUnits{Unit{"m/s", 1, 1}, Unit{"km/h", 1, 3.6}};
constexpr std::array kAccelerationUnits{Unit{"m/s2", 1, 1}, Unit{"m/s^2", 1, 1}};
constexpr std::array kMassUnits{Unit{"g", 1, 1000}, Unit{"kg", 1, 1}};
constexpr std::array kMomentOfInertiaUnits{Unit{"kg m2", 1, 1}, Unit{"kg m^2", 1, 1}};
constexpr std::array kDragUnits{Unit{"N s/m", 1, 1}, Unit{"N/(m/s)", 1, 1}};
constexpr std::array kAngleUnits{Unit{"deg", pi, 180}, Unit{"rad", 1, 1}};
constexpr std::array kAngularRateUnits{Unit{"deg/s", pi, 180}, Unit{"rad/s", 1, 1}};
constexpr std::array kFrequencyUnits{Unit{"Hz", 1, 1}, Unit{"kHz", 1e3, 1}, Unit{"MHz", 1e6, 1},
                                     Unit{"GHz", 1e9, 1}};
constexpr std::array kBitRateUnits{Unit{"kb/s", 1, 1}, Unit{"Mb/s", 1000, 1}, Unit{"kbps", 1, 1},
                                   Unit{"Mbps", 1000, 1}};
constexpr std::array kPowerUnits{Unit{"dBm", 1, 1}};
constexpr std::array kPowerRatioUnits{Unit{"dB", 1, 1}, Unit{"dBi", 1, 1}};
constexpr std::array kVarianceUnits{Unit{"dB2", 1, 1}, Unit{"dB^2", 1, 1}};

std::string quoted(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::string result{'"'};
  result += text.substr(0, kShown);
  result += text.size() > kShown ? "...\"" : "\"";
  return result;
}

[[noreturn]] void fail(std::string_view text, const std::string& what, const Dimension& dimension) {
  throw UnitError{quoted(text) + " " + what + "; allowed: " + std::string{dimension.name} + " in " +
                  unit_names(dimension) + ", such as \"" + std::string{dimension.example} + "\""};
}

double in_si(double value, const Unit& unit) { return value * unit.numerator / unit.denominator; }

/// `value` to 12 significant digits: 0.05 deg is 0.05 again after its way through radians.
double rounded(double value) {
  std::array<char, 40> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::scientific, 11);
  double result = value;
  if (error == std::errc{}) {
    static_cast<void>(std::from_chars(buffer.data(), end, result));
  }
  return result;
}

std::string shortest(double value) {
  std::array<char, 40> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed);
  if (error == std::errc{}) {
    return {buffer.data(), end};
  }
  const auto [end2, error2] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  static_cast<void>(error2);  // 40 characters hold any double in the shortest form
  return {buffer.data(), end2};
}

}  // namespace

const Dimension kTime{"a time", "50 ms", kTimeUnits};
const Dimension kLength{"a length", "20 m", kLengthUnits};
const Dimension kSpeed{"a speed", "2 m/s", kSpeedUnits};
const Dimension kAcceleration{"an acceleration", "9.81 m/s2", kAccelerationUnits};
const Dimension kMass{"a mass", "1.5 kg", kMassUnits};
const Dimension kMomentOfInertia{"a moment of inertia", "0.006 kg m2", kMomentOfInertiaUnits};
const Dimension kDrag{"a drag coefficient", "0.4 N s/m", kDragUnits};
const Dimension kAngle{"an angle", "90 deg", kAngleUnits};
const Dimension kAngularRate{"an angular rate", "0.5 deg/s", kAngularRateUnits};
const Dimension kFrequency{"a frequency", "2.437 GHz", kFrequencyUnits};
const Dimension kBitRate{"a bit rate", "6 Mb/s", kBitRateUnits};
const Dimension kPower{"a power level", "16 dBm", kPowerUnits};
const Dimension kPowerRatio{"a power ratio", "7 dB", kPowerRatioUnits};
const Dimension kVariance{"a variance", "4 dB2", kVarianceUnits};

std::string unit_names(const Dimension& dimension) {
  std::string names;
  for (const Unit& unit : dimension.units) {
    names += (names.empty() ? "" : ", ") + std::string{unit.name};
  }
  return names;
}

double parse_quantity(std::string_view text, const Dimension& dimension) {
  constexpr std::size_t kLongest = 64;
  if (text.size() > kLongest) {
    fail(text, "is longer than any quantity", dimension);
  }
  double value = 0.0;
  const std::size_t plus = text.starts_with('+') && !text.starts_with("+-") ? 1 : 0;
  const std::size_t sign = plus == 1 || text.starts_with('-') ? 1 : 0;
  // from_chars also reads "inf" and "nan"; a quantity begins with a digit or a point.
  const bool is_number =
      text.size() > sign && (text[sign] == '.' || (text[sign] >= '0' && text[sign] <= '9'));
  const char* const begin = text.data() + plus;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = is_number ? std::from_chars(begin, end, value)
                                       : std::from_chars_result{begin, std::errc::invalid_argument};
  if (error == std::errc::result_out_of_range) {
    fail(text, "is beyond the largest or smallest number", dimension);
  }
  if (error != std::errc{}) {
    fail(text, "is not a number with a unit", dimension);
  }
  std::string_view unit_name{rest, static_cast<std::size_t>(end - rest)};
  if (unit_name.starts_with(' ')) {
    unit_name.remove_prefix(1);
  }
  if (unit_name.empty()) {
    fail(text, "has no unit", dimension);
  }
  for (const Unit& unit : dimension.units) {
    if (unit.name == unit_name) {
      const double si = in_si(value, unit);
      if (!std::isfinite(si)) {
        fail(text, "is beyond the largest number", dimension);
      }
      return si + 0.0;  // -0 becomes 0
    }
  }
  fail(text, "has the unit " + quoted(unit_name), dimension);
}

std::string format_quantity(double value, const Dimension& dimension) {
  std::string best;
  bool best_is_handy = false;
  for (const Unit& unit : dimension.units) {
    const double scaled = value * unit.denominator / unit.numerator;
    for (const double candidate : {rounded(scaled), scaled}) {
      if (in_si(candidate, unit) != value) {
        continue;  // would not read back as the same number
      }
      const std::string text = shortest(candidate) + " " + std::string{unit.name};
      const bool is_handy = std::abs(candidate) >= 1.0 && std::abs(candidate) < 1000.0;
      if (best.empty() || is_handy > best_is_handy ||
          (is_handy == best_is_handy && text.size() < best.size())) {
        best = text;
        best_is_handy = is_handy;
      }
    }
  }
  return best;
}

}  // namespace cuscus::scenario
