#include "orchestrator/results/fidelity.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "orchestrator/results/report_json.h"

namespace cuscus::orchestrator {
namespace {

using Json = nlohmann::ordered_json;

constexpr double ms(std::int64_t duration_ns) { return static_cast<double>(duration_ns) / 1e6; }

/// Limits of a share of samples, with the number of samples that is always forgiven: in a short run
/// one hiccup of the host must not outweigh its share.
struct ShareLimits {
  double valid_percent;
  double degraded_percent;
  std::uint64_t forgiven;
};

/// Bins are powers of two: 2^14 ns = 16 us (a slot of 20 us or less), 2^19 ns = 0.52 ms, 2^21 ns
/// = 2.10 ms, 2^23 ns = 8.39 ms.
constexpr unsigned kSlot = 14;
constexpr unsigned kHalfMillisecond = 19;
constexpr unsigned kTwoMilliseconds = 21;
constexpr unsigned kEightMilliseconds = 23;

constexpr ShareLimits kLateByHalf{.valid_percent = 1.0, .degraded_percent = 10.0, .forgiven = 10};
constexpr ShareLimits kClamps{.valid_percent = 0.1, .degraded_percent = 1.0, .forgiven = 3};
constexpr ShareLimits kLateByTwo{.valid_percent = 0.1, .degraded_percent = 1.0, .forgiven = 3};
constexpr ShareLimits kStepsLateByTwo{.valid_percent = 0.5, .degraded_percent = 5.0, .forgiven = 3};
constexpr ShareLimits kStepsLateByEight{
    .valid_percent = 0.1, .degraded_percent = 1.0, .forgiven = 25};
constexpr ShareLimits kOverruns{.valid_percent = 1.0, .degraded_percent = 10.0, .forgiven = 10};
constexpr ShareLimits kLost{.valid_percent = 0.0, .degraded_percent = 0.1, .forgiven = 0};
constexpr ShareLimits kCanaryLate{.valid_percent = 1.0, .degraded_percent = 10.0, .forgiven = 3};
constexpr ShareLimits kCanaryLost{.valid_percent = 1.0, .degraded_percent = 10.0, .forgiven = 1};
constexpr ShareLimits kUnstamped{.valid_percent = 0.1, .degraded_percent = 1.0, .forgiven = 3};

constexpr double kLongestValid_ms = 50.0;      // the beacon period of the paper's experiments
constexpr double kLongestDegraded_ms = 500.0;  // the time after which a neighbour is forgotten
constexpr double kSuspendedAllowed_ms = 1.0;   // nothing but the jitter of two clock readings
constexpr double kSupervisionGap_ms = 1000.0;

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + ' ' + unit;
}

class Judge {
 public:
  explicit Judge(const FidelityInputs& inputs) : inputs_{inputs} {}

