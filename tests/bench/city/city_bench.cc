// Seconds to import a city: city-bench FILE [repetitions]. Run by hand in a release build.
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "common/city/import/build_city.h"
#include "common/city/import/read_osm.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::fprintf(stderr, "usage: city-bench FILE [repetitions]\n");
    return 2;
  }
  const int repetitions = argc > 2 ? std::stoi(argv[2]) : 5;
  std::printf("read_s,build_s,buildings,prisms\n");
  for (int i = 0; i < repetitions; ++i) {
    cuscus::city::ImportReport report;
    report.files.resize(1);
    const auto start = Clock::now();
    auto records = cuscus::city::read_osm(std::filesystem::path{argv[1]}, {}, report.files[0]);
    const double read_s = seconds_since(start);
    const auto read = Clock::now();
    const auto city = cuscus::city::build_city(std::move(records), {}, report);
    std::printf("%.3f,%.3f,%zu,%zu\n", read_s, seconds_since(read), city.buildings.size(),
                report.figures.prisms);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "city-bench: %s\n", error.what());
  return 1;
}
