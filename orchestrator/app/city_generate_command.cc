#include <fmt/format.h>

#include <stdexcept>

#include "common/city/generate/generate.h"
#include "common/scenario/units.h"
#include "orchestrator/app/city_commands.h"
#include "orchestrator/app/degrees.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/print.h"
#include "orchestrator/app/whole_file.h"

namespace cuscus::orchestrator {
namespace {

city::generate::Request generation_request(const CityGenerateArguments& arguments) {
  const auto style = city::generate::style_of(arguments.style);
  if (!style) {
    throw UsageError{
        fmt::format("city generate {}: allowed: {}", arguments.style, city::generate::kStyleNames)};
  }
  city::generate::Request request{.style = *style, .seed = arguments.seed};
  try {
    request.size_m = scenario::parse_quantity(arguments.size, scenario::kLength);
  } catch (const scenario::UnitError& error) {
    throw UsageError{fmt::format("--size {}: {}", arguments.size, error.what())};
  }
  if (arguments.origin) {
    const auto [latitude_deg, longitude_deg] = parse_degree_pair("--origin", *arguments.origin);
    request.origin = city::Geodetic{.latitude_deg = latitude_deg, .longitude_deg = longitude_deg};
  }
  return request;
}

}  // namespace

int city_generate_command(const CityGenerateArguments& arguments) {
  const auto request = generation_request(arguments);
  WholeFile file{arguments.out};
  try {
    file.append(city::generate::make_osm(request));
  } catch (const std::invalid_argument& error) {
    throw UsageError{fmt::format("--size {}: {}", arguments.size, error.what())};
  }
  file.publish();
  const auto origin = request.origin.value_or(city::generate::default_origin(request.style));
  print(stdout, "{}: {} of {:g} m x {:g} m about {}, {}, seed {}\n", arguments.out.native(),
        arguments.style, request.size_m, request.size_m, origin.latitude_deg, origin.longitude_deg,
        request.seed);
  return kExitDone;
}

}  // namespace cuscus::orchestrator
