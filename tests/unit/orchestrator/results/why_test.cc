#include "orchestrator/results/why.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace cuscus::orchestrator {
namespace {

using logs::Cause;
using logs::ReceptionLogRecord;
using logs::RecordKind;

const std::vector<std::string> kNames{"uav0", "uav1", "gcs"};

SimTime at_us(std::int64_t us) { return SimTime{std::chrono::microseconds{us}}; }

/// A reception of frame `frame` from uav0 at uav1.
ReceptionLogRecord reception(std::uint64_t frame, std::int64_t begins_us, Cause cause) {
  ReceptionLogRecord record{};
  record.begins_ns = begins_us * 1'000;
  record.over_ns = record.begins_ns + 202'000;
  record.frame = frame;
  record.sender = 0;
  record.receiver = 1;
  record.destination = 1;
  record.interferer = logs::kNoInterferer;
  record.psdu_bytes = 128;
  record.rate_kbps = 6'000;
  record.attempt = 1;
  record.kind = RecordKind::kReception;
  record.cause = cause;
  record.power_dbm = -60.0F;
  record.sinr_db = 12.25F;
  record.budget = {.tx_power_dbm = 16.0F,
                   .tx_antenna_db = 1.0F,
                   .rx_antenna_db = 2.0F,
                   .basic_loss_db = 75.0F,
                   .obstacle_loss_db = 0.0F,
                   .foliage_loss_db = 0.0F,
                   .shadowing_loss_db = 5.0F,
                   .fading_loss_db = -1.0F};
  return record;
}

ReceptionLogRecord given_up(std::uint64_t frame, std::int64_t sent_us, std::int32_t destination,
                            Cause cause) {
  ReceptionLogRecord record{};
  record.begins_ns = sent_us * 1'000;
  record.frame = frame;
  record.destination = destination;
  record.interferer = logs::kNoInterferer;
  record.psdu_bytes = 128;
  record.kind = RecordKind::kGivenUp;
  record.cause = cause;
  return record;
}

/// A log file of these records that goes with this object.
struct LogFile {
  explicit LogFile(const std::vector<ReceptionLogRecord>& records, std::string names = {}) {
    std::string folder = (std::filesystem::temp_directory_path() / "why-XXXXXX").string();
    REQUIRE(::mkdtemp(folder.data()) != nullptr);
    path = std::filesystem::path{folder} / "receptions.bin";
    if (names.empty()) {
      for (const auto& name : kNames) {
        names += name + '\0';
      }
    }
    const logs::ReceptionLogHeader header{.magic = logs::ReceptionLogHeader::kMagic,
                                          .version = logs::ReceptionLogHeader::kVersion,
                                          .record_bytes = sizeof(ReceptionLogRecord),
                                          .node_count = static_cast<std::uint32_t>(kNames.size()),
                                          .name_bytes = static_cast<std::uint32_t>(names.size())};
    std::ofstream file{path, std::ios::binary};
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file << names;
    file.write(reinterpret_cast<const char*>(records.data()),
               static_cast<std::streamsize>(records.size() * sizeof records[0]));
    file << "a record that was cut";
  }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  ~LogFile() { std::filesystem::remove_all(path.parent_path()); }

