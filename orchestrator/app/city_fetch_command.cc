#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <stdexcept>

#include "common/city/export/map_labels.h"
#include "common/scenario/units.h"
#include "orchestrator/app/city_commands.h"
#include "orchestrator/app/degrees.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/print.h"
#include "orchestrator/app/whole_file.h"
#include "orchestrator/fetch/overpass_client.h"

namespace cuscus::orchestrator {
namespace {

// As OpenStreetMap's own API has it: a large city. Countries are downloaded elsewhere.
constexpr double kLargestArea_deg2 = 0.25;

DegreeBox fetched_area(const std::string& text) {
  const DegreeBox box = parse_degree_box("--bbox", text);
  const double area_deg2 = (box.east - box.west) * (box.north - box.south);
  if (area_deg2 > kLargestArea_deg2) {
    throw UsageError{fmt::format("--bbox {}: {:.2f} square degrees; allowed: up to {}", text,
                                 area_deg2, kLargestArea_deg2)};
  }
  return box;
}

QueryLimits query_limits(const CityFetchArguments& arguments) {
  QueryLimits limits;
  double time_ns = 0.0;
  try {
    time_ns = scenario::parse_quantity(arguments.timeout, scenario::kTime);
  } catch (const scenario::UnitError& error) {
    throw UsageError{fmt::format("--timeout {}: {}", arguments.timeout, error.what())};
  }
  constexpr double kShortest_ns = 1e9;
  constexpr double kLongest_ns = 3600e9;
  if (!(time_ns >= kShortest_ns && time_ns <= kLongest_ns)) {
    throw UsageError{fmt::format("--timeout {}: allowed: 1 s ... 1 h", arguments.timeout)};
  }
  limits.time = std::chrono::seconds{static_cast<std::int64_t>(time_ns / 1e9)};
  constexpr std::uint64_t kLargest_mb = 100'000;
  if (arguments.largest_mb < 1 || arguments.largest_mb > kLargest_mb) {
    throw UsageError{
        fmt::format("--max-mb {}: allowed: 1 ... {}", arguments.largest_mb, kLargest_mb)};
  }
  limits.bytes = arguments.largest_mb * 1'000'000;
  return limits;
}

OverpassServer overpass_server(const std::string& url) {
  try {
    return parse_server(url);
  } catch (const std::invalid_argument& error) {
    throw UsageError{fmt::format("--server {}", error.what())};
  }
}

}  // namespace

int city_fetch_command(const CityFetchArguments& arguments) {
  const DegreeBox area = fetched_area(arguments.bounds);
  const OverpassServer server = overpass_server(arguments.server);
  const QueryLimits limits = query_limits(arguments);
  WholeFile file{arguments.out};
  std::uint64_t bytes = 0;
  fetch_map(server, overpass_query(area, limits), limits, [&](std::string_view piece) {
    file.append(piece);
    bytes += piece.size();
  });
  file.publish();
  print(stdout, "{}: {} bytes from {}\n{}\n", arguments.out.native(), bytes, server.host,
        city::kOsmAttribution);
  return kExitDone;
}

}  // namespace cuscus::orchestrator
