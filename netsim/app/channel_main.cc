// cuscus-channel: the terms of a channel, step by step along a straight walk. Needs no privileges;
// one CSV table on standard output.
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numbers>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/city/import/import_city.h"
#include "netsim/app/city_of_message.h"
#include "netsim/channel/walk.h"

namespace {

using namespace cuscus;          // NOLINT(google-build-using-namespace): a main
using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main

struct Options {
  ChannelParameters channel;
  Walk walk;
  std::string standing{"0,0,10"};
  std::string begin{"1,0,10"};
  std::string end{"1000,0,10"};
  double carrier_ghz{2.437};
  bool horizontal{false};
  std::vector<std::string> boxes;
  std::string city;
  std::string antenna{"isotropic"};
  std::uint32_t seeds{1};
};

/// The numbers of a list with commas.
/// @throws std::invalid_argument naming the option.
std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               std::size_t least, std::size_t most, const std::string& form) {
  std::vector<double> numbers;
  std::istringstream fields{text};
  for (std::string field; std::getline(fields, field, ',');) {
    std::size_t read = 0;
    try {
      numbers.push_back(std::stod(field, &read));
    } catch (const std::exception&) {
      read = 0;
    }
    if (read == 0 || read != field.size()) {
      numbers.clear();
      break;
    }
  }
  if (numbers.size() < least || numbers.size() > most) {
    throw std::invalid_argument{option + ": '" + text + "' is not " + form};
  }
  return numbers;
}

Eigen::Vector3d place_of(const std::string& option, const std::string& text) {
  const auto m = numbers_of(option, text, 3, 3, "EAST,NORTH,UP [m]");
  return {m[0], m[1], m[2]};
}

BoxObstacle box_of(const std::string& text) {
  constexpr const char* kForm = "EAST,NORTH,LENGTH,WIDTH,HEIGHT,WALL_DB[,HEADING_DEG] [m]";
  const auto v = numbers_of("--box", text, 6, 7, kForm);
  const double heading_deg = v.size() > 6 ? v[6] : 0.0;
  return {.shape = {.centre_m = {v[0], v[1]},
                    .size_m = {v[2], v[3], v[4]},
                    .heading_rad = heading_deg * std::numbers::pi / 180.0},
          .outer_wall = {v[5]}};
}

void add_terms(CLI::App& app, Options& o) {
  ChannelParameters& c = o.channel;
  app.add_option("--model", c.model, "Basic loss")
      ->check(CLI::IsMember(Channel::model_names()))
      ->capture_default_str();
  app.add_option("--carrier", o.carrier_ghz, "[GHz]")->capture_default_str();
  app.add_option("--exponent", c.exponent, "Of log-distance")->capture_default_str();
  app.add_option("--reference-loss", c.reference_loss.value,
                 "Of log-distance, at 1 m (0: free space), and of fixed [dB]")
      ->capture_default_str();
  app.add_option("--alpha", c.alpha, "Of paper-eq1")->capture_default_str();
  app.add_option("--chi", c.chi_db2, "Of paper-eq1: variance [dB^2]")->capture_default_str();
  app.add_option("--ground", c.ground, "Of two-ray")
      ->check(CLI::IsMember(TwoRay::ground_names()))
      ->capture_default_str();
  app.add_flag("--horizontal", o.horizontal, "Polarisation of two-ray");
  app.add_option("--roughness", c.roughness_m, "Of two-ray's ground [m]")->capture_default_str();
  app.add_option("--bound", c.canyon_bound, "Of p1411")
      ->check(CLI::IsMember({"lower", "middle", "upper"}))
      ->capture_default_str();
  app.add_option("--environment", c.environment, "Of al-hourani")->capture_default_str();
  app.add_option("--area", c.area, "Of tr36777")->capture_default_str();
  app.add_option("--line-of-sight", c.line_of_sight, "Of al-hourani and tr36777")
      ->check(CLI::IsMember({"drawn", "mean"}))
      ->capture_default_str();
  app.add_option("--box", o.boxes,
                 "An obstacle: EAST,NORTH,LENGTH,WIDTH,HEIGHT,WALL_DB[,HEADING_DEG] [m]; may be "
                 "repeated");
  app.add_option("--city", o.city,
                 "Further obstacles: city.pb of a run directory, or a map of OpenStreetMap");
  app.add_option("--walls", c.walls, "Of the city")
      ->check(CLI::IsMember({"paper", "p2040"}))
      ->capture_default_str();
  app.add_option("--shadowing", c.shadowing_db, "Standard deviation [dB]")->capture_default_str();
  app.add_option("--decorrelation", c.shadowing_decorrelation_m, "Of shadowing [m]")
      ->capture_default_str();
  app.add_option("--fading", c.fading, "Of single frames")
      ->check(CLI::IsMember({"none", "rice", "nakagami"}))
      ->capture_default_str();
  app.add_option("--k-factor", c.k_factor.value, "Of rice, at the horizon [dB]; none: Rayleigh");
  app.add_option("--k-factor-overhead", c.k_factor_overhead.value,
                 "Of rice, at the zenith [dB]; none: as at the horizon");
  app.add_option("--residual-doppler", c.residual_doppler_hz, "Of rice [Hz]")
      ->capture_default_str();
  app.add_option("--nakagami-m", c.nakagami_m)->capture_default_str();
  app.add_option("--antenna", o.antenna, "At both ends")
      ->check(CLI::IsMember({"isotropic", "dipole"}))
      ->capture_default_str();
}

