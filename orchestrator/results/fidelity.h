#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/units/sim_time.h"
#include "proto/report.pb.h"

namespace cuscus::orchestrator {

/// Whether the host kept up, so that the results mean what they say.
enum class Verdict { kValid, kDegraded, kInvalid };

/// "VALID", "DEGRADED", "INVALID"
[[nodiscard]] std::string name_of(Verdict verdict);

/// What the hidden pair of probes has seen: datagrams that were sent, lost, and seen so much later
/// than their link's delay.
struct CanarySight {
  std::uint64_t sent{};
  std::uint64_t lost{};
  proto::DurationSummary late;
};

/// What is known of a run at its end.
struct FidelityInputs {
  std::optional<proto::RadioReport> radio;  ///< Nothing: netsim gave none.
  std::optional<proto::WorldReport> world;
  std::optional<CanarySight> canary;  ///< Nothing: it has not been looked at yet.
  /// What ended that should not have, in words: "netsim: killed by signal 9". Programs whose
  /// on_exit is "fail" are here too.
  std::vector<std::string> failures;
  /// Frames that the interfaces dropped on their way to or from the emulator.
  std::uint64_t tap_drops{0};
  /// Frames that the kernel's queues of received frames had no room for.
  std::uint64_t backlog_drops{0};
  std::uint64_t agent_loops{0};  ///< Of all agents together.
  std::uint64_t agent_overruns{0};
  std::uint64_t motor_stops{0};   ///< For want of a command from one of our agents, in time.
  std::uint64_t sensors_lost{0};  ///< Our agents that have landed for want of readings.
  /// Growth of CLOCK_BOOTTIME - CLOCK_MONOTONIC: the time for which the host was suspended.
  SimClock::duration suspended{};
  /// Longest time for which `cuscus` itself did not run.
  SimClock::duration longest_supervision_gap{};
  bool realtime_wanted{true};
  /// Of the planned flight, what is over. Below 1 the verdict is on what the run can still become:
  /// shares are those of all samples to be expected, as if nothing more were to be late.
  double flown_share{1.0};
};

/// One measure held against its two limits.
struct FidelityCheck {
  std::string name;         ///< Stable key: "release_later_than_2ms".
  std::string description;  ///< "releases more than 2.10 ms late"
  std::string unit;         ///< "%", "ms", ""
  double measured{};
  double valid_up_to{};
  double degraded_up_to{};
  Verdict verdict{Verdict::kValid};
};

struct Fidelity {
  Verdict verdict{Verdict::kValid};
  /// Why it is not VALID, each with number, unit and limit; the worst first.
  std::vector<std::string> reasons;
  std::vector<std::string> notes;  ///< What a reader should know beside the verdict.
  std::vector<FidelityCheck> checks;
};

/// The verdict. docs/fidelity.md explains each limit.
[[nodiscard]] Fidelity judge(const FidelityInputs& inputs);

/// Why a run of which this is known so far cannot be VALID in the end; nothing while it can.
[[nodiscard]] std::optional<std::string> lost_validity(const FidelityInputs& so_far);

/// Content of fidelity.json: verdict, reasons, every check with its limits, the raw reports.
[[nodiscard]] nlohmann::ordered_json to_json(const Fidelity& fidelity,
                                             const FidelityInputs& inputs);

/// Last line of a run: "fidelity: DEGRADED (0.3 % of releases more than 2.10 ms late; valid: up to
/// 0.1 %)".
[[nodiscard]] std::string verdict_line(const Fidelity& fidelity);

/// Samples of `summary` of at least 2^`exponent` ns: from the bins, or, without bins, the most that
/// the quantiles allow.
[[nodiscard]] std::uint64_t count_from(const proto::DurationSummary& summary, unsigned exponent);

}  // namespace cuscus::orchestrator
