#include "netsim/app/reception_log.h"

#include <limits>
#include <utility>

namespace cuscus::netsim {
namespace {

using logs::Cause;
using logs::PpduKind;
using logs::RecordKind;

static_assert(kGroup == logs::kToGroup && kNobody == logs::kToNobody &&
              kNoSender == logs::kNoInterferer);

/// 12.6 MB; at 200 000 receptions per second, 0.6 s of a stalled disk.
constexpr std::size_t kReceptionCapacity = std::size_t{1} << 17U;

std::string log_header(std::span<const std::string> names) {
  std::string text;
  for (const std::string& name : names) {
    text += name + '\0';
  }
  const logs::ReceptionLogHeader header{.magic = logs::ReceptionLogHeader::kMagic,
                                        .version = logs::ReceptionLogHeader::kVersion,
                                        .record_bytes = sizeof(logs::ReceptionLogRecord),
                                        .node_count = static_cast<std::uint32_t>(names.size()),
                                        .name_bytes = static_cast<std::uint32_t>(text.size())};
  return std::string{reinterpret_cast<const char*>(&header), sizeof header} + text;
}

PpduKind logged(MacFrame::Kind kind) {
  switch (kind) {
    case MacFrame::Kind::kAck:
      return PpduKind::kAck;
    case MacFrame::Kind::kRts:
      return PpduKind::kRts;
    case MacFrame::Kind::kCts:
      return PpduKind::kCts;
    case MacFrame::Kind::kData:
      break;
  }
  return PpduKind::kData;
}

Cause logged(LossCause cause) {
  switch (cause) {
    case LossCause::kBelowFloor:
      return Cause::kBelowFloor;
    case LossCause::kBelowDetection:
      return Cause::kBelowDetection;
    case LossCause::kNoise:
      return Cause::kNoise;
    case LossCause::kCollision:
      return Cause::kCollision;
    case LossCause::kInterference:
      return Cause::kInterference;
    case LossCause::kHalfDuplex:
      return Cause::kHalfDuplex;
    case LossCause::kJammed:
      return Cause::kJammed;
    case LossCause::kNone:
      break;
  }
  return Cause::kReceived;
}

/// kReceived for a frame that was not given up.
Cause logged(SendOutcome outcome) {
  switch (outcome) {
    case SendOutcome::kQueueFull:
      return Cause::kQueueFull;
    case SendOutcome::kLifetime:
      return Cause::kLifetime;
    case SendOutcome::kRetryLimit:
      return Cause::kRetryLimit;
    case SendOutcome::kTooLong:
      return Cause::kTooLong;
    case SendOutcome::kSent:
    case SendOutcome::kAcknowledged:
      break;
  }
  return Cause::kReceived;
}

float as_float(Decibel value) { return static_cast<float>(value.value); }

logs::ReceptionLogRecord record_of(const Ppdu& ppdu, std::uint32_t receiver) {
  logs::ReceptionLogRecord record{};
  record.begins_ns = to_ns(ppdu.begins);
  record.frame = ppdu.offer_id;
  record.sender = ppdu.frame.sender;
  record.receiver = receiver;
  record.destination = ppdu.frame.receiver;
  record.interferer = logs::kNoInterferer;
  record.psdu_bytes = ppdu.psdu_bytes;
  record.rate_kbps = ppdu.mode->rate_kbps;
  record.attempt = static_cast<std::uint16_t>(ppdu.attempt);
  record.kind = RecordKind::kReception;
  record.ppdu_kind = logged(ppdu.frame.kind);
  record.sinr_db = std::numeric_limits<float>::quiet_NaN();
  return record;
}

bool is_meant_for(const Ppdu& ppdu, std::uint32_t receiver) {
  return ppdu.frame.receiver == kGroup ||
         ppdu.frame.receiver == static_cast<std::int32_t>(receiver);
}

}  // namespace

ReceptionLog::ReceptionLog(posix::UniqueFd file, const AirParameters& parameters,
                           std::span<const std::string> names, PositionSource& positions)
    : ideal_{parameters.mac == "ideal"},
      channel_{parameters.channel},
      links_{channel_, static_cast<std::uint32_t>(parameters.nodes.size())},
      antenna_{make_antenna(parameters.antenna)},
      radios_{parameters.nodes},
      positions_{&positions},
      writer_{std::move(file), log_header(names), kReceptionCapacity} {}

void ReceptionLog::transmitted(const Ppdu& ppdu) {
  Poses& poses = poses_[ppdu.positions_version % kKeptVersions];
  if (poses.version == ppdu.positions_version) {
    return;
  }
  const auto& p_WN = positions_->positions(ppdu.begins);
  const auto q_WN = positions_->attitudes();
  poses.version = ppdu.positions_version;
  poses.nodes.resize(radios_.size());
  for (std::size_t node = 0; node < radios_.size(); ++node) {
    poses.nodes[node] = q_WN.empty() ? AntennaPose{.p_WB = p_WN[node]}
                                     : AntennaPose{.p_WB = p_WN[node], .q_WB = q_WN[node]};
  }
}

logs::LinkBudget ReceptionLog::budget(const Ppdu& ppdu, std::uint32_t receiver) {
  const std::uint32_t sender = ppdu.frame.sender;
  if (ideal_) {
    logs::LinkBudget budget{};
    budget.tx_power_dbm = static_cast<float>(radios_[sender].tx_power.value);
    return budget;
  }
  const auto& poses = poses_[ppdu.positions_version % kKeptVersions].nodes;
  const Link link = Link::between(sender, poses[sender].p_WB, receiver, poses[receiver].p_WB);
  const StaticTerms terms = links_.of(link);
  const EndGains antennas =
      antenna_ ? gains_of_ends(*antenna_, poses[sender], poses[receiver]) : EndGains{};
  const Decibel fading = channel_.varies_per_frame()
                             ? channel_.frame_loss({.link = link,
                                                    .from_low = sender < receiver,
                                                    .transmission = ppdu.number,
                                                    .time = ppdu.begins})
                             : Decibel{0.0};
  return {.tx_power_dbm = static_cast<float>(radios_[sender].tx_power.value),
          .tx_antenna_db = as_float(radios_[sender].antenna_gain + antennas.at_a),
          .rx_antenna_db = as_float(radios_[receiver].antenna_gain + antennas.at_b),
          .basic_loss_db = as_float(terms.basic),
          .obstacle_loss_db = as_float(terms.obstacles.outer_walls + terms.obstacles.inner_walls +
                                       terms.obstacles.diffraction),
          .foliage_loss_db = as_float(terms.obstacles.foliage),
          .shadowing_loss_db = as_float(terms.shadowing),
          .fading_loss_db = as_float(fading)};
}

void ReceptionLog::received(const Ppdu& ppdu, const Reception& reception) {
  if (!is_meant_for(ppdu, reception.receiver)) {
    return;
  }
  logs::ReceptionLogRecord record = record_of(ppdu, reception.receiver);
  record.over_ns = to_ns(reception.time);
  record.cause = logged(reception.cause);
  record.interferer = reception.interferer;
  record.power_dbm = static_cast<float>(reception.power.value);
  if (reception.cause != LossCause::kHalfDuplex) {
    record.sinr_db = as_float(reception.sinr);
  }
  record.budget = budget(ppdu, reception.receiver);
  writer_.add(record);
}

void ReceptionLog::unreached(const Ppdu& ppdu, std::uint32_t receiver) {
  logs::ReceptionLogRecord record = record_of(ppdu, receiver);
  record.over_ns = to_ns(ppdu.ends);
  record.cause = Cause::kBelowFloor;
  record.budget = budget(ppdu, receiver);
  record.power_dbm = record.budget.power_dbm();
  writer_.add(record);
}

void ReceptionLog::finished(const FrameReport& report) {
  const Cause cause = logged(report.outcome);
  if (cause == Cause::kReceived) {
    return;
  }
  logs::ReceptionLogRecord record{};
  record.begins_ns = to_ns(report.sent_at);
  record.frame = report.id;
  record.sender = report.sender;
  record.destination = report.destination;
  record.interferer = logs::kNoInterferer;
  record.psdu_bytes = report.psdu_bytes;
  record.attempt = static_cast<std::uint16_t>(report.attempts);
  record.kind = RecordKind::kGivenUp;
  record.cause = cause;
  writer_.add(record);
}

void ReceptionLog::copy_lost(std::uint64_t frame, std::uint32_t sender, std::uint32_t receiver,
                             SimTime time, Cause cause) {
  logs::ReceptionLogRecord record{};
  record.over_ns = to_ns(time);
  record.frame = frame;
  record.sender = sender;
  record.receiver = receiver;
  record.interferer = logs::kNoInterferer;
  record.kind = RecordKind::kCopyLost;
  record.cause = cause;
  writer_.add(record);
}

}  // namespace cuscus::netsim