void add_walk(CLI::App& app, Options& o) {
  app.add_option("--standing", o.standing, "Where one end is: EAST,NORTH,UP [m]")
      ->capture_default_str();
  app.add_option("--from", o.begin, "Where the other end begins [m]")->capture_default_str();
  app.add_option("--to", o.end, "Where it ends [m]")->capture_default_str();
  app.add_option("--step", o.walk.step_m, "[m]")->capture_default_str();
  app.add_option("--speed", o.walk.speed_mps, "[m/s]")->capture_default_str();
  app.add_option("--seed", o.channel.seed)->capture_default_str();
  app.add_option("--seeds", o.seeds, "As many walks, with this seed and those that follow it")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
}

/// A run's city, or a map of OpenStreetMap with the import's defaults.
void put_city(Options& o) {
  const std::filesystem::path path{o.city};
  if (path.extension() != ".pb") {
    const city::ImportedCity imported = city::import_city(std::span{&path, 1}, {});
    o.channel.city = obstacles_of(imported.city, o.channel);
    return;
  }
  std::ifstream file{path, std::ios::binary};
  const std::string bytes{std::istreambuf_iterator<char>{file}, {}};
  if (!file) {
    throw std::invalid_argument{"--city: '" + o.city + "' cannot be read"};
  }
  try {
    netsim::put_city(std::as_bytes(std::span{bytes}), o.channel);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument{"--city: '" + o.city + "': " + error.what()};
  }
}

void apply(Options& o) {
  o.channel.carrier_hz = o.carrier_ghz * 1e9;
  o.channel.polarisation = o.horizontal ? Polarisation::kHorizontal : Polarisation::kVertical;
  if (std::isinf(o.channel.k_factor_overhead.value)) {
    o.channel.k_factor_overhead = o.channel.k_factor;
  }
  o.walk.p_WF = place_of("--standing", o.standing);
  o.walk.p_WB = place_of("--from", o.begin);
  o.walk.p_WE = place_of("--to", o.end);
  for (const std::string& box : o.boxes) {
    o.channel.obstacles.push_back(box_of(box));
  }
  if (!o.city.empty()) {
    put_city(o);
  }
}

void print(std::uint64_t seed, const WalkPoint& point) {
  const ObstacleTerms& obstacles = point.fixed.obstacles;
  fmt::print(
      "{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},"
      "{:.4f},{:.4f},{:.4f}\n",
      seed, point.way_m, point.p_WM.x(), point.p_WM.y(), point.p_WM.z(), point.distance_m,
      point.fixed.basic.value, obstacles.outer_walls.value, obstacles.inner_walls.value,
      obstacles.diffraction.value, obstacles.foliage.value, point.fixed.shadowing.value,
      point.frame.variation.value, point.frame.fading.value, point.antennas.value,
      point.loss().value);
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app{"The terms of a channel along a straight walk of one of its ends; prints CSV [dB].",
               "cuscus-channel"};
  add_terms(app, options);
  add_walk(app, options);
  CLI11_PARSE(app, argc, argv);
  apply(options);
  const auto antenna = make_antenna({.model = options.antenna});
  ChannelParameters parameters = options.channel;
  for (std::uint32_t i = 0; i < options.seeds; ++i) {
    parameters.seed = options.channel.seed + i;
    const Channel channel{parameters};
    if (i == 0) {
      fmt::print(
          "seed,way_m,x_m,y_m,z_m,distance_m,basic_db,outer_walls_db,inner_walls_db,"
          "diffraction_db,foliage_db,shadowing_db,variation_db,fading_db,antennas_db,loss_db\n");
    }
    along(options.walk, channel, antenna.get(),
          [&](const WalkPoint& point) { print(parameters.seed, point); });
  }
  if (std::fflush(stdout) != 0) {
    throw std::runtime_error{"the table could not be written"};
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "cuscus-channel: " << error.what() << '\n';
    return 2;
  }
}
