#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cuscus::scenario {

/// What placeholders in a UAV's command stand for.
struct PlaceholderValues {
  std::string index;         ///< {index}: within the group, from 0.
  std::string count;         ///< {count}: UAVs in the group.
  std::string name;          ///< {name}
  std::string group;         ///< {group}
  std::string ip;            ///< {ip}
  std::string gcs_ip;        ///< {gcs_ip}; empty without ground station, and then an error to use.
  std::string broadcast;     ///< {broadcast}: the subnet's broadcast address.
  std::string scenario_dir;  ///< {scenario_dir}: folder of the scenario file.
  /// {ip:NAME}: the address of a node by its name, nothing when there is none.
  std::function<std::optional<std::string>(const std::string&)> ip_of;
};

/// A placeholder that stands for nothing; what() says what is allowed.
struct PlaceholderError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// `text` with its placeholders filled in; "{{" and "}}" are braces.
[[nodiscard]] std::string expand(std::string_view text, const PlaceholderValues& values);

}  // namespace cuscus::scenario
