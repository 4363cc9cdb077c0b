#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cuscus::city::generate {

/// `count` names of old streets and lanes, such as "Cooper Lane", each different.
[[nodiscard]] std::vector<std::string> old_street_names(std::size_t count, std::uint64_t seed);

/// "1st", "2nd", "3rd", "4th", ... "11th", "21st".
[[nodiscard]] std::string ordinal(std::size_t number);

}  // namespace cuscus::city::generate
