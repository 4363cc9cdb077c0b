#include "common/scenario/override.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/scenario/json_document.h"
#include "common/scenario/scenario_error.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

std::optional<std::size_t> index_of(std::string_view text) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return index;
}

/// The value for `text`: JSON when it is, checked like the file itself, else the text.
json value_of(const Override& override) {
  if (!json::accept(override.value)) {
    return override.value;
  }
  return parse_document(override.value, override.option);
}

/// The place that `token` names in `parent`, created when `parent` is an object or nothing yet.
json& step(json& parent, const std::string& token, const std::string& path,
           const Override& override) {
  if (parent.is_array()) {
    const auto index = index_of(token);
    if (!index || *index >= parent.size()) {
      throw ScenarioError{{{override.option, path,
                            "has no element \"" + token + "\"; allowed: " +
                                (parent.empty() ? "none, it is empty"
                                                : "0 ... " + std::to_string(parent.size() - 1))}}};
    }
    return parent[*index];
  }
  if (parent.is_null()) {
    parent = json::object();
  }
  if (!parent.is_object()) {
    throw ScenarioError{
        {{override.option, path,
          "is " + parent.dump() + " in the file, which has no \"" + token + "\" inside it"}}};
  }
  return parent[token];
}

}  // namespace

Override parse_override(std::string_view argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw ScenarioError{{{"--set " + std::string{argument}, "",
                          "is not PATH=VALUE, such as radio.data_rate=\"12 Mb/s\""}}};
  }
  return {.option = "--set " + std::string{argument},
          .path = std::string{argument.substr(0, equals)},
          .value = std::string{argument.substr(equals + 1)}};
}

std::string apply_override(const Override& override, json& document) {
  json* place = &document;
  std::string pointer;
  std::string_view rest = override.path;
  for (bool more = true; more;) {
    const std::size_t dot = rest.find('.');
    const std::string token{rest.substr(0, dot)};
    more = dot != std::string_view::npos;
    rest.remove_prefix(more ? dot + 1 : rest.size());
    if (token.empty()) {
      throw ScenarioError{{{override.option, "",
                            "has an empty part in its path; allowed: keys and array indices with "
                            "one dot between them, such as fleet.0.count"}}};
    }
    place = &step(*place, token, pointer, override);
    pointer += '/' + pointer_token(token);
  }
  *place = value_of(override);
  return pointer;
}

}  // namespace cuscus::scenario