  std::filesystem::path path;
};

std::vector<ReceptionLogRecord> asked(const std::vector<ReceptionLogRecord>& records) {
  const LogFile file{records};
  ReceptionLogReader log{file.path};
  return frames_of(log, {.sender = 0, .receiver = 1, .from = at_us(1'000), .to = at_us(2'000)});
}

TEST_CASE("only what one node sent towards the other in the window is listed, in order of time") {
  auto to_others = reception(4, 1'300, Cause::kReceived);
  to_others.receiver = 2;
  auto from_others = reception(5, 1'300, Cause::kReceived);
  from_others.sender = 2;

  const auto found =
      asked({reception(1, 999, Cause::kReceived), reception(3, 1'999, Cause::kNoise),
             reception(2, 1'000, Cause::kReceived), reception(6, 2'000, Cause::kReceived),
             to_others, from_others, given_up(7, 1'500, 1, Cause::kLifetime),
             given_up(8, 1'600, logs::kToGroup, Cause::kQueueFull),
             given_up(9, 1'700, 2, Cause::kQueueFull)});

  std::vector<std::uint64_t> frames;
  for (const auto& record : found) {
    frames.push_back(record.frame);
  }
  CHECK(frames == std::vector<std::uint64_t>{2, 7, 8, 3});
}

TEST_CASE("a copy that did not get into the interface is why its frame was lost") {
  auto elsewhere = reception(1, 0, Cause::kLate);
  elsewhere.kind = RecordKind::kCopyLost;
  elsewhere.receiver = 2;
  auto here = reception(2, 0, Cause::kLinkDown);
  here.kind = RecordKind::kCopyLost;

  const auto found = asked({reception(1, 1'100, Cause::kReceived),
                            reception(2, 1'200, Cause::kReceived), elsewhere, here});

  REQUIRE(found.size() == 2);
  CHECK(found[0].cause == Cause::kReceived);
  CHECK(found[1].cause == Cause::kLinkDown);
}

TEST_CASE("the table names the collider and shows the budget term by term") {
  auto collided = reception(1, 12'300'123, Cause::kCollision);
  collided.interferer = 2;

  const std::string table = why_table(
      std::vector{collided, given_up(2, 12'300'200, logs::kToGroup, Cause::kQueueFull)}, kNames);

  CHECK_THAT(table, Catch::Contains("12.300123 s  data  uav1           128  6.0 Mb/s    1  "
                                    "lost: collision with gcs\n"));
  CHECK_THAT(table, Catch::Contains("-60.00 dBm = 16.00 sent +1.00 +2.00 antennas -75.00 path "
                                    "-0.00 obstacles -5.00 shadowing +1.00 fading; SINR 12.25 dB"));
  CHECK_THAT(table, Catch::Contains("(group)") && Catch::Contains("not sent: the queue was full"));
}

TEST_CASE("leaves on the way have a term of their own") {
  auto leafy = reception(1, 1'500, Cause::kNoise);
  leafy.budget.obstacle_loss_db = 6.25F;
  leafy.budget.foliage_loss_db = 12.5F;

  CHECK_THAT(why_table(std::vector{leafy}, kNames),
             Catch::Contains("path -6.25 obstacles -12.50 foliage -5.00 shadowing"));
  CHECK_THAT(why_csv(std::vector{leafy}, kNames),
             Catch::Contains("obstacle_loss_db,foliage_loss_db,shadowing_loss_db,") &&
                 Catch::Contains("75.0000,6.2500,12.5000,5.0000,-1.0000\n"));
}

TEST_CASE("CSV has a field per column, empty where there is nothing to say") {
  auto busy = reception(1, 1'500, Cause::kHalfDuplex);
  busy.sinr_db = std::numeric_limits<float>::quiet_NaN();

  const std::string csv =
      why_csv(std::vector{busy, given_up(2, 1'600, 1, Cause::kRetryLimit)}, kNames);

  CHECK_THAT(csv, Catch::Contains("0.001500000,1,data,uav1,128,6000,1,half_duplex,,,-60.0000,"
                                  "16.0000,1.0000,2.0000,75.0000,0.0000,0.0000,5.0000,-1.0000\n"));
  CHECK_THAT(csv, Catch::Contains("0.001600000,2,data,uav1,128,,0,retry_limit,,,,,,,,,,,\n"));
  // Three lines of 19 fields.
  CHECK(std::count(csv.begin(), csv.end(), ',') == 3 * 18);
}

TEST_CASE("what is no reception log is refused with its name") {
  const LogFile torn{{}, "uav0"};
  CHECK_THROWS_WITH(ReceptionLogReader{torn.path},
                    Catch::Contains(torn.path.string()) && Catch::Contains("names"));
  CHECK_THROWS_WITH(ReceptionLogReader{"/dev/null"}, Catch::Contains("is no reception log"));
}

TEST_CASE("records that cannot be are passed over") {
  auto wild = reception(1, 1'100, Cause::kReceived);
  wild.interferer = 3;

  CHECK(asked({wild, reception(2, 1'200, Cause::kReceived)}).size() == 1);
}

}  // namespace
}  // namespace cuscus::orchestrator
