#include "common/city/import/tag_values.h"

#include <catch2/catch.hpp>
#include <string>

namespace cuscus::city {
namespace {

TEST_CASE("heights are read in the forms that mappers write") {
  const auto [text, height_m] = GENERATE(table<std::string, double>({
      {"12", 12.0},
      {"12 m", 12.0},
      {"12.5m", 12.5},
      {"12,5", 12.5},
      {"12,5 m", 12.5},
      {" 12 metres ", 12.0},
      {"12 meters", 12.0},
      {"0.5", 0.5},
      {"443.2", 443.2},
      {"1e2", 100.0},
      {"1000", 1000.0},
      // A foot is 0.3048 m, an inch 0.0254 m.
      {"40 ft", 12.192},
      {"40ft", 12.192},
      {"40 feet", 12.192},
      {"1 foot", 0.3048},
      {"12'", 3.6576},
      {"12'6\"", 3.81},
      {"12' 6\"", 3.81},
      {"12'6''", 3.81},
      {"12'6.5\"", 3.8227},
  }));

  const TagNumber height = parse_height_m(text);

  CAPTURE(text);
  CHECK(height.valid());
  CHECK(height.value == Approx(height_m).epsilon(1e-12));
}

TEST_CASE("what is no height is named as such, never guessed") {
  const auto [text, fault] = GENERATE(table<std::string, TagFault>({
      {"", TagFault::kNotANumber},          {" ", TagFault::kNotANumber},
      {"3 storeys", TagFault::kNotANumber}, {"tall", TagFault::kNotANumber},
      {"nan", TagFault::kNotANumber},       {"inf", TagFault::kNotANumber},
      {"-", TagFault::kNotANumber},         {".", TagFault::kNotANumber},
      {"10-12", TagFault::kNotANumber},     {"10;12", TagFault::kNotANumber},
      {"~12", TagFault::kNotANumber},       {"+12", TagFault::kNotANumber},
      {"1,234.5", TagFault::kNotANumber},   {"12.5.3", TagFault::kNotANumber},
      {"12 km", TagFault::kNotANumber},     {"12 m 5", TagFault::kNotANumber},
      {"12'6", TagFault::kNotANumber},      {"12'13\"", TagFault::kNotANumber},
      {"12'-1\"", TagFault::kNotANumber},   {"0x10", TagFault::kNotANumber},
      {"1 2", TagFault::kNotANumber},       {"0", TagFault::kTooSmall},
      {"0 m", TagFault::kTooSmall},         {"-5", TagFault::kTooSmall},
      {"-5'", TagFault::kTooSmall},         {"-1e999", TagFault::kTooSmall},
      {"1e9", TagFault::kTooLarge},         {"1000.1", TagFault::kTooLarge},
      {"1e999", TagFault::kTooLarge},       {"3300 ft", TagFault::kTooLarge},
  }));

  CAPTURE(text);
  CHECK(parse_height_m(text).fault == fault);
}

TEST_CASE("each kind of number has limits of its own") {
  CHECK(parse_min_height_m("0").valid());
  CHECK(parse_min_height_m("-1").fault == TagFault::kTooSmall);
  CHECK(parse_levels("4").value == 4.0);
  CHECK(parse_levels("2.5").value == 2.5);
  CHECK(parse_levels("2,5").value == 2.5);
  CHECK(parse_levels("0").fault == TagFault::kTooSmall);
  CHECK(parse_levels("201").fault == TagFault::kTooLarge);
  CHECK(parse_levels("3 m").fault == TagFault::kNotANumber);
  CHECK(parse_levels("2-3").fault == TagFault::kNotANumber);
  CHECK(parse_levels_from_zero("0").valid());
  CHECK(parse_tree_height_m("18 m").value == 18.0);
  CHECK(parse_tree_height_m("150").fault == TagFault::kTooLarge);
  CHECK(parse_crown_m("7").value == 7.0);
  CHECK(parse_street_width_m("3.5").value == 3.5);
  CHECK(parse_street_width_m("narrow").fault == TagFault::kNotANumber);
  CHECK(parse_lanes("2").value == 2.0);
  CHECK(parse_lanes("58").fault == TagFault::kTooLarge);
}

TEST_CASE("materials are those whose walls we know") {
  CHECK(parse_material("sandstone") == Material::kStone);
  CHECK(parse_material("reinforced_concrete") == Material::kConcrete);
  CHECK(parse_material("brick") == Material::kBrick);
  CHECK(parse_material("mirror") == Material::kGlass);
  CHECK(parse_material("steel") == Material::kMetal);
  CHECK(parse_material("timber_framing") == Material::kWood);
  CHECK_FALSE(parse_material("cheese"));
  CHECK_FALSE(parse_material(""));
  CHECK_FALSE(parse_material("Brick"));
}

}  // namespace
}  // namespace cuscus::city
