#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "netsim/air/air.h"

namespace cuscus::netsim {

/// One line of a frame log: what became of one offered frame.
struct FrameRecord {
  std::int64_t sent_ns;  ///< SimTime.
  std::uint32_t node;
  std::int32_t destination;   ///< Node, kGroup or kNobody.
  std::uint32_t frame_bytes;  ///< Ethernet, without FCS.
  std::uint32_t attempts;
  SendOutcome outcome;
  std::uint32_t deliveries;
  std::int64_t first_delivery_ns;  ///< SimTime; 0 where there is none.
  std::uint8_t priority{};         ///< Below kPriorities.
};

/// The lines before the first record: what the radio was, and the names of the columns.
[[nodiscard]] std::string frame_log_header(const AirParameters& parameters);

/// "sent_ns,node,destination,bytes,attempts,outcome,delivered_count,first_delivery_ns,priority\n".
void append_frame_record(std::string& text, const FrameRecord& record);

/// Reads a record's line; nothing when it is none. A line without priority has 0.
[[nodiscard]] std::optional<FrameRecord> parse_frame_record(std::string_view line);

/// Takes a "# key=value" line of the header into `parameters`; false when it is no such line.
/// @throws std::invalid_argument when the value cannot be read.
bool parse_frame_log_header(std::string_view line, AirParameters& parameters);

[[nodiscard]] std::string_view name_of(SendOutcome outcome);

}  // namespace cuscus::netsim
