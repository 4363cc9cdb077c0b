// cuscus-air: the 802.11 simulator with synthetic or recorded traffic. Needs no privileges; one CSV
// table on standard output.
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <system_error>

#include "netsim/app/replay.h"
#include "netsim/app/synthetic.h"
#include "netsim/app/synthetic_table.h"

namespace {

using namespace cuscus;          // NOLINT(google-build-using-namespace): a main
using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main

struct Options {
  SyntheticParameters run;
  std::string traffic{"beacons"};
  std::string layout{"equal"};
  bool unicast{false};
  double rate_mbps{6.0};
  double group_rate_mbps{6.0};
  double duration_s{5.0};
  double period_ms{50.0};
  double jitter_ms{0.0};
  std::vector<double> basic_rates_mbps{6.0, 12.0, 24.0};
  bool short_preamble{false};
  double slot_us{0.0};
  std::vector<unsigned> priorities{0};
  double ideal_delay_ms{0.0};
  double ideal_jitter_ms{0.0};
  double tdma_slot_ms{2.5};
  double tdma_guard_us{10.0};
  double carrier_ghz{2.412};
  double detection_dbm{-82.0};
  double detection_sinr_db{4.0};
  bool no_detection{false};
  std::string replay_file;
  std::string positions_file;
  std::string receptions_file;
  std::string runs_file;
  std::string out_file;
};

std::uint32_t kbps(double mbps) { return static_cast<std::uint32_t>(std::lround(mbps * 1e3)); }

Duration nanoseconds(double seconds) { return Duration{std::llround(seconds * 1e9)}; }

void add_options(CLI::App& app, Options& o) {
  app.add_option("--traffic", o.traffic, "What is sent")
      ->check(CLI::IsMember({"beacons", "saturated", "flow", "ping"}))
      ->capture_default_str();
  app.add_flag("--to-sink", o.run.traffic.to_sink, "All to one further node");
  app.add_flag("--unicast", o.unicast, "To one neighbour each instead of to all");
  app.add_option("-n,--nodes", o.run.senders, "Sending nodes")
      ->check(CLI::Range(1, 5000))
      ->capture_default_str();
  app.add_option("--layout", o.layout, "Where the nodes are")
      ->check(CLI::IsMember({"equal", "circle", "line", "hidden"}))
      ->capture_default_str();
  app.add_option("--equal-power", o.run.layout.equal_power.value, "Layout 'equal' [dBm]")
      ->capture_default_str();
  app.add_option("--radius", o.run.layout.circle_radius_m, "Layout 'circle' [m]")
      ->capture_default_str();
  app.add_option("--distance", o.run.layout.line_spacing_m, "Layout 'line' [m]")
      ->capture_default_str();
  app.add_option("--model", o.run.air.channel.model, "Propagation")->capture_default_str();
  app.add_option("--exponent", o.run.air.channel.exponent, "Of log-distance")
      ->capture_default_str();
  app.add_option("--alpha", o.run.air.channel.alpha, "Of paper-eq1")->capture_default_str();
  app.add_option("--chi", o.run.air.channel.chi_db2, "Of paper-eq1: variance [dB^2]")
      ->capture_default_str();
  app.add_option("--carrier", o.carrier_ghz, "[GHz]")->capture_default_str();
  app.add_option("--payload", o.run.traffic.udp_payload_bytes, "UDP payload [B]")
      ->check(CLI::Range(1, 2268))
      ->capture_default_str();
  app.add_option("--period", o.period_ms, "Of beacons and flows [ms]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--jitter", o.jitter_ms, "Of beacons [ms]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--rate", o.rate_mbps, "Of individually addressed frames [Mb/s]")
      ->capture_default_str();
  app.add_option("--group-rate", o.group_rate_mbps, "Of group frames [Mb/s]")
      ->capture_default_str();
  app.add_option("--standard", o.run.air.standard, "Physical layer")
      ->check(CLI::IsMember({"802.11a", "802.11b", "802.11g", "802.11p"}))
      ->capture_default_str();
  app.add_option("--rate-control", o.run.air.rate_control, "Of individually addressed frames")
      ->check(CLI::IsMember({"constant", "ideal", "aarf", "minstrel"}))
      ->capture_default_str();
  app.add_option("--mac", o.run.air.mac, "Medium access")
      ->check(CLI::IsMember({"dcf", "edca", "tdma", "ideal"}))
      ->capture_default_str();
  app.add_option("--priorities", o.priorities, "User priorities of the senders in turn, 0 ... 7")
      ->check(CLI::Range(0, 7))
      ->capture_default_str();
  app.add_option("--ideal-delay", o.ideal_delay_ms, "[ms]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--ideal-jitter", o.ideal_jitter_ms, "Either way [ms]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--ideal-loss", o.run.air.ideal.loss, "Probability")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--ideal-range", o.run.air.ideal.range_m, "[m]")->check(CLI::PositiveNumber);
  app.add_option("--tdma-slot", o.tdma_slot_ms, "One for every node in turn [ms]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--tdma-guard", o.tdma_guard_us, "At the end of a slot [us]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--basic-rates", o.basic_rates_mbps, "[Mb/s]")->capture_default_str();
  app.add_flag("--short-preamble", o.short_preamble, "Of DSSS and CCK rates");
  app.add_option("--rts-threshold", o.run.air.rts_threshold_bytes,
                 "PSDUs above this many bytes are sent after RTS and CTS");
  app.add_option("--error-model", o.run.air.error_model, "Bit errors as a function of SINR")
      ->check(CLI::IsMember({"nist", "yans", "table"}))
      ->capture_default_str();
  app.add_option("--slot", o.slot_us, "[us]; 0: the standard's")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--detection-power", o.detection_dbm, "Preamble detection, least power [dBm]")
      ->capture_default_str();
  app.add_option("--detection-sinr", o.detection_sinr_db, "Preamble detection, least SINR [dB]")
      ->capture_default_str();
  app.add_flag("--no-detection", o.no_detection, "Every preamble is detected");
  app.add_option("--seed", o.run.air.seed)->capture_default_str();
  app.add_option("--duration", o.duration_s, "Measured, after 0.5 s of warm-up [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--replay", o.replay_file,
                 "Frame log of a live run, to be simulated again with the radio that it names; of "
                 "the other options --seed, --positions and --equal-power count")
      ->check(CLI::ExistingFile);
  app.add_option("--positions", o.positions_file,
                 "For --replay: CSV time_ns,node,x_m,y_m,z_m; without it all are in range")
      ->check(CLI::ExistingFile);
  app.add_option("--receptions", o.receptions_file,
                 "For --replay: file for the simulated receptions, CSV "
                 "frame,sender,sent_ns,receiver,delivery_ns");
  app.add_option("--runs", o.runs_file,
                 "What `cuscus air` asks for; of the other options --out counts")
      ->check(CLI::ExistingPath);
  app.add_option("--out", o.out_file, "Of --runs, instead of standard output");
}

void apply(Options& o) {
  static const std::map<std::string, Traffic::Kind> kTraffic{
      {"beacons", Traffic::Kind::kBeacons},
      {"saturated", Traffic::Kind::kSaturated},
      {"flow", Traffic::Kind::kFlow},
      {"ping", Traffic::Kind::kPing}};
  static const std::map<std::string, Layout::Kind> kLayouts{{"equal", Layout::Kind::kEqualPower},
                                                            {"circle", Layout::Kind::kCircle},
                                                            {"line", Layout::Kind::kLine},
                                                            {"hidden", Layout::Kind::kHidden}};
  AirParameters& air = o.run.air;
  o.run.traffic.kind = kTraffic.at(o.traffic);
  o.run.traffic.group = !o.unicast;
  o.run.traffic.period = nanoseconds(o.period_ms * 1e-3);
  o.run.traffic.jitter = nanoseconds(o.jitter_ms * 1e-3);
  o.run.layout.kind = kLayouts.at(o.layout);
  o.run.duration = nanoseconds(o.duration_s);
  air.data_rate_kbps = kbps(o.rate_mbps);
  air.group_rate_kbps = kbps(o.group_rate_mbps);
  air.basic_rates_kbps.clear();
  for (const double rate_mbps : o.basic_rates_mbps) {
    air.basic_rates_kbps.push_back(kbps(rate_mbps));
  }
  air.dsss_preamble = o.short_preamble ? DsssPreamble::kShort : DsssPreamble::kLong;
  air.slot = nanoseconds(o.slot_us * 1e-6);
  o.run.traffic.priorities.assign(o.priorities.begin(), o.priorities.end());
  air.ideal.delay = nanoseconds(o.ideal_delay_ms * 1e-3);
  air.ideal.jitter = nanoseconds(o.ideal_jitter_ms * 1e-3);
  air.tdma.slot = nanoseconds(o.tdma_slot_ms * 1e-3);
  air.tdma.guard = nanoseconds(o.tdma_guard_us * 1e-6);
  air.channel.carrier_hz = o.carrier_ghz * 1e9;
  if (o.no_detection) {
    o.detection_dbm = -std::numeric_limits<double>::infinity();
    o.detection_sinr_db = -std::numeric_limits<double>::infinity();
  }
  air.detection_minimum.value = o.detection_dbm;
  air.detection_minimum_sinr.value = o.detection_sinr_db;
}

void print(const Options& o, const SyntheticResult& r, double wall_s) {
  std::cout << "traffic,cast,layout,nodes,payload_B,rate_kbps,group_rate_kbps,seed,measure_s,"
            << result_columns() << ",events,wall_s\n"
            << fmt::format("{},{},{},{},{},{},{},{},{:.3f},{},{},{:.3f}\n", o.traffic,
                           o.unicast ? "ucast" : "bcast", o.layout, o.run.senders,
                           o.run.traffic.udp_payload_bytes, o.run.air.data_rate_kbps,
                           o.run.air.group_rate_kbps, o.run.air.seed, o.duration_s,
                           result_fields(r), r.events, wall_s);
}

void replay_log(const Options& options, const ReplayLog& log) {
  const DecibelMilliwatt equal_power = options.run.layout.equal_power;
  if (options.receptions_file.empty()) {
    print_replay(std::cout, log, replay(log, equal_power));
    return;
  }
  std::ofstream receptions{options.receptions_file};
  const ReplayResult result = replay(log, equal_power, &receptions);
  if (!receptions.flush()) {
    throw std::runtime_error{options.receptions_file + ": could not be written"};
  }
  print_replay(std::cout, log, result);
}

/// The runs of a `cuscus air`; nothing is written when the first cannot be simulated.
void simulate(const std::string& runs_file, const std::string& out_file) {
  std::ifstream input{runs_file, std::ios::binary};
  proto::SyntheticRuns runs;
  if (!runs.ParseFromIstream(&input)) {
    throw std::invalid_argument{"'" + runs_file + "' does not hold runs"};
  }
  std::ofstream file;
  print_runs(runs, [&]() -> std::ostream& {
    if (out_file.empty()) {
      return std::cout;
    }
    file.open(out_file);
    if (!file) {
      throw std::runtime_error{"--out " + out_file + ": " + std::system_category().message(errno)};
    }
    return file;
  });
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app{"Simulates an 802.11 ad hoc network with synthetic traffic; prints CSV.",
               "cuscus-air"};
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  if (!options.runs_file.empty()) {
    simulate(options.runs_file, options.out_file);
    return 0;
  }
  apply(options);
  if (!options.replay_file.empty()) {
    ReplayLog log = read_replay_log(options.replay_file, options.positions_file);
    if (app.count("--seed") > 0) {
      log.air.seed = options.run.air.seed;
    }
    replay_log(options, log);
    return 0;
  }
  const auto begin = std::chrono::steady_clock::now();
  const SyntheticResult result = run_synthetic(options.run);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  print(options, result, wall.count());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "cuscus-air: " << error.what() << '\n';
    return 2;
  }
}
