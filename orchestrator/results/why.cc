#include "orchestrator/results/why.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <unordered_map>

namespace cuscus::orchestrator {
namespace {

using logs::Cause;
using logs::PpduKind;
using logs::ReceptionLogRecord;
using logs::RecordKind;

constexpr double kNanosecond_s = 1e-9;

bool is_asked_for(const ReceptionLogRecord& record, const WhyQuestion& question) {
  const bool towards_it =
      record.kind == RecordKind::kGivenUp
          ? record.destination == logs::kToGroup ||
                record.destination == static_cast<std::int32_t>(question.receiver)
          : record.receiver == question.receiver;
  return record.sender == question.sender && towards_it &&
         record.begins_ns >= to_ns(question.from) && record.begins_ns < to_ns(question.to);
}

std::string_view name_of(PpduKind kind) {
  switch (kind) {
    case PpduKind::kAck:
      return "ack";
    case PpduKind::kRts:
      return "rts";
    case PpduKind::kCts:
      return "cts";
    case PpduKind::kData:
      break;
  }
  return "data";
}

struct CauseText {
  Cause cause;
  std::string_view name;  ///< In CSV.
  std::string_view text;  ///< {with} and {to} are the interferer and the receiver.
};

constexpr std::array kCauses{
    CauseText{Cause::kReceived, "received", "received"},
    CauseText{Cause::kBelowFloor, "below_floor", "lost: below the floor of the receiver"},
    CauseText{Cause::kBelowDetection, "below_detection",
              "lost: too weak for its preamble to be detected"},
    CauseText{Cause::kNoise, "noise", "lost: not decoded in the noise"},
    CauseText{Cause::kCollision, "collision", "lost: collision with {with}"},
    CauseText{Cause::kInterference, "interference", "lost: interference from {with}"},
    CauseText{Cause::kHalfDuplex, "half_duplex", "lost: {to} was transmitting"},
    CauseText{Cause::kJammed, "jammed", "lost: jammed"},
    CauseText{Cause::kLinkDown, "link_down", "lost: the interface of {to} was down or full"},
    CauseText{Cause::kLate, "late", "lost: the emulator was more than 1 s late"},
    CauseText{Cause::kNeverCame, "never_came", "lost: its bytes never came out of the interface"},
    CauseText{Cause::kQueueFull, "queue_full", "not sent: the queue was full"},
    CauseText{Cause::kLifetime, "lifetime", "not sent: it waited too long in the queue"},
    CauseText{Cause::kRetryLimit, "retry_limit", "given up: no answer to the last attempt"},
    CauseText{Cause::kTooLong, "too_long", "not sent: longer than a slot"},
};

CauseText text_of(Cause cause) {
  const auto* const found = std::find_if(
      kCauses.begin(), kCauses.end(), [&](const CauseText& text) { return text.cause == cause; });
  return found != kCauses.end() ? *found : CauseText{cause, "unknown", "unknown"};
}

std::string interferer_of(const ReceptionLogRecord& record, std::span<const std::string> names) {
  return record.interferer == logs::kNoInterferer ? std::string{} : names[record.interferer];
}

std::string destination_of(const ReceptionLogRecord& record, std::span<const std::string> names) {
  return record.destination == logs::kToGroup ? "(group)"
         : record.destination == logs::kToNobody
             ? "(nobody)"
             : names[static_cast<std::size_t>(record.destination)];
}

std::string fate_of(const ReceptionLogRecord& record, std::span<const std::string> names) {
  std::string other = interferer_of(record, names);
  if (other.empty()) {
    other = "a frame unknown";
  }
  return fmt::format(fmt::runtime(text_of(record.cause).text), fmt::arg("with", other),
                     fmt::arg("to", names[record.receiver]));
}

void append_budget(std::string& text, const ReceptionLogRecord& record) {
  const logs::LinkBudget& b = record.budget;
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "{:14}{:.2f} dBm = {:.2f} sent {:+.2f} {:+.2f} antennas {:+.2f} path {:+.2f} "
                 "obstacles ",
                 "", record.power_dbm, b.tx_power_dbm, b.tx_antenna_db, b.rx_antenna_db,
                 -b.basic_loss_db, -b.obstacle_loss_db);
  if (b.foliage_loss_db != 0.0F) {
    fmt::format_to(out, "{:+.2f} foliage ", -b.foliage_loss_db);
  }
  fmt::format_to(out, "{:+.2f} shadowing {:+.2f} fading", -b.shadowing_loss_db, -b.fading_loss_db);
  if (std::isfinite(record.sinr_db)) {
    fmt::format_to(out, "; SINR {:.2f} dB", record.sinr_db);
  }
  text += '\n';
}

/// Empty where it is not a number.
std::string field(float value) {
  return std::isfinite(value) ? fmt::format("{:.4f}", value) : std::string{};
}

}  // namespace

