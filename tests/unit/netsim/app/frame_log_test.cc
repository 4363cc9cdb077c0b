#include "netsim/app/frame_log.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "common/posix/check.h"
#include "netsim/app/replay.h"

namespace cuscus::netsim {
namespace {

/// A file that is gone with its scope.
class ScratchFile {
 public:
  ScratchFile() : fd{posix::check("mkostemp", ::mkostemp(path.data(), O_CLOEXEC))} {}
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ScratchFile(ScratchFile&&) = delete;
  ScratchFile& operator=(ScratchFile&&) = delete;
  ~ScratchFile() { ::unlink(path.c_str()); }

  std::string path{"/tmp/cuscus-frame-log-XXXXXX"};
  posix::UniqueFd fd;
};

FrameRecord record(std::int64_t sent_ns, std::uint32_t node, std::int32_t destination) {
  return {.sent_ns = sent_ns,
          .node = node,
          .destination = destination,
          .frame_bytes = 142,
          .attempts = 1,
          .outcome = destination == kGroup ? SendOutcome::kSent : SendOutcome::kAcknowledged,
          .deliveries = destination == kGroup ? 2U : 1U,
          .first_delivery_ns = sent_ns + 252'000};
}

TEST_CASE("a frame log is read back as it was written, in the order of the sends") {
  ScratchFile file;
  AirParameters parameters;
  parameters.nodes.assign(3, AirNode{});
  parameters.group_rate_kbps = 12'000;
  parameters.detection_minimum = {-std::numeric_limits<double>::infinity()};
  parameters.basic_rates_kbps = {6'000, 24'000};
  parameters.sensitivity = {-98.5};
  parameters.error_model = "yans";
  parameters.seed = 77;
  parameters.slot = std::chrono::microseconds{9};
  parameters.control_answer = ControlAnswerRule::kAnyClass;
  parameters.dsss_preamble = DsssPreamble::kShort;
  parameters.long_retry_limit = 4;
  parameters.rate_control = "minstrel";
  parameters.mac = "tdma";
  parameters.tdma = {
      .slot = Duration{3'000'000}, .guard = Duration{7'000}, .frame = {2, kNobody, 0}};
  parameters.edca = {{7, 15, 1023}, {3, 15, 1023}, {2, 7, 15}, {2, 3, 7}};
  parameters.ideal = {.delay = Duration{5}, .jitter = Duration{4}, .loss = 0.5, .range_m = 99.5};
  parameters.channel.fading = "rice";
  parameters.antenna = {.model = "pattern", .pattern_dbi = {1.25, -2.0}, .pattern_azimuths = 1};
  parameters.disruption = {.fraction = 0.4, .phase = DisruptionPhase::kRandom, .seed = 77};
  parameters.channel.outer_wall = {11.5};
  parameters.channel.inner_wall = {4.5};
  parameters.channel.obstacles = {
      {.shape = {.centre_m = {1.5, -2.0}, .size_m = {10.0, 20.0, 30.0}, .heading_rad = 0.25},
       .outer_wall = {13.0},
       .inner_spacing_m = 4.0,
       .inner_wall = {6.0}},
      {.shape = {.centre_m = {7.0, 8.0}, .size_m = {1.0, 2.0, 3.0}}}};
  parameters.jammers = {{.p_WJ = {1.0, 2.0, 3.0},
                         .power = {33.0},
                         .band = {.centre_hz = 2.44e9, .width_hz = 5e6},
                         .duty = 0.3,
                         .period = Duration{1'234'567},
                         .start = Duration{1'000'000'001},
                         .stop = Duration{2'000'000'003}},
                        {}};
  parameters.channel.k_factor = {3.5};
  parameters.channel.polarisation = Polarisation::kHorizontal;
  parameters.rts_threshold_bytes = 500;
  parameters.channel.model = "paper-eq1";
  parameters.channel.carrier_hz = 2.437e9;
  parameters.channel.alpha = 26.5;
  parameters.channel.chi_db2 = 3.5;
  parameters.nodes[1] = {.tx_power = {20.5}, .antenna_gain = {2.15}};

  {
    FrameLog log{std::move(file.fd), parameters};
    FrameRecord urgent = record(5'000'000, 2, 0);
    urgent.priority = 6;
    log.add(urgent);
    log.add(record(1'000'000, 0, kGroup));
    log.add(record(2'000'000, 1, kNobody));
    CHECK(log.finish() == 0);
  }
  const ReplayLog log = read_replay_log(file.path, "");

  CHECK(log.air.nodes.size() == 3);
  CHECK(log.air.group_rate_kbps == 12'000);
  CHECK(log.air.detection_minimum == parameters.detection_minimum);
  CHECK(log.air.basic_rates_kbps == parameters.basic_rates_kbps);
  CHECK(log.air.sensitivity == parameters.sensitivity);
  CHECK(log.air.error_model == "yans");
  CHECK(log.air.seed == 77);
  CHECK(log.air.slot == parameters.slot);
  CHECK(log.air.control_answer == ControlAnswerRule::kAnyClass);
  CHECK(log.air.dsss_preamble == DsssPreamble::kShort);
  CHECK(log.air.long_retry_limit == 4);
  CHECK(log.air.rate_control == "minstrel");
  CHECK(log.air.mac == "tdma");
  CHECK(log.air.tdma.slot == parameters.tdma.slot);
  CHECK(log.air.tdma.guard == parameters.tdma.guard);
  CHECK(log.air.tdma.frame == parameters.tdma.frame);
  CHECK(log.air.edca == parameters.edca);
  CHECK(log.air.ideal.delay == Duration{5});
  CHECK(log.air.ideal.jitter == Duration{4});
  CHECK(log.air.ideal.loss == 0.5);
  CHECK(log.air.ideal.range_m == 99.5);
  CHECK(log.air.channel.fading == "rice");
  CHECK(log.air.antenna.model == "pattern");
  CHECK(log.air.antenna.pattern_dbi == std::vector<double>{1.25, -2.0});
  CHECK(log.air.antenna.pattern_azimuths == 1);
  CHECK(log.air.disruption.fraction == 0.4);
  CHECK(log.air.disruption.phase == DisruptionPhase::kRandom);
  CHECK(log.air.disruption.seed == 77);
  CHECK(log.air.channel.outer_wall.value == 11.5);
  CHECK(log.air.channel.inner_wall.value == 4.5);
  REQUIRE(log.air.channel.obstacles.size() == 2);
  const BoxObstacle& box = log.air.channel.obstacles[0];
  CHECK(box.shape.centre_m == Eigen::Vector2d{1.5, -2.0});
  CHECK(box.shape.size_m == Eigen::Vector3d{10.0, 20.0, 30.0});
  CHECK(box.shape.heading_rad == 0.25);
  CHECK(box.outer_wall.value == 13.0);
  CHECK(box.inner_spacing_m == 4.0);
  CHECK(box.inner_wall.value == 6.0);
  CHECK(log.air.channel.obstacles[1].shape.centre_m.y() == 8.0);
  REQUIRE(log.air.jammers.size() == 2);
  const JammerParameters& jammer = log.air.jammers[0];
  CHECK(jammer.p_WJ == Eigen::Vector3d{1.0, 2.0, 3.0});
  CHECK(jammer.power.value == 33.0);
  CHECK(jammer.band.centre_hz == 2.44e9);
  CHECK(jammer.band.width_hz == 5e6);
  CHECK(jammer.duty == 0.3);
  CHECK(jammer.period == Duration{1'234'567});
  CHECK(jammer.start == Duration{1'000'000'001});
  CHECK(jammer.stop == Duration{2'000'000'003});
  CHECK(log.air.jammers[1].stop == Duration::max());
  CHECK(log.air.channel.k_factor == parameters.channel.k_factor);
  CHECK(log.air.channel.k_factor_overhead == parameters.channel.k_factor_overhead);
  CHECK(log.air.channel.polarisation == Polarisation::kHorizontal);
  CHECK(log.air.rts_threshold_bytes == 500);
  CHECK(log.air.channel.model == "paper-eq1");
  CHECK(log.air.channel.carrier_hz == parameters.channel.carrier_hz);
  CHECK(log.air.channel.alpha == parameters.channel.alpha);
  CHECK(log.air.channel.chi_db2 == parameters.channel.chi_db2);
  CHECK(log.air.nodes[0].tx_power == AirNode{}.tx_power);
  CHECK(log.air.nodes[1].tx_power == parameters.nodes[1].tx_power);
  CHECK(log.air.nodes[1].antenna_gain == parameters.nodes[1].antenna_gain);
  REQUIRE(log.frames.size() == 3);
  CHECK(log.frames[0].sent_ns == 1'000'000);
  CHECK(log.frames[0].destination == kGroup);
  CHECK(log.frames[0].deliveries == 2);
  CHECK(log.frames[1].destination == kNobody);
  CHECK(log.frames[2].destination == 0);
  CHECK(log.frames[2].priority == 6);
  CHECK(log.frames[2].outcome == SendOutcome::kAcknowledged);
  CHECK(log.frames[2].first_delivery_ns == 5'252'000);
}

TEST_CASE("a replay of sends that do not meet delivers what an idle air delivers") {
  ReplayLog log;
  log.air.nodes.assign(3, AirNode{});
  for (int i = 0; i < 100; ++i) {
    log.frames.push_back(
        record(std::int64_t{10'000'000} * i, static_cast<std::uint32_t>(i % 3), kGroup));
  }

  const ReplayResult result = replay(log, DecibelMilliwatt{-50.0});

  CHECK(result.group.live.deliveries == 200);
  CHECK(result.group.simulated.deliveries == 200);
  // 142 B of Ethernet are 164 B of PSDU: DIFS and 250 us.
  CHECK(result.group.simulated.delay_sum_us == Approx(100 * 300.0));
}

TEST_CASE("a replay with positions loses what was out of reach") {
  ReplayLog log;
  log.air.nodes.assign(2, AirNode{});
  log.frames = {record(1'000'000, 0, kGroup), record(3'000'000'000, 0, kGroup)};
  log.positions = {{.time_ns = 0, .node = 0, .p_WN = {0, 0, 10}},
                   {.time_ns = 0, .node = 1, .p_WN = {50, 0, 10}},
                   {.time_ns = 2'000'000'000, .node = 1, .p_WN = {5'000, 0, 10}}};

  const ReplayResult result = replay(log, DecibelMilliwatt{-50.0});

  CHECK(result.group.simulated.deliveries == 1);
  CHECK(result.tallies[1].lost_below_detection == 1);
}

TEST_CASE("a replay lists its receptions with the frames' places in the log") {
  ReplayLog log;
  log.air.nodes.assign(3, AirNode{});
  log.frames = {record(1'000'000, 2, kGroup), record(20'000'000, 1, 0)};
  std::ostringstream receptions;

  static_cast<void>(replay(log, DecibelMilliwatt{-50.0}, &receptions));

  // DIFS and 250 us each, as above; all nodes are in one place.
  CHECK(receptions.str() ==
        "frame,sender,sent_ns,receiver,delivery_ns\n"
        "0,2,1000000,0,1300000\n"
        "0,2,1000000,1,1300000\n"
        "1,1,20000000,0,20300000\n");
}

TEST_CASE("a replay uses the powers and the channel that the log names") {
  ReplayLog log;
  log.air.nodes.assign(2, AirNode{});
  log.frames = {record(1'000'000, 0, kGroup)};
  log.positions = {{.time_ns = 0, .node = 0, .p_WN = {0, 0, 10}},
                   {.time_ns = 0, .node = 1, .p_WN = {50, 0, 10}}};
  CHECK(replay(log, DecibelMilliwatt{-50.0}).group.simulated.deliveries == 1);

  SECTION("a transmitter that is too weak") { log.air.nodes[0].tx_power = {-40.0}; }
  SECTION("a loss that is too high") {
    log.air.channel.model = "log-distance";
    log.air.channel.exponent = 5.0;
  }

  CHECK(replay(log, DecibelMilliwatt{-50.0}).group.simulated.deliveries == 0);
}

TEST_CASE("a header line that cannot be read is refused with file, line and key") {
  ScratchFile file;
  std::ofstream{file.path} << "# nodes=2\n# tx_power_dbm=16 16 16\n";

  CHECK_THROWS_WITH(read_replay_log(file.path, ""),
                    Catch::Contains(file.path + ":2: 'tx_power_dbm' cannot be '16 16 16'"));
}

TEST_CASE("a last line that was cut is left out") {
  ScratchFile file;
  std::ofstream{file.path} << "# nodes=2\n1,0,group,100,1,sent,1,2\n5,1,group,100,1,sen";

  CHECK(read_replay_log(file.path, "").frames.size() == 1);
}

TEST_CASE("records that the disk does not take are counted") {
  AirParameters parameters;
  // A pipe whose reader leaves when the header has passed.
  std::array<int, 2> ends{};
  posix::check("pipe2", ::pipe2(ends.data(), O_CLOEXEC));
  posix::UniqueFd reader{ends[0]};
  ::signal(SIGPIPE, SIG_IGN);
  FrameLog log{posix::UniqueFd{ends[1]}, parameters};
  reader = {};

  log.add(record(1'000'000, 0, kGroup));
  log.add(record(2'000'000, 1, kGroup));

  CHECK(log.finish() == 2);
}

TEST_CASE("a line that is no record is refused with file and line") {
  ScratchFile file;
  std::ofstream{file.path} << "# nodes=2\n1,0,group,100,1,sent,1,2\n1,7,group,100,1,sent,1,2\n";

  CHECK_THROWS_WITH(read_replay_log(file.path, ""),
                    Catch::Contains(file.path + ":3: not a frame record of a 2-node log"));
  CHECK_FALSE(parse_frame_record("1,0,group,100,1,unheard-of,1,2"));
  CHECK_FALSE(parse_frame_record("1,0,group,100,1,sent,1"));
  CHECK_FALSE(parse_frame_record("1,0,group,100,1,sent,1,2,8"));
  CHECK_FALSE(parse_frame_record("1,0,group,100,1,sent,1,2,3,4"));
}

TEST_CASE("a line from before there were priorities has priority 0") {
  CHECK(parse_frame_record("1,0,group,100,1,sent,1,2").value().priority == 0);
}

}  // namespace
}  // namespace cuscus::netsim
