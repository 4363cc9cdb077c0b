#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace cuscus::scenario {

/// Size that a scenario may have [B].
inline constexpr std::size_t kMaxDocumentBytes = std::size_t{10} << 20U;
/// Arrays and objects within one another that it may have.
inline constexpr int kMaxDocumentDepth = 64;

/// `text` as JSON: strict (RFC 8259, no comments), every key once, within the limits above.
/// @throws ScenarioError naming `source` and the line or the path.
[[nodiscard]] nlohmann::json parse_document(std::string_view text, const std::string& source);

/// `token` as a part of a JSON pointer (RFC 6901): ~ and / escaped. Control characters, which could
/// play tricks on a terminal, become '?'.
[[nodiscard]] std::string pointer_token(const std::string& token);

}  // namespace cuscus::scenario
