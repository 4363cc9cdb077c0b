#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace cuscus::scenario {

/// The instant that "2026-01-01T12:00:00Z" names, of the years 1980 (GPS time begins) to 2099;
/// nothing of any other text.
[[nodiscard]] std::optional<std::chrono::sys_seconds> parse_utc(std::string_view text);

/// The same text again.
[[nodiscard]] std::string format_utc(std::chrono::sys_seconds instant);

}  // namespace cuscus::scenario