  Fidelity result() {
    for (const std::string& failure : inputs_.failures) {
      reject(failure);
    }
    radio();
    world();
    agents();
    canary();
    host();
    std::stable_sort(reasons_.begin(), reasons_.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (auto& [verdict, text] : reasons_) {
      fidelity_.reasons.push_back(std::move(text));
    }
    return std::move(fidelity_);
  }

 private:
  void reject(const std::string& reason) {
    fidelity_.verdict = Verdict::kInvalid;
    reasons_.emplace_back(Verdict::kInvalid, reason);
  }

  void radio() {
    if (!inputs_.radio) {
      reject("netsim gave no report");
      return;
    }
    const proto::RadioReport& report = *inputs_.radio;
    const auto& release = report.release_lateness();
    late_share("release_later_than_0.5ms", "releases", release, kHalfMillisecond, kLateByHalf);
    late_share("release_later_than_2ms", "releases", release, kTwoMilliseconds, kLateByTwo);
    limit({.name = "release_lateness_max",
           .description = "the latest release was late by",
           .unit = "ms",
           .measured = ms(release.max_ns()),
           .valid_up_to = kLongestValid_ms,
           .degraded_up_to = kLongestDegraded_ms});
    const std::uint64_t frames = report.ingress_delay().count();
    share("clamps", "frames that the emulator knew of more than 16 us after their time",
          count_from(report.clamp(), kSlot), frames, kClamps);
    if (report.send_stamps() == "tc-bpf") {
      share("unstamped", "frames without a send stamp", report.unstamped(), frames, kUnstamped);
    } else {
      fidelity_.notes.push_back(
          "send times were taken when netsim read the frames (no BPF): they are late by the "
          "ingress delay, and frames sent nearly together may have changed their order");
      late_share("ingress_later_than_2ms", "frames read", report.ingress_delay(), kTwoMilliseconds,
                 kLateByTwo);
    }
    // A stamped frame that a TAP dropped is in both counts; `frames` has it already.
    share("lost_outside_the_air", "frames lost between the programs and the emulator",
          std::max(report.lost_before_air(), inputs_.tap_drops), frames, kLost);
    share("lost_in_backlogs", "frames lost in the kernel's queues behind the emulator",
          inputs_.backlog_drops, release.count(), kLost);
    if (report.frames_not_logged() > 0) {
      fidelity_.notes.push_back(
          fmt::format("the frame log lacks {} frames", report.frames_not_logged()));
    }
    if (report.receptions_not_logged() > 0) {
      fidelity_.notes.push_back(
          fmt::format("the reception log lacks {} records", report.receptions_not_logged()));
    }
    if (report.packets_not_captured() > 0) {
      fidelity_.notes.push_back(
          fmt::format("the captures lack {} packets", report.packets_not_captured()));
    }
    scheduler("netsim", report.scheduler());
    if (inputs_.realtime_wanted && !report.has_processor()) {
      fidelity_.notes.push_back(
          "netsim had no processor for itself: it did the kernel's work of receiving as well");
    }
  }

  void world() {
    if (!inputs_.world) {
      reject("world gave no report");
      return;
    }
    const proto::WorldReport& report = *inputs_.world;
    share("world_overruns", "world steps that ended after the next one was due", report.overruns(),
          report.steps(), kOverruns);
    const auto& lateness = report.step_lateness();
    late_share("world_step_later_than_2ms", "world steps", lateness, kTwoMilliseconds,
               kStepsLateByTwo);
    late_share("world_step_later_than_8ms", "world steps", lateness, kEightMilliseconds,
               kStepsLateByEight);
    limit({.name = "world_step_lateness_max",
           .description = "the latest world step was late by",
           .unit = "ms",
           .measured = ms(lateness.max_ns()),
           .valid_up_to = kLongestValid_ms,
           .degraded_up_to = kLongestDegraded_ms});
    scheduler("world", report.scheduler());
  }

  void agents() {
    share("agent_overruns", "control loops that ended after the next one was due",
          inputs_.agent_overruns, inputs_.agent_loops, kOverruns);
    count("motor_stops", "times that motors stopped, their agent being late:", inputs_.motor_stops,
          HUGE_VAL);
    count("sensors_lost", "UAVs that landed, their readings being late:", inputs_.sensors_lost,
          0.0);
  }

  void canary() {
    if (!inputs_.canary) {
      return;
    }
    late_share("canary_later_than_8ms", "probes seen", inputs_.canary->late, kEightMilliseconds,
               kCanaryLate);
    share("canary_lost", "probes lost", inputs_.canary->lost, inputs_.canary->sent, kCanaryLost);
  }

  void host() {
    limit({.name = "suspended",
           .description = "the host was suspended for",
           .unit = "ms",
           .measured = ms(inputs_.suspended.count()),
           .valid_up_to = kSuspendedAllowed_ms,
           .degraded_up_to = kSuspendedAllowed_ms});
    limit({.name = "supervision_gap",
           .description = "cuscus itself did not run for",
           .unit = "ms",
           .measured = ms(inputs_.longest_supervision_gap.count()),
           .valid_up_to = kSupervisionGap_ms,
           .degraded_up_to = HUGE_VAL});
  }

  void scheduler(const std::string& component, const std::string& obtained) {
    if (inputs_.realtime_wanted && !obtained.starts_with("SCHED_FIFO")) {
      fidelity_.notes.push_back(component + " ran under " +
                                (obtained.empty() ? "an unknown scheduler" : obtained) +
                                " instead of SCHED_FIFO");
    }
  }

  void late_share(const std::string& name, const std::string& what,
                  const proto::DurationSummary& summary, unsigned exponent,
                  const ShareLimits& limits) {
    share(name, fmt::format("{} more than {:.2f} ms late", what, ms(std::int64_t{1} << exponent)),
          count_from(summary, exponent), summary.count(), limits);
  }

  void share(const std::string& name, const std::string& what, std::uint64_t count,
             std::uint64_t so_far, const ShareLimits& limits) {
    const auto of = static_cast<std::uint64_t>(static_cast<double>(so_far) / inputs_.flown_share);
    const double percent = of == 0 ? (count == 0 ? 0.0 : 100.0)
                                   : 100.0 * static_cast<double>(count) / static_cast<double>(of);
    FidelityCheck check{.name = name,
                        .description = what,
                        .unit = "%",
                        .measured = percent,
                        .valid_up_to = limits.valid_percent,
                        .degraded_up_to = limits.degraded_percent};
    if (count > limits.forgiven) {
      // Ten times as many are needed for the worse verdict, as with the shares.
      check.verdict = percent <= limits.valid_percent ? Verdict::kValid
                      : percent <= limits.degraded_percent ||
                              (limits.forgiven > 0 && count <= 10 * limits.forgiven)
                          ? Verdict::kDegraded
                          : Verdict::kInvalid;
    }
    const std::string text = fmt::format("{}: {} of {}{}, {:.3g} %", what, count, of,
                                         of == so_far ? "" : " to be expected", percent);
    add(std::move(check), text);
  }

  /// What should never happen.
  void count(const std::string& name, const std::string& what, std::uint64_t measured,
             double degraded_up_to) {
    limit({.name = name,
           .description = what,
           .unit = "",
           .measured = static_cast<double>(measured),
           .valid_up_to = 0.0,
           .degraded_up_to = degraded_up_to});
  }

  void limit(FidelityCheck check) {
    check.verdict = check.measured <= check.valid_up_to      ? Verdict::kValid
                    : check.measured <= check.degraded_up_to ? Verdict::kDegraded
                                                             : Verdict::kInvalid;
    const std::string text =
        with_unit(fmt::format("{} {:.3g}", check.description, check.measured), check.unit);
    add(std::move(check), text);
  }

  void add(FidelityCheck check, const std::string& text) {
    if (check.verdict != Verdict::kValid) {
      const std::string allowed = with_unit(fmt::format("{:.3g}", check.valid_up_to), check.unit);
      reasons_.emplace_back(check.verdict, fmt::format("{} (valid: up to {})", text, allowed));
    }
    fidelity_.verdict = std::max(fidelity_.verdict, check.verdict);
    fidelity_.checks.push_back(std::move(check));
  }

  const FidelityInputs& inputs_;
  Fidelity fidelity_;
  std::vector<std::pair<Verdict, std::string>> reasons_;
};

}  // namespace

std::string name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kValid:
      return "VALID";
    case Verdict::kDegraded:
      return "DEGRADED";
    case Verdict::kInvalid:
      return "INVALID";
  }
  return {};
}

