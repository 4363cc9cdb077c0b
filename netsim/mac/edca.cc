#include "netsim/mac/edca.h"

#include <array>
#include <cassert>

namespace cuscus::netsim {

AccessCategory access_category(std::uint8_t priority) {
  using enum AccessCategory;
  constexpr std::array<AccessCategory, kPriorities> kCategories{
      kBestEffort, kBackground, kBackground, kBestEffort, kVideo, kVideo, kVoice, kVoice};
  assert(priority < kPriorities);
  return kCategories.at(priority);
}

EdcaParameters default_edca(const Standard& standard) {
  const std::uint32_t low = standard.cw_min;
  const std::uint32_t half = (low + 1) / 2 - 1;
  const std::uint32_t quarter = (low + 1) / 4 - 1;
  const bool outside_bss = standard.name == "802.11p";
  return {{{.aifsn = outside_bss ? 9U : 7U, .cw_min = low, .cw_max = standard.cw_max},
           {.aifsn = outside_bss ? 6U : 3U, .cw_min = low, .cw_max = standard.cw_max},
           {.aifsn = outside_bss ? 3U : 2U, .cw_min = half, .cw_max = low},
           {.aifsn = 2, .cw_min = quarter, .cw_max = half}}};
}

AccessProfile edca_access(const MacParameters& parameters) {
  AccessProfile profile;
  for (const EdcaCategory& category : parameters.edca) {
    profile.categories.push_back({.aifs = parameters.sifs + category.aifsn * parameters.slot,
                                  .cw_min = category.cw_min,
                                  .cw_max = category.cw_max});
  }
  for (std::uint8_t priority = 0; priority < kPriorities; ++priority) {
    profile.category_of.at(priority) = static_cast<std::uint8_t>(access_category(priority));
  }
  profile.more_header_bytes = kQosControlBytes;
  return profile;
}

}  // namespace cuscus::netsim
