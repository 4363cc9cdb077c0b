#include "common/posix/processors.h"

#include <sched.h>

#include <cstdint>
#include <iomanip>
#include <memory>
#include <sstream>

#include "common/posix/check.h"

namespace cuscus::posix {
namespace {

/// More than any kernel knows.
constexpr int kProcessors = 8192;

struct FreeSet {
  void operator()(cpu_set_t* set) const { CPU_FREE(set); }
};
using ProcessorSet = std::unique_ptr<cpu_set_t, FreeSet>;

constexpr std::size_t size_of_set() { return CPU_ALLOC_SIZE(kProcessors); }

ProcessorSet empty_set() {
  ProcessorSet set{CPU_ALLOC(kProcessors)};
  if (set) {
    CPU_ZERO_S(size_of_set(), set.get());
  }
  return set;
}

}  // namespace

std::vector<int> allowed_processors() {
  const ProcessorSet set = empty_set();
  check("sched_getaffinity", set ? ::sched_getaffinity(0, size_of_set(), set.get()) : -1);
  std::vector<int> processors;
  for (int processor = 0; processor < kProcessors; ++processor) {
    if (CPU_ISSET_S(static_cast<std::size_t>(processor), size_of_set(), set.get())) {
      processors.push_back(processor);
    }
  }
  return processors;
}

bool try_pin(int processor) noexcept {
  const ProcessorSet set = empty_set();
  if (!set || processor < 0 || processor >= kProcessors) {
    return false;
  }
  CPU_SET_S(static_cast<std::size_t>(processor), size_of_set(), set.get());
  return ::sched_setaffinity(0, size_of_set(), set.get()) == 0;
}

std::string processor_mask(std::span<const int> processors) {
  constexpr unsigned kGroupBits = 32;
  std::vector<std::uint32_t> groups(1);
  for (const int processor : processors) {
    const auto bit = static_cast<unsigned>(processor);
    if (bit / kGroupBits >= groups.size()) {
      groups.resize(bit / kGroupBits + 1);
    }
    groups[bit / kGroupBits] |= 1U << (bit % kGroupBits);
  }
  std::ostringstream mask;
  mask << std::hex << groups.back() << std::setfill('0');
  for (std::size_t group = groups.size() - 1; group-- > 0;) {
    mask << ',' << std::setw(kGroupBits / 4) << groups[group];
  }
  return mask.str();
}

}  // namespace cuscus::posix
