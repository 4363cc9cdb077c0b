#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/units/sim_time.h"
#include "orchestrator/results/reception_log.h"

namespace cuscus::orchestrator {

/// Which frames are asked for: those that began, or were given to be sent, from `from` to before
/// `to`.
struct WhyQuestion {
  std::uint32_t sender{};
  std::uint32_t receiver{};
  SimTime from;
  SimTime to;
};

/// What became of each frame of the question, in the order of time: a record per PPDU that was
/// meant for the receiver, and one per frame that was given up. A frame that was received and did
/// not get into the interface has that cause.
[[nodiscard]] std::vector<logs::ReceptionLogRecord> frames_of(ReceptionLogReader& log,
                                                              const WhyQuestion& question);

/// Two lines per record: what became of it, and its link budget.
[[nodiscard]] std::string why_table(std::span<const logs::ReceptionLogRecord> records,
                                    std::span<const std::string> names);
/// The same as CSV, with a header.
[[nodiscard]] std::string why_csv(std::span<const logs::ReceptionLogRecord> records,
                                  std::span<const std::string> names);

}  // namespace cuscus::orchestrator
