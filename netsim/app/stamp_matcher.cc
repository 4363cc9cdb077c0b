#include "netsim/app/stamp_matcher.h"

#include <algorithm>
#include <cstring>

namespace cuscus::netsim {

void StampMatcher::expect(std::uint32_t token, const shm::SendStamp& stamp) {
  stamps_.push_back({.token = token, .stamp = stamp});
}

StampMatcher::Match StampMatcher::match(std::span<const std::uint8_t> frame) {
  const std::size_t head = std::min<std::size_t>(frame.size(), shm::SendStamp::kHeadBytes);
  for (std::size_t i = 0; i < stamps_.size(); ++i) {
    const shm::SendStamp& stamp = stamps_[i].stamp;
    if (stamp.frame_bytes == frame.size() &&
        std::memcmp(stamp.head.data(), frame.data(), head) == 0) {
      const std::uint32_t token = stamps_[i].token;
      const auto lost = drop_first(i);
      stamps_.pop_front();
      return {.token = token, .lost = lost};
    }
  }
  return {.token = std::nullopt, .lost = {}};
}

std::span<const std::uint32_t> StampMatcher::expire(std::uint64_t monotonic_ns) {
  std::size_t count = 0;
  while (count < stamps_.size() && stamps_[count].stamp.monotonic_ns < monotonic_ns) {
    ++count;
  }
  return drop_first(count);
}

std::span<const std::uint32_t> StampMatcher::drop_first(std::size_t count) {
  lost_.clear();
  for (; count > 0; --count) {
    lost_.push_back(stamps_.front().token);
    stamps_.pop_front();
  }
  return lost_;
}

}  // namespace cuscus::netsim
