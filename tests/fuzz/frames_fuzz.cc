// What a TAP and the stamp ring may bring, in any order and of any content: runts, giants, tags,
// stamps without frames, frames without stamps. An input is a list of records: what, length, bytes.
#include <algorithm>
#include <set>
#include <span>

#include "netsim/app/ethernet.h"
#include "netsim/app/stamp_matcher.h"
#include "netsim/mac/mac.h"
#include "netsim/phy/standard.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace cuscus;          // NOLINT(google-build-using-namespace): a main
using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main
using Bytes = std::span<const std::uint8_t>;

void check_parse(Bytes frame, std::uint32_t frame_bytes) {
  const auto head = parse_ethernet(frame, frame_bytes);
  if (!head) {
    return;
  }
  must(frame_bytes >= kEthernetHeaderBytes, "a runt was taken");
  must(frame_bytes - kEthernetHeaderBytes + kLlcSnapBytes <= kMaximumMsduBytes,
       "a giant was taken");
  must(head->destination < (std::uint64_t{1} << 48U), "an address has more than 48 bits");
  must(head->group == ((head->destination >> 40U & 1U) != 0), "the group bit is wrong");
  must(head->priority < kPriorities, "there is no such priority");
  must(psdu_bytes_of_ethernet(frame_bytes) <= kMaximumMsduBytes + kDataHeaderBytes + kFcsBytes,
       "a PSDU is longer than an MSDU and its header");
}

/// Every stamp ends once: matched, or lost.
class Stamps {
 public:
  void expect(Bytes head, std::uint32_t frame_bytes) {
    shm::SendStamp stamp{};
    stamp.monotonic_ns = now_ns_ += frame_bytes * std::uint64_t{1000};
    stamp.frame_bytes = frame_bytes;
    std::copy_n(head.begin(), std::min<std::size_t>(head.size(), stamp.head.size()),
                stamp.head.begin());
    open_.insert(next_);
    matcher_.expect(next_++, stamp);
  }
  void arrive(Bytes frame) {
    const auto match = matcher_.match(frame);
    if (match.token) {
      must(open_.erase(*match.token) == 1, "a stamp matched twice");
    }
    end(match.lost);
    must(matcher_.expected() == open_.size(), "a stamp got away");
  }
  void give_up() {
    end(matcher_.expire(now_ns_));
    must(!matcher_.overdue(now_ns_), "an overdue stamp was kept");
  }

 private:
  void end(std::span<const std::uint32_t> lost) {
    for (const std::uint32_t token : lost) {
      must(open_.erase(token) == 1, "a stamp was lost that was not expected");
    }
  }

  StampMatcher matcher_;
  std::set<std::uint32_t> open_;
  std::uint32_t next_{0};
  std::uint64_t now_ns_{0};
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kRecordHead = 3;
  Stamps stamps;
  Bytes rest{data, size};
  while (rest.size() >= kRecordHead) {
    const std::uint8_t what = rest[0];
    const std::uint32_t length = rest[1] | (std::uint32_t{rest[2]} << 8U);
    rest = rest.subspan(kRecordHead);
    const Bytes frame = rest.first(std::min<std::size_t>(length, rest.size()));
    check_parse(frame, static_cast<std::uint32_t>(frame.size()));
    check_parse(frame, length);  // as of a stamp, which has the beginning alone
    if ((what & 1U) != 0) {
      stamps.expect(frame, static_cast<std::uint32_t>(frame.size()));
    }
    if ((what & 2U) != 0) {
      stamps.arrive(frame);
    }
    if ((what & 4U) != 0) {
      stamps.give_up();
    }
    // Not always: the next record may lie within this one, and match it.
    rest = (what & 8U) != 0 ? rest : rest.subspan(frame.size());
  }
  return 0;
}
