#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "common/city/names.h"
#include "common/scenario/scenario.h"

// How enumerators are written in a scenario.
namespace cuscus::scenario {

template <typename Enum>
using Named = std::pair<std::string_view, Enum>;

inline constexpr std::array kRadioStandardNames{
    Named<RadioStandard>{"802.11a", RadioStandard::k80211a},
    Named<RadioStandard>{"802.11b", RadioStandard::k80211b},
    Named<RadioStandard>{"802.11g", RadioStandard::k80211g},
    Named<RadioStandard>{"802.11p", RadioStandard::k80211p}};
inline constexpr std::array kControlAnswerNames{
    Named<ControlAnswer>{"same-class", ControlAnswer::kSameClass},
    Named<ControlAnswer>{"any-class", ControlAnswer::kAnyClass}};
inline constexpr std::array kRateControlNames{
    Named<RateControl>{"constant", RateControl::kConstant},
    Named<RateControl>{"ideal", RateControl::kIdeal},
    Named<RateControl>{"aarf", RateControl::kAarf},
    Named<RateControl>{"minstrel", RateControl::kMinstrel}};
inline constexpr std::array kDsssPreambleNames{Named<DsssPreamble>{"long", DsssPreamble::kLong},
                                               Named<DsssPreamble>{"short", DsssPreamble::kShort}};
inline constexpr std::array kGroundNames{Named<Ground>{"very-dry", Ground::kVeryDry},
                                         Named<Ground>{"medium-dry", Ground::kMediumDry},
                                         Named<Ground>{"wet", Ground::kWet}};
inline constexpr std::array kPolarisationNames{
    Named<Polarisation>{"vertical", Polarisation::kVertical},
    Named<Polarisation>{"horizontal", Polarisation::kHorizontal}};
inline constexpr std::array kCanyonBoundNames{Named<CanyonBound>{"lower", CanyonBound::kLower},
                                              Named<CanyonBound>{"middle", CanyonBound::kMiddle},
                                              Named<CanyonBound>{"upper", CanyonBound::kUpper}};
inline constexpr std::array kBuiltUpAreaNames{
    Named<BuiltUpArea>{"suburban", BuiltUpArea::kSuburban},
    Named<BuiltUpArea>{"urban", BuiltUpArea::kUrban},
    Named<BuiltUpArea>{"dense-urban", BuiltUpArea::kDenseUrban},
    Named<BuiltUpArea>{"high-rise", BuiltUpArea::kHighRise}};
inline constexpr std::array kAerialAreaNames{Named<AerialArea>{"RMa-AV", AerialArea::kRuralMacro},
                                             Named<AerialArea>{"UMa-AV", AerialArea::kUrbanMacro},
                                             Named<AerialArea>{"UMi-AV", AerialArea::kUrbanMicro}};
/// Losses of outer walls by material: sections 3.1.2 and 4 of the CUSCUS paper.
inline constexpr std::array kWallNames{Named<double>{"stone", 12.0},
                                       Named<double>{"concrete", 15.0}};
using city::kMaterialNames;
inline constexpr std::array kCityStyleNames{Named<CityStyle>{"old-town", CityStyle::kOldTown},
                                            Named<CityStyle>{"grid", CityStyle::kGrid}};
inline constexpr std::array kWallModelNames{Named<WallModel>{"paper", WallModel::kPaper},
                                            Named<WallModel>{"p2040", WallModel::kP2040}};
inline constexpr std::array kErrorModelNames{Named<ErrorModel>{"nist", ErrorModel::kNist},
                                             Named<ErrorModel>{"yans", ErrorModel::kYans},
                                             Named<ErrorModel>{"table", ErrorModel::kTable}};
inline constexpr std::array kAttachNames{Named<Attach>{"bridge", Attach::kBridge},
                                         Named<Attach>{"direct", Attach::kDirect}};
inline constexpr std::array kAddressResolutionNames{
    Named<AddressResolution>{"static", AddressResolution::kStatic},
    Named<AddressResolution>{"arp", AddressResolution::kArp}};
inline constexpr std::array kNeighbourSourceNames{
    Named<NeighbourSource>{"beacons", NeighbourSource::kBeacons},
    Named<NeighbourSource>{"motion-capture", NeighbourSource::kMotionCapture}};
inline constexpr std::array kCollisionBehaviourNames{
    Named<CollisionBehaviour>{"stop", CollisionBehaviour::kStop},
    Named<CollisionBehaviour>{"bounce", CollisionBehaviour::kBounce},
    Named<CollisionBehaviour>{"crash", CollisionBehaviour::kCrash}};
inline constexpr std::array kSensorDirectionNames{
    Named<SensorDirection>{"down", SensorDirection::kDown},
    Named<SensorDirection>{"up", SensorDirection::kUp},
    Named<SensorDirection>{"forward", SensorDirection::kForward},
    Named<SensorDirection>{"backward", SensorDirection::kBackward},
    Named<SensorDirection>{"left", SensorDirection::kLeft},
    Named<SensorDirection>{"right", SensorDirection::kRight}};
inline constexpr std::array kOnExitNames{Named<OnExit>{"fail", OnExit::kFail},
                                         Named<OnExit>{"mark", OnExit::kMark},
                                         Named<OnExit>{"ignore", OnExit::kIgnore}};
inline constexpr std::array kOnLateNames{Named<OnLate>{"warn", OnLate::kWarn},
                                         Named<OnLate>{"fail", OnLate::kFail},
                                         Named<OnLate>{"stop", OnLate::kStop}};
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
