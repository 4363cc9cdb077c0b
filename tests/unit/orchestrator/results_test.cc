#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "orchestrator/results/metrics.h"
#include "orchestrator/results/run_directory.h"
#include "orchestrator/results/summary.h"

namespace cuscus::orchestrator {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// A folder of the test's own, removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = fs::temp_directory_path() / "cuscus-results-XXXXXX";
    if (::mkdtemp(pattern.data()) == nullptr) {
      throw std::system_error{errno, std::system_category(), "mkdtemp"};
    }
    path_ = pattern;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// A limit of the size of files [B] for as long as it lives; beyond it write() gives EFBIG.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t limit_bytes) : old_handler_{std::signal(SIGXFSZ, SIG_IGN)} {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{limit_bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

std::string content_of(const fs::path& file) {
  std::ifstream stream{file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream{line};
  for (std::string field; std::getline(stream, field, ',');) {
    fields.push_back(field);
  }
  if (line.ends_with(',')) {
    fields.emplace_back();
  }
  return fields;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST_CASE("A run's name is its scenario, the time in UTC and chance") {
  const auto noon = std::chrono::system_clock::time_point{1'769'860'800s};  // 2026-01-31 12:00 UTC

  CHECK(make_run_id("default", noon, 0xab3f9a1c) == "default-20260131T120000Z-3f9a1c");
  CHECK(make_run_id("default", noon, 0x1) == "default-20260131T120000Z-000001");
  CHECK(utc_text(noon) == "2026-01-31T12:00:00Z");
}

TEST_CASE("A run directory is new, readable by all, and has a folder for logs") {
  const TemporaryFolder folder;
  const mode_t old_mask = ::umask(022);

  const auto run = RunDirectory::create(folder.path() / "runs" / "a b");
  ::umask(old_mask);

  CHECK(run.path() == folder.path() / "runs" / "a b");
  CHECK((fs::status(run.path()).permissions() & fs::perms::all) == fs::perms{0755});
  CHECK(fs::is_directory(run.path() / "logs"));
}

TEST_CASE("A trailing slash names the same folder") {
  const TemporaryFolder folder;

  CHECK(RunDirectory::create(folder.path() / "run/").path() == folder.path() / "run");
}

TEST_CASE("Whatever is there already is refused: a folder, a file, a link, a dangling link") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "folder");
  std::ofstream{folder.path() / "file"} << "x";
  fs::create_directory_symlink(folder.path() / "folder", folder.path() / "link");
  fs::create_symlink(folder.path() / "nowhere", folder.path() / "dangling");

  for (const char* name : {"folder", "file", "link", "dangling"}) {
    CAPTURE(name);
    CHECK_THROWS_WITH(RunDirectory::create(folder.path() / name),
                      Catch::Contains(std::string{"make run directory "} +
                                      (folder.path() / name).string() + ": File exists"));
  }
  CHECK(fs::is_empty(folder.path() / "folder"));
  CHECK_FALSE(fs::exists(folder.path() / "nowhere"));
}

TEST_CASE("A file is replaced as a whole and leaves nothing beside it") {
  const TemporaryFolder folder;
  const auto run = RunDirectory::create(folder.path() / "run");

  run.write_file("summary.json", "old");
  run.write_file("summary.json", "new");

  CHECK(content_of(run.path() / "summary.json") == "new");
  CHECK_FALSE(fs::exists(run.path() / "summary.json.part"));
}

TEST_CASE("A full disk leaves the old file whole") {
  const TemporaryFolder folder;
  const auto run = RunDirectory::create(folder.path() / "run");
  run.write_file("summary.json", "old");

  {
    const FileSizeLimit limit{1000};
    CHECK_THROWS_WITH(run.write_file("summary.json", std::string(5000, 'x')),
                      Catch::Contains("write " + (run.path() / "summary.json").string()) &&
                          Catch::Contains("File too large"));
  }

  CHECK(content_of(run.path() / "summary.json") == "old");
  CHECK_FALSE(fs::exists(run.path() / "summary.json.part"));
}

TEST_CASE("Work goes to the folder that was made, wherever its name leads later") {
  const TemporaryFolder folder;
  const auto run = RunDirectory::create(folder.path() / "run");
  fs::rename(run.path(), folder.path() / "moved");
  fs::create_directory(folder.path() / "other");
  fs::create_directory_symlink(folder.path() / "other", folder.path() / "run");

  run.write_file("summary.json", "mine");

  CHECK(content_of(folder.path() / "moved" / "summary.json") == "mine");
  CHECK(fs::is_empty(folder.path() / "other"));
}

TEST_CASE("A link put in place of a result file is replaced, not followed") {
  const TemporaryFolder folder;
  const auto run = RunDirectory::create(folder.path() / "run");
  std::ofstream{folder.path() / "victim"} << "precious";
  fs::create_symlink(folder.path() / "victim", run.path() / "summary.json");
  fs::create_symlink(folder.path() / "victim", run.path() / "metrics.csv");

  run.write_file("summary.json", "result");

  CHECK(content_of(folder.path() / "victim") == "precious");
  CHECK(content_of(run.path() / "summary.json") == "result");
  CHECK_THROWS_WITH(run.create_file("metrics.csv"), Catch::Contains("File exists"));
}

TEST_CASE("Logs are created once, in their folder") {
  const TemporaryFolder folder;
  const auto run = RunDirectory::create(folder.path() / "run");

  const auto log = run.create_file("logs/uav3-command.log");
  write_all(log.get(), "hello\n");

  CHECK(content_of(run.path() / "logs" / "uav3-command.log") == "hello\n");
  CHECK_THROWS_AS(run.create_file("logs/uav3-command.log"), std::system_error);
}

MetricsRow row_at(std::int64_t time_ns) {
  MetricsRow row;
  row.time = sim_time(time_ns);
  row.node = "uav3";
  row.motion = shm::NodeState{};
  row.motion->p_WB_m = {1.25, -2.5, 10.0};
  row.motion->v_WB_W_mps = {0.5, 0.0, -0.125};
  row.motion->q_WB = {std::cos(0.25), 0.0, 0.0, std::sin(0.25)};  // a yaw of 0.5 rad
  row.formation_error_m = 0.75;
  row.flight_state = "flying";
  row.radio = shm::RadioTally{};
  row.radio->offered = 18'000'000'000'000'000'000U;
  row.radio->lost_interface = 7;
  return row;
}

TEST_CASE("A row of metrics reads back as what was measured") {
  const auto names = fields_of(lines_of(metrics_header()).at(0));
  const auto values = fields_of(lines_of(metrics_line(row_at(1'234'567'000))).at(0));

  REQUIRE(values.size() == names.size());
  std::map<std::string, std::string> row;
  for (std::size_t i = 0; i < names.size(); ++i) {
    row[names[i]] = values[i];
  }
  CHECK(row.size() == names.size());  // no name twice
  CHECK(row["sim_time_s"] == "1.234567");
  CHECK(row["node"] == "uav3");
  CHECK(std::stod(row["x_m"]) == 1.25);
  CHECK(std::stod(row["y_m"]) == -2.5);
  CHECK(std::stod(row["z_m"]) == 10.0);
  CHECK(std::stod(row["vz_mps"]) == -0.125);
  CHECK(std::stod(row["yaw_rad"]) == 0.5);
  CHECK(std::stod(row["formation_error_m"]) == 0.75);
  CHECK(row["flight_state"] == "flying");
  CHECK(row["offered"] == "18000000000000000000");
  CHECK(row["retries"] == "0");
  CHECK(row["lost_interface"] == "7");
}

TEST_CASE("What is unknown is an empty field, what is not finite too") {
  MetricsRow row;
  row.node = "gcs";
  const auto names = fields_of(lines_of(metrics_header()).at(0));

  const auto unknown = fields_of(lines_of(metrics_line(row)).at(0));
  REQUIRE(unknown.size() == names.size());
  CHECK(unknown[0] == "0.000000");
  CHECK(unknown[1] == "gcs");
  for (std::size_t i = 2; i < unknown.size(); ++i) {
    CHECK(unknown[i].empty());
  }

  row.motion = shm::NodeState{};
  row.motion->p_WB_m = {NAN, HUGE_VAL, 1.0};
  CHECK_THAT(metrics_line(row), Catch::StartsWith("0.000000,gcs,,,1.0000,0.0000"));
}

TEST_CASE("A text with a comma is quoted") {
  MetricsRow row;
  row.node = "uav0";
  row.flight_state = "failsafe, \"motor\"";

  CHECK_THAT(metrics_line(row), Catch::Contains(R"(,"failsafe, ""motor""",)"));
}

TEST_CASE("Rows are in the file after a flush, under one header") {
  const TemporaryFolder folder;
  const auto run = RunDirectory::create(folder.path() / "run");
  MetricsWriter writer{run.create_file("metrics.csv")};

  writer.add(row_at(0));
  writer.add(row_at(1'000'000'000));
  writer.flush();

  const std::string text = content_of(run.path() / "metrics.csv");
  CHECK(text == metrics_header() + metrics_line(row_at(0)) + metrics_line(row_at(1'000'000'000)));
  CHECK_FALSE(writer.take_error());
}

TEST_CASE("A full disk ends the metrics with one error and whole rows") {
  const TemporaryFolder folder;
  const auto run = RunDirectory::create(folder.path() / "run");
  MetricsWriter writer{run.create_file("metrics.csv")};
  writer.add(row_at(0));
  writer.flush();
  const std::string before = content_of(run.path() / "metrics.csv");
  std::optional<std::string> error;
  {
    const FileSizeLimit limit{before.size() + 20};

    writer.add(row_at(1));
    writer.flush();
    error = writer.take_error();
    writer.add(row_at(2));
    writer.flush();
  }

  REQUIRE(error);
  CHECK_THAT(*error, Catch::StartsWith("metrics.csv ends here, and the run goes on") &&
                         Catch::Contains("File too large"));
  CHECK_FALSE(writer.take_error());
  CHECK(writer.rows_dropped() == 2);
  CHECK(content_of(run.path() / "metrics.csv") == before);
}

TEST_CASE("A device that is full is told once as well") {
  MetricsWriter writer{posix::UniqueFd{::open("/dev/full", O_WRONLY | O_CLOEXEC)}};

  for (int i = 0; i < 3; ++i) {
    writer.add(row_at(i));
    writer.flush();
  }

  CHECK_THAT(writer.take_error().value(), Catch::Contains("No space left on device"));
  CHECK_FALSE(writer.take_error());
  CHECK(writer.rows_dropped() == 3);
}

TEST_CASE("Formation errors are summarised by their quantiles") {
  std::vector<double> errors_m;
  for (int i = 100; i >= 1; --i) {
    errors_m.push_back(i);
  }
  errors_m.push_back(NAN);

  const auto summary = summarize_errors(errors_m);

  REQUIRE(summary);
  CHECK(summary->samples == 100);
  CHECK(summary->mean_m == 50.5);
  CHECK(summary->p50_m == 50.0);
  CHECK(summary->p95_m == 95.0);
  CHECK(summary->max_m == 100.0);
  CHECK_FALSE(summarize_errors({}));
  CHECK_FALSE(summarize_errors(std::vector<double>{NAN}));
}

TEST_CASE("The summary says how every program ended and adds the radio's counts up") {
  RunOutcome run;
  run.run_id = "t-20260131T120000Z-000001";
  run.seed = 7;
  run.versions["cuscus"] = "0.1.0";
  run.simulated = 1500ms;
  run.metrics_rows_dropped = 3;
  NodeOutcome first;
  first.name = "uav0";
  first.radio = shm::RadioTally{};
  first.radio->offered = 10;
  first.radio->received = 5;
  first.emulator.emplace().set_queue_high_water(17);
  first.emulator->set_release_lateness_max_ns(48'000);
  first.tap_dropped = 3;
  first.commands = shm::CommandTally{};
  first.commands->rejected_not_finite = 1;
  first.collisions.emplace().set_buildings(2);
  first.collisions->set_vehicles(1);
  first.agent.emplace().set_final_state("flying");
  first.programs.push_back({.kind = ProgramKind::kCommand,
                            .program = "ping",
                            .exit_code = {},
                            .signal_number = SIGSEGV,
                            .error = {},
                            .ended_at = 1s});
  NodeOutcome second;
  second.index = 1;
  second.name = "gcs";
  second.role = NodeRole::kGroundStation;
  second.radio = shm::RadioTally{};
  second.radio->offered = 1;
  second.radio->lost_collision = 2;
  run.nodes = {first, second};
  Fidelity fidelity;
  fidelity.verdict = Verdict::kDegraded;
  fidelity.reasons = {"late"};

  const auto json = to_json(run, fidelity);

  CHECK(json.at("verdict") == "DEGRADED");
  CHECK(json.at("verdict_reasons").at(0) == "late");
  CHECK(json.at("simulated_s") == 1.5);
  CHECK(json.at("metrics_rows_dropped") == 3);
  CHECK(json.at("versions").at("cuscus") == "0.1.0");
  CHECK(json.at("radio_total").at("offered") == 11);
  CHECK(json.at("radio_total").at("received") == 5);
  CHECK(json.at("radio_total").at("lost_collision") == 2);
  CHECK(json.at("nodes").at(0).at("emulator").at("queue_high_water") == 17);
  CHECK(json.at("nodes").at(0).at("emulator").at("release_lateness_max_ns") == 48'000);
  CHECK(json.at("nodes").at(0).at("tap_dropped") == 3);
  CHECK(json.at("nodes").at(0).at("commands").at("rejected_not_finite") == 1);
  CHECK(json.at("nodes").at(0).at("collisions").at("contacts") == 3);
  CHECK(json.at("nodes").at(0).at("collisions").at("crashed") == false);
  CHECK(json.at("nodes").at(0).at("agent").at("final_state") == "flying");
  const auto& program = json.at("nodes").at(0).at("programs").at(0);
  CHECK(program.at("signal") == SIGSEGV);
  CHECK(program.at("exit_code").is_null());
  CHECK(program.at("ended_at_s") == 1.0);
  CHECK(json.at("nodes").at(1).at("role") == "ground-station");
  CHECK(json.at("nodes").at(1).at("collisions").is_null());
  CHECK(json.at("nodes").at(1).at("agent").is_null());
  CHECK(json.at("nodes").at(1).at("emulator").is_null());
  CHECK(json.at("nodes").at(1).at("tap_dropped").is_null());
}

}  // namespace
}  // namespace cuscus::orchestrator
