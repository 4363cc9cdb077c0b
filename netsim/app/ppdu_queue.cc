#include "netsim/app/ppdu_queue.h"

#include <algorithm>
#include <type_traits>

namespace cuscus::netsim {
namespace {

struct Entry {
  PpduRecord record;
  std::uint32_t ethernet_bytes;
};
static_assert(std::is_trivially_copyable_v<Entry>);

}  // namespace

bool PpduQueue::add(const PpduRecord& record, std::span<const std::uint8_t> ethernet) noexcept {
  const Entry entry{.record = record,
                    .ethernet_bytes = static_cast<std::uint32_t>(ethernet.size())};
  const std::uint64_t begin = added_.load(std::memory_order_relaxed);
  const std::uint64_t end = begin + sizeof entry + ethernet.size();
  if (end - taken_.load(std::memory_order_acquire) > memory_.size()) {
    return false;
  }
  write(begin, std::as_bytes(std::span{&entry, 1}));
  write(begin + sizeof entry, std::as_bytes(ethernet));
  added_.store(end, std::memory_order_release);
  return true;
}

PpduRecord PpduQueue::next() {
  Entry entry{};
  const std::uint64_t begin = taken_.load(std::memory_order_relaxed);
  read(begin, std::as_writable_bytes(std::span{&entry, 1}));
  ethernet_.resize(entry.ethernet_bytes);
  read(begin + sizeof entry, std::as_writable_bytes(std::span{ethernet_}));
  taken_.store(begin + sizeof entry + ethernet_.size(), std::memory_order_release);
  return entry.record;
}

void PpduQueue::write(std::uint64_t position, std::span<const std::byte> bytes) noexcept {
  const std::size_t at = position % memory_.size();
  const std::size_t first = std::min(bytes.size(), memory_.size() - at);
  std::copy_n(bytes.begin(), first, memory_.begin() + static_cast<std::ptrdiff_t>(at));
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(first), bytes.end(), memory_.begin());
}

void PpduQueue::read(std::uint64_t position, std::span<std::byte> bytes) const noexcept {
  const std::size_t at = position % memory_.size();
  const std::size_t first = std::min(bytes.size(), memory_.size() - at);
  std::copy_n(memory_.begin() + static_cast<std::ptrdiff_t>(at), first, bytes.begin());
  std::copy_n(memory_.begin(), bytes.size() - first,
              bytes.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace cuscus::netsim
