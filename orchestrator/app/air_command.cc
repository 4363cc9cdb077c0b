#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/child_process.h"
#include "common/scenario/units.h"
#include "orchestrator/app/city_source.h"
#include "orchestrator/app/commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/ownership.h"
#include "orchestrator/app/print.h"
#include "orchestrator/app/service.h"
#include "orchestrator/plan/plan.h"
#include "orchestrator/results/air_plot.h"

namespace cuscus::orchestrator {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGnuplot = "gnuplot";

scenario::Duration duration_of(const char* option, const std::string& text) {
  try {
    return scenario::Duration{
        static_cast<std::int64_t>(scenario::parse_quantity(text, scenario::kTime))};
  } catch (const scenario::UnitError& error) {
    throw UsageError{fmt::format("{} {}: {}", option, text, error.what())};
  }
}

SyntheticRequest request_of(const AirArguments& arguments) {
  SyntheticRequest request = arguments.request;
  if (arguments.duration) {
    request.duration = duration_of("--duration", *arguments.duration);
  }
  if (arguments.period) {
    request.period = duration_of("--period", *arguments.period);
  }
  if (arguments.jitter) {
    request.jitter = duration_of("--jitter", *arguments.jitter);
  }
  return request;
}

/// The scenario in every size that is asked for.
std::vector<scenario::Scenario> scenarios_of(const AirArguments& arguments) {
  const auto overrides = overrides_of(arguments.scenario);
  std::vector<scenario::Scenario> scenarios{
      scenario::load_scenario(arguments.scenario.file, overrides)};
  if (arguments.nodes.empty()) {
    return scenarios;
  }
  const scenario::Scenario as_written = scenarios.front();
  scenarios.clear();
  for (const std::uint32_t nodes : arguments.nodes) {
    auto resized = overrides;
    resized.push_back({.option = fmt::format("--nodes {}", nodes),
                       .path = "fleet.0.count",
                       .value = std::to_string(first_group_size(as_written, nodes))});
    scenarios.push_back(scenario::load_scenario(arguments.scenario.file, resized));
  }
  return scenarios;
}

std::optional<std::string> variable(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
  return value != nullptr ? std::optional<std::string>{value} : std::nullopt;
}

std::string search_path() { return variable("PATH").value_or(std::string{kProgramPath}); }

bool is_installed(const std::string& program) {
  std::string folders = search_path() + ':';
  for (std::size_t end = 0; (end = folders.find(':')) != std::string::npos;) {
    const fs::path file = fs::path{folders.substr(0, end)} / program;
    folders.erase(0, end + 1);
    if (file.is_absolute() && ::access(file.c_str(), X_OK) == 0) {
      return true;
    }
  }
  return false;
}

/// The files that the command will write; none of them may be there already.
std::vector<fs::path> check_output(const AirArguments& arguments) {
  if (!arguments.out) {
    if (arguments.plot) {
      throw UsageError{"--plot draws a file: --out FILE is missing"};
    }
    return {};
  }
  std::vector<fs::path> files{*arguments.out};
  if (arguments.plot) {
    const AirPlotFiles plot = AirPlotFiles::beside(*arguments.out);
    files.insert(files.end(), {plot.script, plot.svg, plot.png});
    if (!is_installed(kGnuplot)) {
      throw UsageError{
          "--plot needs gnuplot, which is not installed (Debian: apt install gnuplot-nox)"};
    }
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (i > 0 && files[i] == files[0]) {
      throw UsageError{fmt::format("--out {} has the name of a drawing; allowed: such as {}",
                                   files[0].native(),
                                   fs::path{files[0]}.replace_extension(".csv").native())};
    }
    std::error_code error;  // of a folder that may not be searched: said when the file is made
    if (fs::exists(fs::symlink_status(files[i], error))) {
      throw UsageError{fmt::format("--out {}: {} exists", files[0].native(), files[i].native())};
    }
  }
  return files;
}

/// A memory file that holds `content`, to be read from its start.
posix::UniqueFd memory_file(const std::string& content) {
  posix::UniqueFd file{
      posix::check("create a memory file", ::memfd_create("cuscus-air", MFD_CLOEXEC))};
  for (std::size_t written = 0; written < content.size();) {
    const ssize_t count = ::write(file.get(), content.data() + written, content.size() - written);
    written += static_cast<std::size_t>(posix::check("write a memory file", count));
  }
  posix::check("rewind a memory file", ::lseek(file.get(), 0, SEEK_SET));
  return file;
}

/// Runs a program in the caller's process group, so that Ctrl-C ends it too; its exit code.
int run_program(posix::ChildSpecification specification) {
  specification.own_session = false;
  specification.environment = {"PATH=" + search_path(), "HOME=" + variable("HOME").value_or("/")};
  const std::string name = fs::path{specification.arguments.front()}.filename();
  const posix::ExitStatus status = posix::ChildProcess::spawn(specification).wait();
  if (status.signal_number != 0) {
    print(stderr, "cuscus: {} ended: {}\n", name, text_of(status));
    return kExitSignalBase + status.signal_number;
  }
  return status.exit_code;
}

int simulate(const proto::SyntheticRuns& runs, const std::optional<fs::path>& out) {
  const fs::path program = fs::read_symlink("/proc/self/exe").replace_filename("cuscus-air");
  if (::access(program.c_str(), X_OK) != 0) {
    throw UsageError{fmt::format("cuscus-air is missing: {}", program.native())};
  }
  const posix::UniqueFd configuration = memory_file(runs.SerializeAsString());
  posix::ChildSpecification specification{.arguments = {program.native(), "--runs", "/dev/stdin"},
                                          .input_fd = configuration.get()};
  if (out) {
    specification.arguments.insert(specification.arguments.end(), {"--out", out->native()});
  }
  return run_program(std::move(specification));
}

int draw(const AirPlotFiles& files, const std::string& title, bool over_nodes) {
  std::ofstream script{files.script};
  script << air_plot_script(files, title, over_nodes) << std::flush;
  if (!script) {
    throw std::runtime_error{fmt::format("cannot write {}", files.script.native())};
  }
  posix::ChildSpecification specification{
      .arguments = {kGnuplot, files.script.filename().native()},
      .working_directory = fs::absolute(files.script).parent_path().native()};
  return run_program(std::move(specification));
}

}  // namespace

int air_command(const AirArguments& arguments) try {
  const SyntheticRequest request = request_of(arguments);
  const std::vector<scenario::Scenario> scenarios = scenarios_of(arguments);
  proto::SyntheticRuns runs = synthetic_runs(request, scenarios);
  runs.set_city(load_city(scenarios.front()));
  const std::vector<fs::path> files = check_output(arguments);
  int code = simulate(runs, arguments.out);
  if (code == kExitDone && arguments.plot) {
    code = draw(
        AirPlotFiles::beside(*arguments.out),
        fmt::format("{}: {}, {} B", runs.scenario_name(), request.traffic, request.payload_bytes),
        arguments.nodes.size() > 1);
  }
  if (const auto owner = sudo_caller()) {
    for (const fs::path& file : files) {
      // A file that has not come to be needs no owner.
      static_cast<void>(::lchown(file.c_str(), owner->uid, owner->gid));
    }
  }
  return code;
} catch (const std::invalid_argument& error) {
  throw UsageError{error.what()};
}

}  // namespace cuscus::orchestrator
