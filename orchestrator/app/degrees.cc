#include "orchestrator/app/degrees.h"

#include <fmt/format.h>

#include <charconv>
#include <span>

#include "orchestrator/app/exit_code.h"

namespace cuscus::orchestrator {
namespace {

/// Fills `numbers` from "1,2.5,-3"; false when the text is anything else.
bool parse_numbers(const std::string& text, std::span<double> numbers) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, numbers[i], std::chars_format::fixed);
    const bool last = i + 1 == numbers.size();
    if (error != std::errc{} || (last ? next != end : next == end || *next != ',')) {
      return false;
    }
    at = last ? next : next + 1;
  }
  return true;
}

}  // namespace

DegreeBox parse_degree_box(const char* option, const std::string& text) {
  std::array<double, 4> degrees{};
  const bool good = parse_numbers(text, degrees);
  const auto [west, south, east, north] = degrees;
  // Written so that NaN is refused too.
  if (!good || !(west >= -180.0 && west < east && east <= 180.0) ||
      !(south >= -90.0 && south < north && north <= 90.0)) {
    throw UsageError{fmt::format(
        "{} {}: allowed: WEST,SOUTH,EAST,NORTH in degrees, such as 11.33,44.49,11.35,44.50", option,
        text)};
  }
  return {west, south, east, north};
}

std::array<double, 2> parse_degree_pair(const char* option, const std::string& text) {
  std::array<double, 2> degrees{};
  // A city cannot lie on a pole, where east is nowhere.
  constexpr double kLastLatitude_deg = 85.0;
  if (!parse_numbers(text, degrees) ||
      !(degrees[0] >= -kLastLatitude_deg && degrees[0] <= kLastLatitude_deg) ||
      !(degrees[1] >= -179.0 && degrees[1] <= 179.0)) {
    throw UsageError{
        fmt::format("{} {}: allowed: LATITUDE,LONGITUDE in degrees, such as 44.5,11.35, within -85 "
                    "... 85 and -179 ... 179",
                    option, text)};
  }
  return degrees;
}

}  // namespace cuscus::orchestrator
