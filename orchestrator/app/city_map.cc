#include <fmt/format.h>

#include "common/city/export/map_format.h"
#include "orchestrator/app/city_commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/whole_file.h"

namespace cuscus::orchestrator {
namespace {

city::MapFormat format_of(const std::filesystem::path& out) {
  const auto format = city::map_format_of(out.filename().native());
  if (!format) {
    throw UsageError{fmt::format("--out {}: what kind of map is that? Allowed: {}", out.native(),
                                 city::kMapFormats)};
  }
  return *format;
}

}  // namespace

void check_map_file(const std::filesystem::path& out) {
  static_cast<void>(format_of(out));
  static_cast<void>(WholeFile{out});
}

void write_map(const city::City& city, const city::MapLabels& labels,
               const std::filesystem::path& out) {
  write_whole_file(out, city::map_bytes(city, labels, format_of(out)));
}

}  // namespace cuscus::orchestrator