std::vector<ReceptionLogRecord> frames_of(ReceptionLogReader& log, const WhyQuestion& question) {
  std::vector<ReceptionLogRecord> records;
  std::unordered_map<std::uint64_t, std::size_t> received;  // frame -> place in records
  while (const auto record = log.next()) {
    if (record->kind == RecordKind::kCopyLost) {
      const auto copy = received.find(record->frame);
      if (copy != received.end() && record->receiver == question.receiver) {
        records[copy->second].cause = record->cause;
      }
    } else if (is_asked_for(*record, question)) {
      if (record->cause == Cause::kReceived && record->ppdu_kind == PpduKind::kData) {
        received.try_emplace(record->frame, records.size());
      }
      records.push_back(*record);
    }
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const auto& x, const auto& y) { return x.begins_ns < y.begins_ns; });
  return records;
}

std::string why_table(std::span<const ReceptionLogRecord> records,
                      std::span<const std::string> names) {
  std::string text = fmt::format("{:>12}  {:<5} {:<12} {:>5} {:>9} {:>4}  {}\n", "TIME", "KIND",
                                 "TO", "BYTES", "RATE", "TRY", "WHAT BECAME OF IT");
  for (const ReceptionLogRecord& record : records) {
    const bool on_air = record.kind == RecordKind::kReception;
    const std::string rate =
        on_air ? fmt::format("{:.1f} Mb/s", static_cast<double>(record.rate_kbps) / 1e3) : "-";
    fmt::format_to(std::back_inserter(text), "{:>10.6f} s  {:<5} {:<12} {:>5} {:>9} {:>4}  {}\n",
                   static_cast<double>(record.begins_ns) * kNanosecond_s, name_of(record.ppdu_kind),
                   destination_of(record, names), record.psdu_bytes, rate, record.attempt,
                   fate_of(record, names));
    if (on_air) {
      append_budget(text, record);
    }
  }
  return text;
}

std::string why_csv(std::span<const ReceptionLogRecord> records,
                    std::span<const std::string> names) {
  std::string text =
      "time_s,frame,kind,to,bytes,rate_kbps,attempt,cause,interferer,sinr_db,power_dbm,"
      "tx_power_dbm,tx_antenna_db,rx_antenna_db,basic_loss_db,obstacle_loss_db,"
      "foliage_loss_db,shadowing_loss_db,fading_loss_db\n";
  for (const ReceptionLogRecord& record : records) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "{:.9f},{},{},{},{},",
                   static_cast<double>(record.begins_ns) * kNanosecond_s, record.frame,
                   name_of(record.ppdu_kind), destination_of(record, names), record.psdu_bytes);
    if (record.kind != RecordKind::kReception) {
      fmt::format_to(out, ",{},{},,,,,,,,,,,\n", record.attempt, text_of(record.cause).name);
      continue;
    }
    const logs::LinkBudget& b = record.budget;
    fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", record.rate_kbps,
                   record.attempt, text_of(record.cause).name, interferer_of(record, names),
                   field(record.sinr_db), field(record.power_dbm), field(b.tx_power_dbm),
                   field(b.tx_antenna_db), field(b.rx_antenna_db), field(b.basic_loss_db),
                   field(b.obstacle_loss_db), field(b.foliage_loss_db), field(b.shadowing_loss_db),
                   field(b.fading_loss_db));
  }
  return text;
}

}  // namespace cuscus::orchestrator
