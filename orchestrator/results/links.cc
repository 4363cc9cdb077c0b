#include "orchestrator/results/links.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace cuscus::orchestrator {
namespace {

using shm::LinkCount;
using shm::LinkTally;

constexpr std::array kLinkColumns{
    std::pair{"received", LinkCount::kReceived},
    std::pair{"lost_below_floor", LinkCount::kLostBelowFloor},
    std::pair{"lost_below_detection", LinkCount::kLostBelowDetection},
    std::pair{"lost_noise", LinkCount::kLostNoise},
    std::pair{"lost_collision", LinkCount::kLostCollision},
    std::pair{"lost_interference", LinkCount::kLostInterference},
    std::pair{"lost_half_duplex", LinkCount::kLostHalfDuplex},
    std::pair{"lost_jammed", LinkCount::kLostJammed},
    std::pair{"lost_interface", LinkCount::kLostInterface},
    std::pair{"lost_unanswered", LinkCount::kLostUnanswered},
    std::pair{"dropped_queue_full", LinkCount::kDroppedQueueFull},
    std::pair{"dropped_lifetime", LinkCount::kDroppedLifetime},
    std::pair{"dropped_retry_limit", LinkCount::kDroppedRetryLimit},
    std::pair{"transmissions", LinkCount::kTransmissions},
};
static_assert(kLinkColumns.size() == shm::kLinkCounts);

/// Frames that are over. After the last attempt a frame has its cause as well, or was received.
std::uint64_t frames_of(const LinkTally& tally) {
  std::uint64_t frames = 0;
  for (const auto& [name, which] : kLinkColumns) {
    if (which != LinkCount::kDroppedRetryLimit && which != LinkCount::kTransmissions) {
      frames += tally[which];
    }
  }
  return frames;
}

std::string header() {
  std::string line = "sender,receiver,frames";
  for (const auto& [name, which] : kLinkColumns) {
    line += ',';
    line += name;
  }
  return line + ",rate_latest_kbps,rate_lowest_kbps,rate_highest_kbps\n";
}

void append_row(std::string& text, const std::string& sender, const std::string& receiver,
                const std::string& frames, const LinkTally& tally) {
  text += sender + ',' + receiver + ',' + frames;
  for (const auto& [name, which] : kLinkColumns) {
    text += ',' + std::to_string(tally[which]);
  }
  for (const std::uint32_t rate_kbps :
       {tally.rates.latest_kbps, tally.rates.lowest_kbps, tally.rates.highest_kbps}) {
    text += ',' + (rate_kbps > 0 ? std::to_string(rate_kbps) : std::string{});
  }
  text += '\n';
}

bool is_empty(const LinkTally& tally) {
  return std::all_of(tally.counts.begin(), tally.counts.end(),
                     [](std::uint32_t count) { return count == 0; });
}

}  // namespace

std::string links_csv(std::span<const std::string> names, const shm::RadioMemoryReader& radio) {
  std::string text = header();
  for (std::uint32_t sender = 0; sender < names.size(); ++sender) {
    for (std::uint32_t receiver = 0; receiver < names.size(); ++receiver) {
      const LinkTally tally = radio.link_tally(sender, static_cast<std::int32_t>(receiver));
      if (!is_empty(tally)) {
        append_row(text, names[sender], names[receiver], std::to_string(frames_of(tally)), tally);
      }
    }
    for (const auto& [name, to] :
         {std::pair{"(group)", shm::kToGroup}, std::pair{"(nobody)", shm::kToNobody}}) {
      const LinkTally tally = radio.link_tally(sender, to);
      if (!is_empty(tally)) {
        append_row(text, names[sender], name, {}, tally);
      }
    }
  }
  return text;
}

}  // namespace cuscus::orchestrator
