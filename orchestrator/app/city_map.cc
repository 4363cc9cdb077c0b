#include <fmt/format.h>

#include <fstream>

#include "common/city/export/map_format.h"
#include "common/city/generate/osm_writer.h"
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

/// Whether a file's root element says that we made it up. Such files are not compressed.
bool is_made_up(const std::filesystem::path& file) {
  constexpr std::size_t kRootWithin = 300;
  std::string head(kRootWithin, '\0');
  std::ifstream{file}.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(fmt::format("generator=\"{}\"", city::generate::kOsmGenerator)) !=
         std::string::npos;
}

}  // namespace

city::MapLabels labels_of(const std::vector<std::filesystem::path>& files) {
  city::MapLabels labels;
  bool all_made_up = true;
  for (const std::filesystem::path& file : files) {
    labels.title += (labels.title.empty() ? "" : ", ") + file.filename().native();
    all_made_up = all_made_up && is_made_up(file);
  }
  if (!all_made_up) {
    labels.attribution = city::kOsmAttribution;
  }
  return labels;
}

void check_map_file(const std::filesystem::path& out) {
  static_cast<void>(format_of(out));
  static_cast<void>(WholeFile{out});
}

void write_map(const city::City& city, const city::MapLabels& labels,
               const std::filesystem::path& out) {
  write_whole_file(out, city::map_bytes(city, labels, format_of(out)));
}

}  // namespace cuscus::orchestrator
