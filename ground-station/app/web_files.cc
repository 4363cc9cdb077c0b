#include "ground-station/app/web_files.h"

#include <algorithm>

namespace cuscus::gcs {
namespace {

std::string_view content_type(std::string_view path) {
  const std::string_view ending = path.substr(path.rfind('.') + 1);
  if (ending == "html") {
    return "text/html; charset=utf-8";
  }
  if (ending == "css") {
    return "text/css; charset=utf-8";
  }
  if (ending == "js") {
    return "text/javascript; charset=utf-8";
  }
  return ending == "svg" ? "image/svg+xml" : "application/octet-stream";
}

}  // namespace

std::optional<WebFile> find_web_file(std::string_view path) {
  const std::string_view name = path == "/" ? "/index.html" : path;
  const auto files = web_file_data();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const WebFileData& file) { return file.path == name; });
  if (found == files.end()) {
    return std::nullopt;
  }
  return WebFile{.content_type = content_type(name),
                 .text = {reinterpret_cast<const char*>(found->bytes.data()), found->bytes.size()}};
}

}  // namespace cuscus::gcs
