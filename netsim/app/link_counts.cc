#include "netsim/app/link_counts.h"

#include <optional>

namespace cuscus::netsim {
namespace {

using shm::LinkCount;

static_assert(kGroup == shm::kToGroup && kNobody == shm::kToNobody);

std::optional<LinkCount> count_of(LossCause cause) {
  switch (cause) {
    case LossCause::kNone:
      break;
    case LossCause::kBelowFloor:
      return LinkCount::kLostBelowFloor;
    case LossCause::kBelowDetection:
      return LinkCount::kLostBelowDetection;
    case LossCause::kNoise:
      return LinkCount::kLostNoise;
    case LossCause::kCollision:
      return LinkCount::kLostCollision;
    case LossCause::kInterference:
      return LinkCount::kLostInterference;
    case LossCause::kHalfDuplex:
      return LinkCount::kLostHalfDuplex;
    case LossCause::kJammed:
      return LinkCount::kLostJammed;
  }
  return std::nullopt;
}

std::optional<LinkCount> count_of(SendOutcome outcome) {
  switch (outcome) {
    case SendOutcome::kQueueFull:
      return LinkCount::kDroppedQueueFull;
    case SendOutcome::kLifetime:
      return LinkCount::kDroppedLifetime;
    case SendOutcome::kRetryLimit:
      return LinkCount::kDroppedRetryLimit;
    case SendOutcome::kSent:
    case SendOutcome::kAcknowledged:
    case SendOutcome::kTooLong:
      break;
  }
  return std::nullopt;
}

bool is_group_data(const Ppdu& ppdu) {
  return ppdu.frame.kind == MacFrame::Kind::kData && ppdu.frame.receiver == kGroup;
}

}  // namespace

void LinkCounts::transmitted(const Ppdu& ppdu) {
  if (ppdu.frame.kind == MacFrame::Kind::kData) {
    shm::LinkTallySlot& link = memory_->link_tally(ppdu.frame.sender, ppdu.frame.receiver);
    link.count(LinkCount::kTransmissions);
    link.note_rate(ppdu.mode->rate_kbps);
  }
}

void LinkCounts::received(const Ppdu& ppdu, const Reception& reception) {
  const auto lost = count_of(reception.cause);
  if (lost && is_group_data(ppdu)) {
    memory_->link_tally(ppdu.frame.sender, static_cast<std::int32_t>(reception.receiver))
        .count(*lost);
  }
}

void LinkCounts::unreached(const Ppdu& ppdu, std::uint32_t receiver) {
  if (is_group_data(ppdu)) {
    memory_->link_tally(ppdu.frame.sender, static_cast<std::int32_t>(receiver))
        .count(LinkCount::kLostBelowFloor);
  }
}

void LinkCounts::delivered(const Delivery& delivery) {
  memory_->link_tally(delivery.sender, static_cast<std::int32_t>(delivery.receiver))
      .count(LinkCount::kReceived);
}

void LinkCounts::finished(const FrameReport& report) {
  const auto dropped = count_of(report.outcome);
  const bool to_node = report.destination >= 0;
  const bool lost = to_node && report.deliveries == 0;
  shm::LinkTallySlot& link = memory_->link_tally(report.sender, report.destination);
  if (dropped) {
    link.count(*dropped);
  }
  if (const auto cause = count_of(report.last_loss); lost && cause) {
    link.count(*cause);
  } else if (lost && report.attempts > 0) {
    link.count(LinkCount::kLostUnanswered);
  }
}

void LinkCounts::lost_at_interface(std::uint32_t sender, std::uint32_t receiver) {
  shm::LinkTallySlot& link = memory_->link_tally(sender, static_cast<std::int32_t>(receiver));
  link.count(LinkCount::kReceived, -1);
  link.count(LinkCount::kLostInterface);
}

}  // namespace cuscus::netsim
