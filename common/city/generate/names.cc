#include "common/city/generate/names.h"

#include <fmt/core.h>

#include <array>
#include <string_view>
#include <utility>

#include "common/city/generate/dice.h"

namespace cuscus::city::generate {
namespace {

constexpr std::array<std::string_view, 36> kFirst{
    "Abbey",  "Anchor", "Baker",  "Barrel", "Bell",   "Bridge", "Candle",   "Chandler", "Cooper",
    "Crown",  "Dyer",   "Fisher", "Fuller", "Garden", "Glover", "Harp",     "Herb",     "Hunter",
    "Ladder", "Linden", "Mason",  "Mill",   "Mint",   "Oven",   "Pepper",   "Potter",   "Quill",
    "Rope",   "Saddle", "Salt",   "Smith",  "Spring", "Tanner", "Thatcher", "Weaver",   "Well"};
constexpr std::array<std::string_view, 8> kSecond{"Street", "Lane",  "Alley", "Row",
                                                  "Steps",  "Court", "Hill",  "Gate"};

}  // namespace

std::vector<std::string> old_street_names(std::size_t count, std::uint64_t seed) {
  std::vector<std::string> names;
  for (std::size_t round = 0; names.size() < count; ++round) {
    std::vector<std::string> all;
    for (const std::string_view first : kFirst) {
      for (const std::string_view second : kSecond) {
        // A city with more streets than names has an "Upper" and a "2nd Upper" one.
        const std::string upper = round == 0   ? ""
                                  : round == 1 ? "Upper "
                                               : ordinal(round) + " Upper ";
        all.push_back(fmt::format("{}{} {}", upper, first, second));
      }
    }
    Dice dice{seed, Purpose::kNames, round};
    for (std::size_t left = all.size(); left > 0 && names.size() < count; --left) {
      const std::size_t drawn = dice.below(static_cast<std::uint32_t>(left));
      names.push_back(std::move(all[drawn]));
      all[drawn] = std::move(all[left - 1]);
    }
  }
  return names;
}

std::string ordinal(std::size_t number) {
  const bool teen = number % 100 / 10 == 1;
  const std::array<std::string_view, 4> endings{"th", "st", "nd", "rd"};
  return fmt::format("{}{}", number, endings[teen || number % 10 > 3 ? 0 : number % 10]);
}

}  // namespace cuscus::city::generate
