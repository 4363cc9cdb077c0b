// What a camera's picture of a city costs: bench_camera CITY.osm ALTITUDE_m [WIDTH HEIGHT
// [PICTURE.ppm]] Flies a circle of 100 m around the origin, looking ahead, then down. The picture
// is the last one ahead. As cuscus-camera draws: LP_NUM_THREADS=0 MESA_SHADER_CACHE_DISABLE=true.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "camera/gl/renderer.h"
#include "camera/gl/surfaceless_context.h"
#include "common/city/import/import_city.h"
#include "common/posix/resource_usage.h"

namespace {

using namespace cuscus::camera;
using Clock = std::chrono::steady_clock;

/// Of all threads of this process.
double cpu_ms() { return cuscus::posix::process_cpu_s() * 1e3; }

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void measure(const char* name, Renderer& renderer, const Pinhole& camera, const CameraMount& mount,
             double altitude_m, std::vector<std::byte>& rgb) {
  constexpr int kPictures = 400;
  constexpr double kRadius_m = 100.0;
  std::vector<double> took_ms;
  std::vector<double> used_ms;
  for (int k = 0; k < kPictures; ++k) {
    const double angle_rad = 2.0 * std::numbers::pi * k / kPictures;
    const Eigen::Quaterniond q_WB{
        Eigen::AngleAxisd{angle_rad + std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ()}};
    const double before_ms = cpu_ms();
    const auto begin = Clock::now();
    renderer.draw(camera,
                  CameraPose::of({kRadius_m * std::cos(angle_rad), kRadius_m * std::sin(angle_rad),
                                  altitude_m},
                                 q_WB, mount),
                  {}, rgb);
    took_ms.push_back(ms_since(begin));
    used_ms.push_back(cpu_ms() - before_ms);
  }
  std::ranges::sort(took_ms);
  std::ranges::sort(used_ms);
  std::printf("%s: p50 %.2f ms, p99 %.2f ms; processor p50 %.2f ms, p99 %.2f ms\n", name,
              took_ms[kPictures / 2], took_ms[kPictures * 99 / 100], used_ms[kPictures / 2],
              used_ms[kPictures * 99 / 100]);
}

void run(int count, char** words) {
  Pinhole camera;
  const double altitude_m = std::stod(words[2]);
  if (count > 4) {
    camera.width_px = static_cast<std::uint32_t>(std::stoul(words[3]));
    camera.height_px = static_cast<std::uint32_t>(std::stoul(words[4]));
  }
  const std::array files{std::filesystem::path{words[1]}};
  const auto city = cuscus::city::import_city(files, {}).city;
  auto begin = Clock::now();
  const Scene scene = scene_of(city);
  std::printf("%zu buildings, %zu triangles in %zu tiles, made in %.0f ms\n", city.buildings.size(),
              scene.vertices.size() / 3, scene.tiles.size(), ms_since(begin));
  begin = Clock::now();
  const SurfacelessContext context;
  Renderer renderer{scene};
  std::printf("%s, ready in %.0f ms\n", context.renderer().c_str(), ms_since(begin));
  std::vector<std::byte> rgb(std::size_t{3} * camera.width_px * camera.height_px);
  measure("down", renderer, camera, {.pitch_rad = std::numbers::pi / 2.0}, altitude_m, rgb);
  measure("ahead", renderer, camera, {}, altitude_m, rgb);
  if (count > 5) {
    std::ofstream file{words[5], std::ios::binary};
    file << "P6 " << camera.width_px << ' ' << camera.height_px << " 255\n";
    file.write(reinterpret_cast<const char*>(rgb.data()), static_cast<std::streamsize>(rgb.size()));
  }
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::fputs("usage: bench_camera CITY.osm ALTITUDE_m [WIDTH HEIGHT [PICTURE.ppm]]\n", stderr);
    return 2;
  }
  try {
    run(count, words);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_camera: %s\n", error.what());
    return 1;
  }
}
