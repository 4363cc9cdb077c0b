#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace cuscus::gcs {

/// A file of the page, inside the program.
struct WebFileData {
  std::string_view path;  ///< As in a URL: "/main.js".
  std::span<const unsigned char> bytes;
};

/// All of them; the build generates this from ground-station/web.
[[nodiscard]] std::span<const WebFileData> web_file_data();

/// A file and what to call it.
struct WebFile {
  std::string_view content_type;
  std::string_view text;
};

/// The file at `path`, "/" being the page itself. Only the exact names of embedded files exist:
/// there is no folder to escape from.
[[nodiscard]] std::optional<WebFile> find_web_file(std::string_view path);

}  // namespace cuscus::gcs
