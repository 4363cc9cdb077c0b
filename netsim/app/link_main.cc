// cuscus-link: the error rates of OFDM in white noise, by simulating the link bit by bit. Prints
// the rows of netsim/phy/link_error_table.inc.
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "netsim/link/link_curve.h"

namespace {

using namespace cuscus;          // NOLINT(google-build-using-namespace): a main
using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main

const char* name_of(Modulation modulation) {
  switch (modulation) {
    case Modulation::kBpsk:
      return "kBpsk";
    case Modulation::kQpsk:
      return "kQpsk";
    case Modulation::k16Qam:
      return "k16Qam";
    default:
      return "k64Qam";
  }
}

const char* name_of(CodeRate code_rate) {
  switch (code_rate) {
    case CodeRate::kHalf:
      return "kHalf";
    case CodeRate::kTwoThirds:
      return "kTwoThirds";
    default:
      return "kThreeQuarters";
  }
}

void print_row(const Mode& mode, const LinkSampling& sampling) {
  const auto curve = link_curve(mode.modulation, mode.code_rate, sampling);
  if (curve.empty()) {
    throw std::runtime_error{"too few frames for a single point of " +
                             std::to_string(mode.rate_kbps) + " kb/s"};
  }
  fmt::print("Curve{{Modulation::{}, CodeRate::{}, {},\n {{", name_of(mode.modulation),
             name_of(mode.code_rate), curve.front().snr_db);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    fmt::print("{}{:.4f}", i == 0 ? "" : ", ", std::log10(curve[i].bit_failure()));
    fmt::print(stderr, "{} kb/s, {} dB: {} of {} frames of {} bits lost\n", mode.rate_kbps,
               curve[i].snr_db, curve[i].failures, curve[i].frames, curve[i].frame_bits);
  }
  fmt::print("}}}},\n");
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  LinkSampling sampling;
  double rate_mbps = 0.0;
  CLI::App app{"Error rates of OFDM in white noise, by simulating the link bit by bit",
               "cuscus-link"};
  app.add_option("--rate", rate_mbps, "This rate of 802.11a alone [Mb/s]; 0: all");
  app.add_option("--failures", sampling.failures, "Lost frames after which a point is good enough")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--frames", sampling.frames, "Frames sent at most for a point")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  app.add_option("--seed", sampling.seed, "Of bits and noise")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const Standard& standard = standard_of("802.11a");
  if (rate_mbps != 0.0) {
    print_row(standard.mode(static_cast<std::uint32_t>(std::lround(rate_mbps * 1e3))), sampling);
    return 0;
  }
  for (const Mode& mode : standard.modes) {
    print_row(mode, sampling);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "cuscus-link: " << error.what() << '\n';
    return 2;
  }
}
