#pragma once

#include <string>

namespace cuscus::netlink {

/// Turns off checksum, segmentation and receive offloads of a link of the calling thread's
/// namespace: what leaves it must be whole frames as they would be on the air, checksums included.
/// What a kind of link does not have is off already.
void disable_offloads(const std::string& link_name);

/// Whether an IPv4 checksum or segmentation offload of that link is on.
[[nodiscard]] bool has_offloads(const std::string& link_name);

}  // namespace cuscus::netlink
