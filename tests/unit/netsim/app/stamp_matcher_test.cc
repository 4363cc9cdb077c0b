#include "netsim/app/stamp_matcher.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

namespace cuscus::netsim {
namespace {

std::vector<std::uint8_t> frame(std::uint8_t mark, std::size_t bytes = 60) {
  return std::vector<std::uint8_t>(bytes, mark);
}

shm::SendStamp stamp_of(const std::vector<std::uint8_t>& bytes, std::uint64_t monotonic_ns = 0) {
  shm::SendStamp stamp{.monotonic_ns = monotonic_ns,
                       .node = 0,
                       .frame_bytes = static_cast<std::uint32_t>(bytes.size()),
                       .head = {}};
  std::copy_n(bytes.begin(), std::min(bytes.size(), stamp.head.size()), stamp.head.begin());
  return stamp;
}

std::vector<std::uint32_t> tokens(std::span<const std::uint32_t> span) {
  return {span.begin(), span.end()};
}

TEST_CASE("frames meet their stamps in order") {
  StampMatcher matcher;
  matcher.expect(1, stamp_of(frame('a')));
  matcher.expect(2, stamp_of(frame('b')));

  CHECK(matcher.match(frame('a')).token == 1U);
  CHECK(matcher.match(frame('b')).token == 2U);
  CHECK(matcher.expected() == 0);
}

TEST_CASE("a frame tells that those sent long before it were lost") {
  constexpr std::uint64_t kLater_ns = 1 + StampMatcher::kOvertaking_ns;
  StampMatcher matcher;
  matcher.expect(1, stamp_of(frame('a'), 0));
  matcher.expect(2, stamp_of(frame('b'), 0));
  matcher.expect(3, stamp_of(frame('c'), 1));
  matcher.expect(4, stamp_of(frame('d'), kLater_ns));

  const auto match = matcher.match(frame('d'));

  CHECK(match.token == 4U);
  CHECK(tokens(match.lost) == std::vector<std::uint32_t>{1, 2});
  CHECK(matcher.match(frame('c')).token == 3U);
}

TEST_CASE("two frames that changed places behind their stamps both meet them") {
  StampMatcher matcher;
  matcher.expect(1, stamp_of(frame('a'), 1'000));
  matcher.expect(2, stamp_of(frame('b'), 2'000));

  const auto first = matcher.match(frame('b'));
  CHECK(first.token == 2U);
  CHECK(first.lost.empty());
  const auto second = matcher.match(frame('a'));

  CHECK(second.token == 1U);
  CHECK(second.lost.empty());
  CHECK(matcher.expected() == 0);
}

TEST_CASE("a stamp is looked for within a bounded number of stamps") {
  StampMatcher matcher;
  for (std::uint32_t i = 0; i < StampMatcher::kDepth; ++i) {
    matcher.expect(i, stamp_of(frame('a')));
  }
  matcher.expect(StampMatcher::kDepth, stamp_of(frame('b')));

  CHECK_FALSE(matcher.match(frame('b')).token);
  CHECK(matcher.match(frame('a')).token == 0U);
  CHECK(matcher.match(frame('b')).token == StampMatcher::kDepth);
}

TEST_CASE("a frame without stamp leaves the stamps alone") {
  StampMatcher matcher;
  matcher.expect(1, stamp_of(frame('a')));

  const auto match = matcher.match(frame('x'));

  CHECK_FALSE(match.token);
  CHECK(match.lost.empty());
  CHECK(matcher.expected() == 1);
}

TEST_CASE("equal heads of different length are different frames, equal frames go in order") {
  StampMatcher matcher;
  matcher.expect(1, stamp_of(frame('a', 100)));
  matcher.expect(2, stamp_of(frame('a', 101)));
  matcher.expect(3, stamp_of(frame('a', 101)));

  CHECK(matcher.match(frame('a', 100)).token == 1U);
  CHECK(matcher.match(frame('a', 101)).token == 2U);
  CHECK(matcher.match(frame('a', 101)).token == 3U);
}

TEST_CASE("a frame shorter than a stamp's head is known by all of its bytes") {
  StampMatcher matcher;
  matcher.expect(1, stamp_of(frame('a', 20)));

  CHECK_FALSE(matcher.match(frame('b', 20)).token);
  CHECK(matcher.match(frame('a', 20)).token == 1U);
}

TEST_CASE("a UDP checksum that was completed after the stamp makes no difference") {
  auto sent = frame('u', 80);
  sent[12] = 0x08;  // IPv4
  sent[13] = 0x00;
  sent[14] = 0x45;  // five words of header
  sent[23] = 17;    // UDP
  auto received = sent;
  received[40] = 0x12;
  received[41] = 0x34;
  auto other = sent;
  other[42] = 'v';
  StampMatcher matcher;
  matcher.expect(1, stamp_of(sent));

  CHECK_FALSE(matcher.match(other).token);
  CHECK(matcher.match(received).token == 1U);
}

TEST_CASE("stamps whose frames never came expire by age") {
  StampMatcher matcher;
  matcher.expect(1, stamp_of(frame('a'), 100));
  matcher.expect(2, stamp_of(frame('b'), 200));

  CHECK(tokens(matcher.expire(200)) == std::vector<std::uint32_t>{1});
  CHECK(matcher.match(frame('b')).token == 2U);
}

}  // namespace
}  // namespace cuscus::netsim
