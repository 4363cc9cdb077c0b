#include "netsim/app/stamp_matcher.h"

#include <algorithm>
#include <cstring>

namespace cuscus::netsim {
namespace {

// Ethernet II and IPv4 (RFC 791), UDP (RFC 768).
constexpr std::size_t kTypeAt = 12;
constexpr std::size_t kIpAt = 14;
constexpr std::size_t kProtocolAt = kIpAt + 9;
constexpr std::uint8_t kUdp = 17;
constexpr std::size_t kUdpChecksumAt = 6;

/// Where the UDP checksum of an IPv4 frame is, if it is one.
std::optional<std::size_t> udp_checksum_at(std::span<const std::uint8_t> frame) {
  if (frame.size() <= kProtocolAt || frame[kTypeAt] != 0x08 || frame[kTypeAt + 1] != 0x00 ||
      frame[kProtocolAt] != kUdp) {
    return std::nullopt;
  }
  return kIpAt + std::size_t{4} * (frame[kIpAt] & 0x0fU) + kUdpChecksumAt;
}

bool same_head(const shm::SendStamp& stamp, std::span<const std::uint8_t> frame) {
  const auto head = frame.first(std::min<std::size_t>(frame.size(), shm::SendStamp::kHeadBytes));
  const auto equal = [&](std::size_t begin, std::size_t end) {
    begin = std::min(begin, head.size());
    end = std::min(end, head.size());
    return std::memcmp(stamp.head.data() + begin, head.data() + begin, end - begin) == 0;
  };
  // At the egress of an interface with checksum offload (veth, say) the UDP checksum is that of the
  // pseudo header; the kernel completes it further on.
  if (const auto checksum = udp_checksum_at(frame)) {
    return equal(0, *checksum) && equal(*checksum + 2, head.size());
  }
  return equal(0, head.size());
}

}  // namespace

void StampMatcher::expect(std::uint32_t token, const shm::SendStamp& stamp) {
  stamps_.push_back({.token = token, .stamp = stamp});
}

StampMatcher::Match StampMatcher::match(std::span<const std::uint8_t> frame) {
  const auto end = stamps_.begin() + static_cast<std::ptrdiff_t>(std::min(stamps_.size(), kDepth));
  const auto own = std::find_if(stamps_.begin(), end, [&](const Expected& expected) {
    return expected.stamp.frame_bytes == frame.size() && same_head(expected.stamp, frame);
  });
  if (own == end) {
    return {.token = std::nullopt, .lost = {}};
  }
  const Expected found = *own;
  stamps_.erase(own);
  const std::uint64_t sent_ns = found.stamp.monotonic_ns;
  return {.token = found.token, .lost = expire(sent_ns - std::min(sent_ns, kOvertaking_ns))};
}

std::span<const std::uint32_t> StampMatcher::expire(std::uint64_t monotonic_ns) {
  lost_.clear();
  while (overdue(monotonic_ns)) {
    lost_.push_back(stamps_.front().token);
    stamps_.pop_front();
  }
  return lost_;
}

}  // namespace cuscus::netsim
