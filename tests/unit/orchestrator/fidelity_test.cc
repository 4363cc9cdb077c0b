#include "orchestrator/results/fidelity.h"

#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>

namespace cuscus::orchestrator {
namespace {

using namespace std::chrono_literals;

/// Samples by bin; quantiles are not needed where the bins are complete.
proto::DurationSummary durations(std::initializer_list<std::pair<int, std::uint64_t>> bins,
                                 std::int64_t max_ns) {
  proto::DurationSummary summary;
  std::uint64_t count = 0;
  for (int bin = 0; bin < 40; ++bin) {
    summary.add_log2_bins(0);
  }
  for (const auto& [bin, samples] : bins) {
    summary.set_log2_bins(bin, samples);
    count += samples;
  }
  summary.set_count(count);
  summary.set_max_ns(max_ns);
  return summary;
}

// 2^14 ns = 16 us, 2^20 ns = 1.05 ms, 2^22 ns = 4.2 ms, 2^24 ns = 16.8 ms
FidelityInputs good_run() {
  FidelityInputs inputs;
  inputs.radio.emplace();
  inputs.radio->set_send_stamps("tc-bpf");
  inputs.radio->set_scheduler("SCHED_FIFO 60");
  inputs.radio->set_processor(0);
  *inputs.radio->mutable_ingress_delay() = durations({{17, 12'000}}, 200'000);
  *inputs.radio->mutable_release_lateness() = durations({{14, 120'000}}, 30'000);
  inputs.world.emplace();
  inputs.world->set_steps(60'000);
  inputs.world->set_scheduler("SCHED_FIFO 50");
  *inputs.world->mutable_step_lateness() = durations({{14, 60'000}}, 30'000);
  inputs.agent_loops = 120'000;
  return inputs;
}

TEST_CASE("A run in which everything was in time is VALID, without reasons or notes") {
  const Fidelity fidelity = judge(good_run());

  CHECK(fidelity.verdict == Verdict::kValid);
  CHECK(fidelity.reasons.empty());
  CHECK(fidelity.notes.empty());
  CHECK(fidelity.checks.size() >= 10);
  CHECK(verdict_line(fidelity) == "fidelity: VALID");
}

struct Case {
  const char* what;
  std::function<void(FidelityInputs&)> spoil;
  Verdict verdict;
  const char* reason;  ///< Part of the only reason; empty: none.
};

void set_release(FidelityInputs& inputs, const proto::DurationSummary& summary) {
  *inputs.radio->mutable_release_lateness() = summary;
}

void set_steps(FidelityInputs& inputs, const proto::DurationSummary& summary) {
  *inputs.world->mutable_step_lateness() = summary;
}

const std::vector<Case> kCases{
    {"a UAV whose motors stopped once", [](auto& in) { in.motor_stops = 1; }, Verdict::kDegraded,
     "times that motors stopped, their agent being late: 1 (valid: up to 0)"},
    {"a UAV that landed for want of readings", [](auto& in) { in.sensors_lost = 1; },
     Verdict::kInvalid, "UAVs that landed, their readings being late: 1 (valid: up to 0)"},
    {"one stall of 25 ms in a minute",
     [](auto& in) {
       set_release(in, durations({{14, 119'950}, {22, 20}, {24, 30}}, 25'000'000));
       set_steps(in, durations({{14, 59'975}, {22, 9}, {24, 16}}, 25'000'000));
       in.world->set_overruns(25);
     },
     Verdict::kValid, ""},
    {"a stall of 3 ms every second",
     [](auto& in) {
       set_release(in, durations({{14, 119'700}, {20, 240}, {21, 60}}, 3'000'000));
     },
     Verdict::kValid, ""},
    {"half a percent of releases beyond 2 ms",
     [](auto& in) {
       set_release(in, durations({{14, 119'400}, {22, 600}}, 8'000'000));
     },
     Verdict::kDegraded,
     "releases more than 2.10 ms late: 600 of 120000, 0.5 % (valid: up to 0.1 %)"},
    {"two percent of releases beyond 2 ms",
     [](auto& in) {
       set_release(in, durations({{14, 117'600}, {22, 2'400}}, 8'000'000));
     },
     Verdict::kInvalid, "0.1 %"},
    {"five percent of releases beyond 0.5 ms",
     [](auto& in) {
       set_release(in, durations({{14, 114'000}, {20, 6'000}}, 2'000'000));
     },
     Verdict::kDegraded, "releases more than 0.52 ms late: 6000 of 120000, 5 %"},
    {"a fifth of releases beyond 0.5 ms",
     [](auto& in) {
       set_release(in, durations({{14, 96'000}, {20, 24'000}}, 2'000'000));
     },
     Verdict::kInvalid, "valid: up to 1 %"},
    {"one release 60 ms late",
     [](auto& in) {
       set_release(in, durations({{14, 119'999}, {25, 1}}, 60'000'000));
     },
     Verdict::kDegraded, "the latest release was late by 60 ms (valid: up to 50 ms)"},
    {"one release 0.6 s late",
     [](auto& in) {
       set_release(in, durations({{14, 119'999}, {29, 1}}, 600'000'000));
     },
     Verdict::kInvalid, "the latest release was late by 600 ms"},
    {"a short run with three late releases of a hundred",
     [](auto& in) {
       set_release(in, durations({{14, 97}, {22, 3}}, 5'000'000));
     },
     Verdict::kValid, ""},
    {"a short run with twenty late releases of a hundred",
     [](auto& in) {
       set_release(in, durations({{14, 80}, {21, 20}}, 4'000'000));
     },
     Verdict::kDegraded, ""},
    {"clamps below a slot, and one in two thousand of several slots",
     [](auto& in) {
       in.radio->set_clamps(506);
       *in.radio->mutable_clamp() = durations({{13, 500}, {16, 6}}, 100'000);
     },
     Verdict::kValid, ""},
    {"clamps of several slots in one frame of a hundred",
     [](auto& in) {
       in.radio->set_clamps(100);
       *in.radio->mutable_clamp() = durations({{15, 100}}, 60'000);
     },
     Verdict::kDegraded, "more than 16 us after their time: 100 of 12000, 0.833 %"},
    {"clamps of several slots in one frame of fifty",
     [](auto& in) {
       in.radio->set_clamps(240);
       *in.radio->mutable_clamp() = durations({{15, 240}}, 60'000);
     },
     Verdict::kInvalid, "240 of 12000, 2 %"},
    {"one frame lost on a TAP", [](auto& in) { in.tap_drops = 1; }, Verdict::kDegraded,
     "frames lost between the programs and the emulator: 1 of 12000"},
    {"one frame lost in a backlog", [](auto& in) { in.backlog_drops = 1; }, Verdict::kDegraded,
     "frames lost in the kernel's queues behind the emulator: 1 of "},
    {"one frame in a hundred lost on a TAP", [](auto& in) { in.tap_drops = 120; },
     Verdict::kInvalid, "120 of 12000, 1 %"},
    {"frames stamped that never came", [](auto& in) { in.radio->set_lost_before_air(5); },
     Verdict::kDegraded, "5 of 12000"},
    {"stamped frames that a TAP dropped",
     [](auto& in) {
       in.radio->set_lost_before_air(8);
       in.tap_drops = 9;
     },
     Verdict::kDegraded, "9 of 12000"},
    {"frames without a stamp", [](auto& in) { in.radio->set_unstamped(60); }, Verdict::kDegraded,
     "frames without a send stamp: 60 of 12000, 0.5 %"},
    {"world steps that overran now and then", [](auto& in) { in.world->set_overruns(300); },
     Verdict::kValid, ""},
    {"one world step in thirty overran", [](auto& in) { in.world->set_overruns(2'000); },
     Verdict::kDegraded, "world steps that ended after the next one was due: 2000 of 60000"},
    {"one world step in five overran", [](auto& in) { in.world->set_overruns(12'000); },
     Verdict::kInvalid, "20 %"},
    {"two percent of world steps beyond 8 ms",
     [](auto& in) {
       set_steps(in, durations({{14, 58'800}, {23, 1'200}}, 16'000'000));
     },
     Verdict::kInvalid, ""},
    {"agents that overran", [](auto& in) { in.agent_overruns = 6'000; }, Verdict::kDegraded,
     "control loops that ended after the next one was due: 6000 of 120000, 5 %"},
    {"no report from netsim", [](auto& in) { in.radio.reset(); }, Verdict::kInvalid,
     "netsim gave no report"},
    {"no report from the world", [](auto& in) { in.world.reset(); }, Verdict::kInvalid,
     "world gave no report"},
    {"a component that died",
     [](auto& in) { in.failures.emplace_back("netsim: killed by signal 9"); }, Verdict::kInvalid,
     "netsim: killed by signal 9"},
    {"a host that was suspended", [](auto& in) { in.suspended = 3s; }, Verdict::kInvalid,
     "the host was suspended for 3e+03 ms"},
    {"a stopped orchestrator", [](auto& in) { in.longest_supervision_gap = 10s; },
     Verdict::kDegraded, "cuscus itself did not run for"},
    {"a canary that was late about once in a hundred times",
     [](auto& in) {
       in.canary = {
           .sent = 1'237, .lost = 1, .late = durations({{17, 1'224}, {24, 12}}, 20'000'000)};
     },
     Verdict::kValid, ""},
    {"a canary that was seen late once in twenty times",
     [](auto& in) {
       in.canary = {
           .sent = 1'200, .lost = 0, .late = durations({{17, 1'140}, {24, 60}}, 20'000'000)};
     },
     Verdict::kDegraded, "probes seen more than 8.39 ms late: 60 of 1200, 5 % (valid: up to 1 %)"},
    {"a canary that is lost",
     [](auto& in) {
       in.canary = {.sent = 100, .lost = 20, .late = durations({{17, 80}}, 200'000)};
     },
     Verdict::kInvalid, "probes lost: 20 of 100, 20 %"},
    {"a run in which nothing was sent",
     [](auto& in) {
       set_release(in, {});
       in.radio->mutable_ingress_delay()->Clear();
     },
     Verdict::kValid, ""},
};

TEST_CASE("The verdict follows the limits, and each reason has number, unit and limit") {
  for (const Case& spoiled : kCases) {
    CAPTURE(spoiled.what);
    FidelityInputs inputs = good_run();
    spoiled.spoil(inputs);

    const Fidelity fidelity = judge(inputs);

    CAPTURE(fidelity.reasons);
    CHECK(name_of(fidelity.verdict) == name_of(spoiled.verdict));
    CHECK(fidelity.reasons.empty() == (spoiled.verdict == Verdict::kValid));
    if (!fidelity.reasons.empty()) {
      CHECK_THAT(fidelity.reasons.front(), Catch::Contains(spoiled.reason));
      CHECK_THAT(verdict_line(fidelity), Catch::Contains(fidelity.reasons.front()));
    }
  }
}

TEST_CASE("A run has lost its validity when nothing more needs to be late for that") {
  FidelityInputs inputs = good_run();
  // A stall of 30 ms, 2 s after the start of a run of a minute.
  *inputs.world->mutable_step_lateness() = durations({{14, 1'970}, {22, 9}, {24, 21}}, 30'000'000);
  inputs.world->set_steps(2'000);
  CHECK(judge(inputs).verdict != Verdict::kValid);

  inputs.flown_share = 2.0 / 60.0;
  CHECK_FALSE(lost_validity(inputs));

  SECTION("stalls that are too many even for the whole run") {
    // Of 60 000 steps 300 may be 2 ms late.
    *inputs.world->mutable_step_lateness() = durations({{14, 1'680}, {22, 320}}, 5'000'000);
    CHECK_THAT(lost_validity(inputs).value(),
               Catch::Contains("2.10 ms late: 320 of 60000 to be expected, 0.533 %"));
  }
  SECTION("one that is too long in any run") {
    inputs.world->mutable_step_lateness()->set_max_ns(60'000'000);
    CHECK_THAT(lost_validity(inputs).value(),
               Catch::Contains("the latest world step was late by 60 ms"));
  }
}

TEST_CASE("What a host did not grant is noted, and only the figures count") {
  FidelityInputs inputs = good_run();
  inputs.radio->set_scheduler("SCHED_OTHER");
  inputs.radio->set_send_stamps("read");
  inputs.radio->clear_processor();

  const Fidelity fidelity = judge(inputs);

  CHECK(fidelity.verdict == Verdict::kValid);
  REQUIRE(fidelity.notes.size() == 3);
  CHECK_THAT(fidelity.notes[0], Catch::Contains("no BPF"));
  CHECK(fidelity.notes[1] == "netsim ran under SCHED_OTHER instead of SCHED_FIFO");
  CHECK_THAT(fidelity.notes[2], Catch::Contains("no processor for itself"));

  inputs.realtime_wanted = false;
  CHECK(judge(inputs).notes.size() == 1);
}

TEST_CASE("A frame log that lacks frames is noted") {
  FidelityInputs inputs = good_run();
  inputs.radio->set_frames_not_logged(3);

  const Fidelity fidelity = judge(inputs);

  CHECK(fidelity.verdict == Verdict::kValid);
  CHECK(fidelity.notes == std::vector<std::string>{"the frame log lacks 3 frames"});
}

TEST_CASE("A reception log that lacks records is noted") {
  FidelityInputs inputs = good_run();
  inputs.radio->set_receptions_not_logged(2);

  const Fidelity fidelity = judge(inputs);

  CHECK(fidelity.verdict == Verdict::kValid);
  CHECK(fidelity.notes == std::vector<std::string>{"the reception log lacks 2 records"});
}

TEST_CASE("Captures that lack packets are noted") {
  FidelityInputs inputs = good_run();
  inputs.radio->set_packets_not_captured(12);

  const Fidelity fidelity = judge(inputs);

  CHECK(fidelity.verdict == Verdict::kValid);
  CHECK(fidelity.notes == std::vector<std::string>{"the captures lack 12 packets"});
}

TEST_CASE("Stamps taken on reading make a long ingress delay count") {
  FidelityInputs inputs = good_run();
  *inputs.radio->mutable_ingress_delay() = durations({{17, 11'900}, {22, 100}}, 8'000'000);
  CHECK(judge(inputs).verdict == Verdict::kValid);  // the kernel's stamps know better

  inputs.radio->set_send_stamps("read");

  CHECK(judge(inputs).verdict == Verdict::kDegraded);
}

TEST_CASE("Late samples are counted by bins, or at their most by quantiles") {
  const auto binned = durations({{20, 7}, {21, 5}, {30, 2}}, 1'500'000'000);
  CHECK(count_from(binned, 20) == 14);
  CHECK(count_from(binned, 21) == 7);
  CHECK(count_from(binned, 31) == 0);

  proto::DurationSummary quantiles;
  quantiles.set_count(10'000);
  quantiles.set_p50_ns(10'000);
  quantiles.set_p99_ns(100'000);
  quantiles.set_p999_ns(3'000'000);
  quantiles.set_max_ns(9'000'000);
  CHECK(count_from(quantiles, 24) == 0);       // 16.8 ms
  CHECK(count_from(quantiles, 22) == 10);      // 4.2 ms: above p99.9
  CHECK(count_from(quantiles, 21) == 100);     // 2.1 ms: above p99
  CHECK(count_from(quantiles, 15) == 5'000);   // 33 us: above p50
  CHECK(count_from(quantiles, 10) == 10'000);  // 1 us
}

TEST_CASE("fidelity.json has the verdict, every limit and the raw reports") {
  const FidelityInputs inputs = good_run();

  const auto json = to_json(judge(inputs), inputs);

  CHECK(json.at("verdict") == "VALID");
  CHECK(json.at("reasons").empty());
  for (const auto& check : json.at("checks")) {
    CHECK(check.contains("valid_up_to"));
    CHECK(check.contains("degraded_up_to"));
    CHECK(check.at("measured").is_number());
  }
  CHECK(json.at("radio").at("release_lateness").at("count") == 120'000);
  CHECK(json.at("world").at("steps") == 60'000);
  CHECK(json.at("canary").is_null());

  FidelityInputs nothing;
  CHECK(to_json(judge(nothing), nothing).at("radio").is_null());
}

}  // namespace
}  // namespace cuscus::orchestrator
