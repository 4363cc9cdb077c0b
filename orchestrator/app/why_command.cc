#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/scenario/units.h"
#include "orchestrator/app/commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/print.h"
#include "orchestrator/results/run_directory.h"
#include "orchestrator/results/why.h"

namespace cuscus::orchestrator {
namespace {

namespace fs = std::filesystem;

std::int64_t time_ns(const char* option, const std::string& text) {
  double value_ns = 0.0;
  try {
    value_ns = scenario::parse_quantity(text, scenario::kTime);
  } catch (const scenario::UnitError& error) {
    throw UsageError{fmt::format("{}: {}", option, error.what())};
  }
  constexpr double kLongest_ns = 1e18;
  if (value_ns < 0.0 || value_ns > kLongest_ns) {
    throw UsageError{fmt::format("{}: '{}' is not a time of a run", option, text)};
  }
  return std::llround(value_ns);
}

ReceptionLogReader open_log(const fs::path& run) {
  if (!fs::is_directory(run)) {
    throw UsageError{fmt::format("'{}' is not a run directory", run.string())};
  }
  const fs::path file = run / kReceptionLogFile;
  if (!fs::exists(file)) {
    const bool is_run = fs::exists(run / kResolvedScenarioFile);
    throw UsageError{
        is_run ? fmt::format("run '{}' has no reception log; the key record.receptions makes one, "
                             "as with: cuscus run SCENARIO --set record.receptions=true",
                             run.string())
               : fmt::format("'{}' is not a run directory: it has no {}", run.string(),
                             kResolvedScenarioFile)};
  }
  return ReceptionLogReader{file};
}

std::uint32_t node_of(const std::string& name, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) {
    return static_cast<std::uint32_t>(found - names.begin());
  }
  std::string known;
  for (const auto& other : names) {
    known += (known.empty() ? "" : ", ") + other;
  }
  throw UsageError{fmt::format("there is no node '{}' in this run; there are: {}", name, known)};
}

/// How long the run was [s]; nothing for one that did not end in order.
std::optional<double> length_s(const fs::path& run) {
  std::ifstream file{run / kSummaryFile};
  const auto summary = nlohmann::json::parse(file, nullptr, false);
  const auto simulated = summary.is_object() ? summary.find("simulated_s") : summary.end();
  return summary.is_object() && simulated != summary.end() && simulated->is_number()
             ? std::optional{simulated->get<double>()}
             : std::nullopt;
}

}  // namespace

int why_command(const WhyArguments& arguments) {
  ReceptionLogReader log = open_log(arguments.run);
  const auto& names = log.names();
  WhyQuestion question{.sender = node_of(arguments.sender, names),
                       .receiver = node_of(arguments.receiver, names),
                       .from = sim_time(time_ns("--at", arguments.at)),
                       .to = {}};
  if (question.sender == question.receiver) {
    throw UsageError{fmt::format("'{}' sends itself nothing over the air", arguments.sender)};
  }
  question.to = question.from + std::chrono::nanoseconds{time_ns("--for", arguments.window)};
  const double from_s = to_seconds(question.from.time_since_epoch());
  if (const auto run_s = length_s(arguments.run); run_s && from_s > *run_s) {
    throw UsageError{fmt::format("--at {}: the run ended at {:.3f} s", arguments.at, *run_s)};
  }
  const auto records = frames_of(log, question);
  if (arguments.csv) {
    print(stdout, "{}", why_csv(records, names));
  } else if (records.empty()) {
    print(stdout, "{} sent nothing towards {} from {:.6f} s to {:.6f} s\n", arguments.sender,
          arguments.receiver, from_s, to_seconds(question.to.time_since_epoch()));
  } else {
    print(stdout, "{}", why_table(records, names));
  }
  return kExitDone;
}

}  // namespace cuscus::orchestrator
