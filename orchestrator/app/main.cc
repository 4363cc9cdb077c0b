// cuscus: flies a fleet and its radio network from a scenario file.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <string>
#include <vector>

#include "common/log/log.h"
#include "common/scenario/scenario_error.h"
#include "orchestrator/app/city_commands.h"
#include "orchestrator/app/commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/print.h"

namespace {

namespace orchestrator = cuscus::orchestrator;

constexpr auto kFooter =
    "Exit codes: 0 done, 1 failed, 2 wrong usage or scenario, 3 the run is INVALID, or not\n"
    "VALID with --on-late fail or stop, 128+n ended by signal n.";

void add_scenario(CLI::App& command, orchestrator::ScenarioArguments& arguments) {
  command.add_option("SCENARIO", arguments.file, "scenario file (JSON)")->required();
  command.add_option("--seed", arguments.seed, "of all random numbers");
  command
      .add_option("--set", arguments.set,
                  "PATH=VALUE changes one key, such as radio.data_rate=\"12 Mb/s\"")
      ->take_all()
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_scenario_options(CLI::App& command, orchestrator::ScenarioArguments& arguments) {
  add_scenario(command, arguments);
  command.add_option("--duration", arguments.duration, "such as 60s");
  command.add_option("--clock", arguments.clock, "real");
}

void add_air_options(CLI::App& command, orchestrator::AirArguments& air) {
  add_scenario(command, air.scenario);
  command.add_option("--traffic", air.request.traffic, "beacons, saturated, flow or ping")
      ->capture_default_str();
  command.add_flag("--unicast", air.request.unicast,
                   "beacons and saturated: to the next node each, not to all");
  command.add_option("--from", air.request.from, "flow and ping: such as uav0 (the first node)");
  command.add_option("--to", air.request.to, "flow and ping: such as uav3 (the second node)");
  command.add_option("--payload", air.request.payload_bytes, "UDP payload in bytes")
      ->capture_default_str();
  command.add_option("--period", air.period,
                     "of beacons and pings (50ms); of a flow: as fast as it can, if not given");
  command.add_option("--jitter", air.jitter, "of every beacon, such as 1ms (0ms)");
  command.add_option("--duration", air.duration, "simulated time that is measured (10s)");
  command
      .add_option("--nodes", air.nodes,
                  "numbers of radio nodes to simulate, such as 2,5,10: the first group of the "
                  "fleet grows or shrinks")
      ->delimiter(',');
  command.add_option("--seeds", air.request.seeds, "runs with as many seeds in a row")
      ->capture_default_str();
  command.add_option("--out", air.out, "file for the CSV table (standard output)");
  command.add_flag("--plot", air.plot, "draw --out FILE: .gp, .svg and .png beside it; by gnuplot");
}

void add_city_options(CLI::App& command, orchestrator::CityArguments& city) {
  command.add_option("FILE", city.files, "OpenStreetMap: .osm, .osm.gz, .osm.bz2 or .osm.pbf");
  command.add_option("--bbox", city.bounds, "WEST,SOUTH,EAST,NORTH in degrees (the whole file)");
  command.add_option("--heights", city.heights,
                     "of buildings with neither height nor levels, such as 50m..150m (10m..15m)");
  command.add_option("--terrain", city.terrain,
                     "heights of the ground: ESRI ASCII grid in degrees");
  command.add_option("--seed", city.seed, "of the random heights")->capture_default_str();
  command.add_flag("--json", city.json, "as JSON");
  command.add_option("--out", city.out, "draw it: a new file .json, .svg or .glb");
}

void add_city_generate(CLI::App& city, orchestrator::CityGenerateArguments& arguments) {
  auto* const command =
      city.add_subcommand("generate", "make a city up and write it as an OpenStreetMap file");
  command->add_option("STYLE", arguments.style, "old-town or grid")->required();
  command->add_option("--seed", arguments.seed, "another seed, another city")
      ->capture_default_str();
  command->add_option("--size", arguments.size, "side of the square, 200m ... 5km")
      ->capture_default_str();
  command->add_option("--origin", arguments.origin,
                      "LATITUDE,LONGITUDE of its middle in degrees (old-town 44.5,11.35; grid "
                      "40.75,-73.98)");
  command->add_option("--out", arguments.out, "file to write, such as town.osm")->required();
}

void add_city_fetch(CLI::App& city, orchestrator::CityFetchArguments& arguments) {
  auto* const command =
      city.add_subcommand("fetch", "download a part of OpenStreetMap from an Overpass server");
  command->add_option("--bbox", arguments.bounds, "WEST,SOUTH,EAST,NORTH in degrees")->required();
  command
      ->add_option("--server", arguments.server,
                   "URL of the interpreter, such as https://overpass-api.de/api/interpreter")
      ->required();
  command->add_option("--out", arguments.out, "file to write, such as centre.osm")->required();
  command->add_option("--timeout", arguments.timeout, "for the server's work")
      ->capture_default_str();
  command->add_option("--max-mb", arguments.largest_mb, "largest answer in megabytes")
      ->capture_default_str();
}

/// Options and what to do with them; declared together so that they live as long as the parser.
struct CommandLine {
  CLI::App app{"Flies a fleet of UAVs and their radio network together on one machine.", "cuscus"};
  orchestrator::RunArguments run;
  orchestrator::ScenarioArguments check;
  orchestrator::WhyArguments why;
  orchestrator::AirArguments air;
  orchestrator::CityArguments city;
  orchestrator::CityGenerateArguments city_generate;
  orchestrator::CityFetchArguments city_fetch;
  bool check_json{false};
  bool schema{false};
  bool ps_json{false};
  std::string run_id;
  std::string node;
  std::vector<std::string> command;
  std::size_t doctor_nodes{11};

  CommandLine() {
    app.footer(kFooter);
    app.require_subcommand(1);
    auto* const run_command = app.add_subcommand("run", "fly a scenario");
    add_scenario_options(*run_command, run.scenario);
    run_command->add_option("--out", run.out, "folder for the results (default runs/<run id>)");
    run_command->add_option("--on-late", run.scenario.on_late,
                            "when the host does not keep up: warn, fail (exit code 3 unless VALID) "
                            "or stop (as soon as the run cannot become VALID any more)");
    run_command->add_flag("--no-page", run.scenario.no_page, "do not serve the page");
    auto* const check_command =
        app.add_subcommand("check", "check a scenario and print the plan; creates nothing");
    add_scenario_options(*check_command, check);
    check_command->add_flag("--json", check_json, "print the plan as JSON");
    add_air_options(
        *app.add_subcommand(
            "air", "simulate the scenario's radio under synthetic traffic; needs no privileges"),
        air);
    add_city_commands(
        *app.add_subcommand("city", "maps of cities: what is understood of one, or a new one"));
    app.add_subcommand("schema", "print the JSON schema of scenarios");
    auto* const ps_command = app.add_subcommand("ps", "list the runs of this machine");
    ps_command->add_flag("--json", ps_json, "as JSON, with every node");
    auto* const exec_command = app.add_subcommand("exec", "run a command inside a node");
    exec_command->add_option("--run", run_id, "run id, when several are alive");
    exec_command->add_option("NODE", node, "such as uav3")->required();
    exec_command->add_option("COMMAND", command, "after --")->required();
    exec_command->positionals_at_end();
    auto* const stop_command = app.add_subcommand("stop", "end a run; its results are kept");
    stop_command->add_option("RUN", run_id, "run id, when several are alive");
    add_why();
    app.add_subcommand("clean", "remove what killed runs have left behind");
    auto* const doctor_command =
        app.add_subcommand("doctor", "what this machine can and cannot do");
    doctor_command->add_option("--nodes", doctor_nodes, "nodes to be flown");
  }

  void add_why() {
    auto* const why_command =
        app.add_subcommand("why", "what became of the frames from one node to another, and why");
    why_command->add_option("RUN", why.run, "run directory, recorded with record.receptions")
        ->required();
    why_command->add_option("FROM", why.sender, "node that sent, such as uav3")->required();
    why_command->add_option("TO", why.receiver, "node that they were meant for, such as uav7")
        ->required();
    why_command->add_option("--at", why.at, "time in the run, such as 12.3s")->required();
    why_command->add_option("--for", why.window, "from then on")->capture_default_str();
    why_command->add_flag("--csv", why.csv, "comma-separated");
  }

  /// What is wrong with the first argument, when it should have been a subcommand; else nothing.
  [[nodiscard]] std::string unknown_subcommand(int argc, char* argv[]) const {
    if (argc < 2 || argv[1][0] == '-') {
      return {};
    }
    std::string names;
    for (const auto* const subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
      if (subcommand->get_name() == argv[1]) {
        return {};
      }
      names += (names.empty() ? "" : ", ") + subcommand->get_name();
    }
    return fmt::format("there is no subcommand '{}'; there are: {}", argv[1], names);
  }

  void add_city_commands(CLI::App& parent) {
    add_city_options(parent, city);
    add_city_generate(parent, city_generate);
    add_city_fetch(parent, city_fetch);
  }

  int dispatch_city(const CLI::App& parsed) {
    if (parsed.got_subcommand("generate")) {
      return orchestrator::city_generate_command(city_generate);
    }
    if (parsed.got_subcommand("fetch")) {
      return orchestrator::city_fetch_command(city_fetch);
    }
    return orchestrator::city_command(city);
  }

  int dispatch() {
    if (app.got_subcommand("run")) {
      return orchestrator::run_command(run);
    }
    if (app.got_subcommand("check")) {
      return orchestrator::check_command(check, check_json);
    }
    if (app.got_subcommand("air")) {
      return orchestrator::air_command(air);
    }
    if (app.got_subcommand("city")) {
      return dispatch_city(*app.get_subcommand("city"));
    }
    if (app.got_subcommand("schema")) {
      return orchestrator::schema_command();
    }
    if (app.got_subcommand("ps")) {
      return orchestrator::ps_command(ps_json);
    }
    if (app.got_subcommand("exec")) {
      // The parser leaves the separator where it is once positionals have begun.
      if (command.front() == "--") {
        command.erase(command.begin());
      }
      if (command.empty()) {
        throw orchestrator::UsageError{"exec: there is no command after --"};
      }
      return orchestrator::exec_command(run_id, node, command);
    }
    if (app.got_subcommand("stop")) {
      return orchestrator::stop_command(run_id);
    }
    if (app.got_subcommand("why")) {
      return orchestrator::why_command(why);
    }
    if (app.got_subcommand("clean")) {
      return orchestrator::clean_command();
    }
    return orchestrator::doctor_command(doctor_nodes);
  }
};

}  // namespace

int main(int argc, char* argv[]) try {
  // Whoever reads the output may go; the run and its results do not depend on it.
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
  cuscus::log::start("cuscus");
  CommandLine line;
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const auto unknown = line.unknown_subcommand(argc, argv); !unknown.empty()) {
      throw orchestrator::UsageError{unknown};
    }
    const int code = line.app.exit(error);
    return code == 0 ? orchestrator::kExitDone : orchestrator::kExitUsage;
  }
  return line.dispatch();
} catch (const cuscus::scenario::ScenarioError& error) {
  orchestrator::print(stderr, "cuscus: {}\n", error.what());
  return orchestrator::kExitUsage;
} catch (const orchestrator::UsageError& error) {
  orchestrator::print(stderr, "cuscus: {}\n", error.what());
  return orchestrator::kExitUsage;
} catch (const std::exception& error) {
  orchestrator::print(stderr, "cuscus: {}\n", error.what());
  return orchestrator::kExitFailed;
}
