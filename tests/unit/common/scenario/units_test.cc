#include "common/scenario/units.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "common/random/counter_stream.h"

namespace cuscus::scenario {
namespace {

const std::array<const Dimension*, 14> kAll{
    &kTime,  &kLength,      &kSpeed,     &kAcceleration, &kMass,  &kMomentOfInertia, &kDrag,
    &kAngle, &kAngularRate, &kFrequency, &kBitRate,      &kPower, &kPowerRatio,      &kVariance};

TEST_CASE("A quantity is a number and a unit, with or without a space between") {
  CHECK(parse_quantity("50 ms", kTime) == 50e6);
  CHECK(parse_quantity("50ms", kTime) == 50e6);
  CHECK(parse_quantity("1.5 kg", kMass) == 1.5);
  CHECK(parse_quantity("250 g", kMass) == 0.25);
  CHECK(parse_quantity("-82 dBm", kPower) == -82.0);
  CHECK(parse_quantity("+3 dB", kPowerRatio) == 3.0);
  CHECK(parse_quantity("2.437 GHz", kFrequency) == 2.437e9);
  CHECK(parse_quantity("5.5 Mb/s", kBitRate) == 5500.0);
  CHECK(parse_quantity("90 deg", kAngle) == std::numbers::pi / 2);
  CHECK(parse_quantity("36 km/h", kSpeed) == 10.0);
  CHECK(parse_quantity("1e3 m", kLength) == 1000.0);
  CHECK(parse_quantity(".5 m", kLength) == 0.5);
  CHECK(parse_quantity("0.006 kg m2", kMomentOfInertia) == 0.006);
}

TEST_CASE("Minus nothing is nothing") {
  CHECK_FALSE(std::signbit(parse_quantity("-0 m", kLength)));
}

TEST_CASE("A text that is no quantity is refused with what is allowed") {
  const std::array<std::array<const char*, 2>, 14> table{{
      {"50", "\"50\" has no unit; allowed: a time in ns, us, ms, s, min, h, such as \"50 ms\""},
      {"50 msec", "\"50 msec\" has the unit \"msec\"; allowed: a time in ns, us"},
      {"50  ms", "has the unit \" ms\""},
      {"50 ms ", "has the unit \"ms \""},
      {" 50 ms", "is not a number with a unit"},
      {"", "\"\" is not a number with a unit"},
      {"ms", "is not a number with a unit"},
      {"nan ms", "is not a number with a unit"},
      {"inf ms", "is not a number with a unit"},
      {"-inf ms", "is not a number with a unit"},
      {"+-5 ms", "is not a number with a unit"},
      {"1e999 ms", "is beyond the largest or smallest number"},
      {"1e308 h", "is beyond the largest number"},
      {"0x10 ms", "has the unit \"x10 ms\""},
  }};
  for (const auto& [text, fragment] : table) {
    CAPTURE(text);
    CHECK_THROWS_WITH(parse_quantity(text, kTime), Catch::Contains(fragment));
  }
}

TEST_CASE("A text of any length is refused in short") {
  const std::string endless(1'000'000, '5');

  CHECK_THROWS_WITH(
      parse_quantity(endless, kTime),
      Catch::Contains("is longer than any quantity") &&
          Catch::Predicate<std::string>([](const std::string& text) { return text.size() < 200; }));
}

TEST_CASE("Quantities are written as a person would") {
  CHECK(format_quantity(50e6, kTime) == "50 ms");
  CHECK(format_quantity(60e9, kTime) == "60 s");
  CHECK(format_quantity(20e3, kTime) == "20 us");
  CHECK(format_quantity(2.437e9, kFrequency) == "2.437 GHz");
  CHECK(format_quantity(200, kFrequency) == "200 Hz");
  CHECK(format_quantity(6000, kBitRate) == "6 Mb/s");
  CHECK(format_quantity(5500, kBitRate) == "5.5 Mb/s");
  CHECK(format_quantity(20, kLength) == "20 m");
  CHECK(format_quantity(0.2, kLength) == "20 cm");
  CHECK(format_quantity(0.5e9, kTime) == "500 ms");
  CHECK(format_quantity(5400e9, kTime) == "1.5 h");
  CHECK(format_quantity(0, kAngle) == "0 deg");
  CHECK(format_quantity(0.0002, kLength) == "0.2 mm");
  CHECK(format_quantity(1.2, kMass) == "1.2 kg");
  CHECK(format_quantity(std::numbers::pi / 2, kAngle) == "90 deg");
  CHECK(format_quantity(0.05 * std::numbers::pi / 180, kAngle) == "0.05 deg");
  CHECK(format_quantity(-82, kPower) == "-82 dBm");
  CHECK(format_quantity(0, kLength) == "0 m");
}

TEST_CASE("Any number reads back as itself from what was written") {
  const random::CounterStream stream{1, 1};
  std::uint64_t draw = 0;
  for (const Dimension* dimension : kAll) {
    for (int i = 0; i < 2000; ++i) {
      const double exponent = 24.0 * stream.uniform(draw++) - 12.0;
      const double sign = stream.uniform(draw++) < 0.5 ? -1.0 : 1.0;
      double value = sign * std::pow(10.0, exponent);
      if (i % 2 == 0) {  // as people give them: few digits
        value = std::round(value * 1000.0) / 1000.0;
      }

      const std::string text = format_quantity(value, *dimension);

      CAPTURE(dimension->name, value, text);
      REQUIRE(parse_quantity(text, *dimension) == value);
    }
  }
}

}  // namespace
}  // namespace cuscus::scenario
