#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace cuscus::scenario {

/// A value that the command line puts in place of the file's.
struct Override {
  std::string option;  ///< As the user wrote it, for messages: "--set radio.data_rate=12 Mb/s".
  std::string path;    ///< Keys and array indices with dots: "radio.data_rate", "fleet.0.count".
  std::string value;   ///< JSON, or else the text itself: 5, true, "12 Mb/s", 12 Mb/s.
};

/// The override of one `--set` argument, "PATH=VALUE".
/// @throws ScenarioError when there is no '=' or no path before it.
[[nodiscard]] Override parse_override(std::string_view argument);

/// Puts `override`'s value into `document`, creating the objects on its way.
/// @return the JSON pointer of what was set.
/// @throws ScenarioError naming the option when its path leads nowhere.
std::string apply_override(const Override& override, nlohmann::json& document);

}  // namespace cuscus::scenario