std::uint64_t count_from(const proto::DurationSummary& summary, unsigned exponent) {
  std::uint64_t binned = 0;
  std::uint64_t later = 0;
  for (int bin = 0; bin < summary.log2_bins_size(); ++bin) {
    binned += summary.log2_bins(bin);
    later += static_cast<unsigned>(bin) >= exponent ? summary.log2_bins(bin) : 0;
  }
  if (binned == summary.count()) {
    return later;
  }
  const std::int64_t bound_ns = std::int64_t{1} << exponent;
  const auto share = [&summary](double fraction) {
    return static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(summary.count())));
  };
  return summary.max_ns() < bound_ns    ? 0
         : summary.p999_ns() < bound_ns ? share(0.001)
         : summary.p99_ns() < bound_ns  ? share(0.01)
         : summary.p50_ns() < bound_ns  ? share(0.5)
                                        : summary.count();
}

Fidelity judge(const FidelityInputs& inputs) { return Judge{inputs}.result(); }

std::optional<std::string> lost_validity(const FidelityInputs& so_far) {
  const Fidelity fidelity = judge(so_far);
  return fidelity.verdict == Verdict::kValid ? std::nullopt
                                             : std::optional{fidelity.reasons.front()};
}

Json to_json(const Fidelity& fidelity, const FidelityInputs& inputs) {
  Json checks = Json::array();
  for (const FidelityCheck& check : fidelity.checks) {
    checks.push_back(
        {{"name", check.name},
         {"description", check.description},
         {"unit", check.unit},
         {"measured", check.measured},
         {"valid_up_to", check.valid_up_to},
         {"degraded_up_to",
          std::isfinite(check.degraded_up_to) ? Json(check.degraded_up_to) : Json(nullptr)},
         {"verdict", name_of(check.verdict)}});
  }
  return {{"verdict", name_of(fidelity.verdict)},
          {"reasons", fidelity.reasons},
          {"notes", fidelity.notes},
          {"checks", checks},
          {"failures", inputs.failures},
          {"radio", inputs.radio ? json_of(*inputs.radio) : Json(nullptr)},
          {"world", inputs.world ? json_of(*inputs.world) : Json(nullptr)},
          {"canary", inputs.canary ? Json{{"sent", inputs.canary->sent},
                                          {"lost", inputs.canary->lost},
                                          {"late", json_of(inputs.canary->late)}}
                                   : Json(nullptr)},
          {"tap_drops", inputs.tap_drops},
          {"backlog_drops", inputs.backlog_drops},
          {"agent_loops", inputs.agent_loops},
          {"agent_overruns", inputs.agent_overruns},
          {"motor_stops", inputs.motor_stops},
          {"sensors_lost", inputs.sensors_lost},
          {"suspended_s", to_seconds(inputs.suspended)},
          {"longest_supervision_gap_s", to_seconds(inputs.longest_supervision_gap)}};
}

std::string verdict_line(const Fidelity& fidelity) {
  std::string line = "fidelity: " + name_of(fidelity.verdict);
  if (!fidelity.reasons.empty()) {
    line += " (" + fidelity.reasons.front() +
            (fidelity.reasons.size() == 1
                 ? ")"
                 : fmt::format("; and {} more in fidelity.json)", fidelity.reasons.size() - 1));
  }
  return line;
}

}  // namespace cuscus::orchestrator
