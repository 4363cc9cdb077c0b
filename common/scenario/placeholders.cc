#include "common/scenario/placeholders.h"

#include <array>
#include <utility>
#include <vector>

#include "common/scenario/scenario_error.h"

namespace cuscus::scenario {
namespace {

constexpr std::array kSimple{
    std::pair{"index", &PlaceholderValues::index},
    std::pair{"count", &PlaceholderValues::count},
    std::pair{"name", &PlaceholderValues::name},
    std::pair{"group", &PlaceholderValues::group},
    std::pair{"ip", &PlaceholderValues::ip},
    std::pair{"gcs_ip", &PlaceholderValues::gcs_ip},
    std::pair{"broadcast", &PlaceholderValues::broadcast},
    std::pair{"scenario_dir", &PlaceholderValues::scenario_dir},
};

std::string value_of(const std::string& placeholder, const PlaceholderValues& values) {
  std::vector<std::string> allowed;
  for (const auto& [name, member] : kSimple) {
    if (placeholder == name) {
      if ((values.*member).empty()) {
        throw PlaceholderError{"{" + placeholder + "} stands for nothing in this scenario" +
                               (placeholder == "gcs_ip" ? ", which has no ground station" : "")};
      }
      return values.*member;
    }
    allowed.push_back(std::string{"{"} + name + "}");
  }
  constexpr std::string_view kAddressOf = "ip:";
  if (placeholder.starts_with(kAddressOf)) {
    const std::string node = placeholder.substr(kAddressOf.size());
    if (const auto address = values.ip_of(node)) {
      return *address;
    }
    throw PlaceholderError{"{" + placeholder + "} names no node; there is no \"" + node + "\""};
  }
  allowed.emplace_back("{ip:NAME}");
  const std::string near = nearest("{" + placeholder + "}", allowed);
  throw PlaceholderError{"{" + placeholder + "} is not a known placeholder; " +
                         (near.empty() ? "" : "did you mean " + near + "? ") +
                         "allowed: " + joined(allowed) + ", and {{ for a brace"};
}

}  // namespace

std::string expand(std::string_view text, const PlaceholderValues& values) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c == '{' || c == '}') && i + 1 < text.size() && text[i + 1] == c) {
      result += c;
      ++i;
    } else if (c == '{') {
      const std::size_t end = text.find('}', i);
      if (end == std::string_view::npos) {
        throw PlaceholderError{"has a { without a } after it; write {{ for a brace"};
      }
      result += value_of(std::string{text.substr(i + 1, end - i - 1)}, values);
      i = end;
    } else if (c == '}') {
      throw PlaceholderError{"has a } without a { before it; write }} for a brace"};
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace cuscus::scenario
