#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <utility>

namespace cuscus::orchestrator {

/// fmt::print() for a terminal or pipe whose other end may be gone: what cannot be shown is lost,
/// and the work goes on. Needs SIGPIPE ignored.
template <typename... Arguments>
void print(std::FILE* stream, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  const auto text = fmt::format(format, std::forward<Arguments>(arguments)...);
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stream));
}

}  // namespace cuscus::orchestrator
