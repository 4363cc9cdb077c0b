#include "proto/shm/clock_page.h"

#include <new>

namespace cuscus::shm {

ClockPageWriter::ClockPageWriter(std::span<std::byte> memory)
    : page_{new (memory.data()) ClockPageLayout{}} {
  write_header(memory, {.magic = ClockPageLayout::kMagic,
                        .version = ClockPageLayout::kVersion,
                        .node_count = 0,
                        .byte_size = byte_size()});
}

void ClockPageWriter::start(std::int64_t monotonic_ns) noexcept {
  page_->start_monotonic_ns.store(monotonic_ns, std::memory_order_release);
}

ClockPageReader::ClockPageReader(std::span<const std::byte> memory)
    : page_{reinterpret_cast<const ClockPageLayout*>(memory.data())} {
  checked_header(memory, ClockPageLayout::kMagic, ClockPageLayout::kVersion);
}

std::optional<std::int64_t> ClockPageReader::start_monotonic_ns() const noexcept {
  const std::int64_t start = page_->start_monotonic_ns.load(std::memory_order_acquire);
  return start == 0 ? std::nullopt : std::optional{start};
}

}  // namespace cuscus::shm
