#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "common/scenario/scenario.h"

// How enumerators are written in a scenario.
namespace cuscus::scenario {

template <typename Enum>
using Named = std::pair<std::string_view, Enum>;

inline constexpr std::array kRadioStandardNames{
    Named<RadioStandard>{"802.11g", RadioStandard::k80211g}};
inline constexpr std::array kErrorModelNames{Named<ErrorModel>{"nist", ErrorModel::kNist}};
inline constexpr std::array kAttachNames{Named<Attach>{"bridge", Attach::kBridge},
                                         Named<Attach>{"direct", Attach::kDirect}};
inline constexpr std::array kAddressResolutionNames{
    Named<AddressResolution>{"static", AddressResolution::kStatic},
    Named<AddressResolution>{"arp", AddressResolution::kArp}};
inline constexpr std::array kNeighbourSourceNames{
    Named<NeighbourSource>{"beacons", NeighbourSource::kBeacons},
    Named<NeighbourSource>{"motion-capture", NeighbourSource::kMotionCapture}};
inline constexpr std::array kOnExitNames{Named<OnExit>{"fail", OnExit::kFail},
                                         Named<OnExit>{"mark", OnExit::kMark},
                                         Named<OnExit>{"ignore", OnExit::kIgnore}};
inline constexpr std::array kClockNames{Named<ClockSource>{"real", ClockSource::kReal}};

/// The name of `value` in `table`, which has one for every enumerator.
template <typename Enum, std::size_t n>
[[nodiscard]] std::string name_of(const std::array<Named<Enum>, n>& table, Enum value) {
  for (const auto& [name, enumerator] : table) {
    if (enumerator == value) {
      return std::string{name};
    }
  }
  return {};
}

}  // namespace cuscus::scenario
