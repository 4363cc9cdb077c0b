#include "netsim/app/stamp_ring.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

#include "common/posix/check.h"

namespace cuscus::netsim {
namespace {

constexpr std::uint32_t kBusyBit = 1U << 31U;
constexpr std::uint32_t kDiscardBit = 1U << 30U;
constexpr std::uint64_t kHeaderBytes = 8;

/// A number that /proc/self/fdinfo gives about a descriptor.
std::uint64_t fdinfo(int fd, const std::string& key) {
  std::ifstream file{"/proc/self/fdinfo/" + std::to_string(fd)};
  std::string name;
  while (file >> name) {
    if (name == key + ":") {
      std::uint64_t value = 0;
      file >> value;
      return value;
    }
    file.ignore(4096, '\n');
  }
  throw std::runtime_error{"send stamp ring: the descriptor is no BPF map (no " + key + ")"};
}

}  // namespace

std::optional<shm::SendStamp> RingReader::next(std::uint64_t end) {
  blocked_ = false;
  // Only this side moves the consumer's position.
  std::uint64_t consumed = memory_.consumer->load(std::memory_order_relaxed);
  while (consumed < end) {
    const std::byte* const record = memory_.data + (consumed & (memory_.byte_size - 1));
    const std::uint32_t header =
        __atomic_load_n(reinterpret_cast<const std::uint32_t*>(record), __ATOMIC_ACQUIRE);
    if ((header & kBusyBit) != 0) {
      blocked_ = true;
      return std::nullopt;
    }
    const std::uint32_t length = header & ~(kBusyBit | kDiscardBit);
    std::optional<shm::SendStamp> stamp;
    if ((header & kDiscardBit) == 0) {
      if (length == sizeof(shm::SendStamp)) {
        std::memcpy(&stamp.emplace(), record + kHeaderBytes, sizeof(shm::SendStamp));
      } else {
        ++foreign_;
      }
    }
    consumed += (length + kHeaderBytes + 7) / 8 * 8;
    memory_.consumer->store(consumed, std::memory_order_release);
    if (stamp) {
      return stamp;
    }
  }
  return std::nullopt;
}

bool RingReader::empty() const {
  // The producer wakes a sleeper only when it sees that everything before its record was consumed:
  // our position must be visible before we look for records (Dekker's pattern).
  // A read-modify-write is that barrier.
  return memory_.consumer->fetch_add(0, std::memory_order_seq_cst) >=
         memory_.producer->load(std::memory_order_seq_cst);
}

StampRing::StampRing(posix::UniqueFd map) : map_{std::move(map)} {
  constexpr std::uint64_t kRingBufferMapType = 27;  // BPF_MAP_TYPE_RINGBUF, linux/bpf.h
  if (fdinfo(map_.get(), "map_type") != kRingBufferMapType) {
    throw std::runtime_error{"send stamp ring: the descriptor is a BPF map of another type"};
  }
  const std::uint64_t byte_size = fdinfo(map_.get(), "max_entries");
  page_bytes_ = static_cast<std::size_t>(posix::check("sysconf", ::sysconf(_SC_PAGESIZE)));
  producer_bytes_ = page_bytes_ + 2 * byte_size;
  consumer_page_ = ::mmap(nullptr, page_bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, map_.get(), 0);
  if (consumer_page_ == MAP_FAILED) {
    posix::throw_errno("map the consumer page of the send stamp ring");
  }
  producer_pages_ = ::mmap(nullptr, producer_bytes_, PROT_READ, MAP_SHARED, map_.get(),
                           static_cast<::off_t>(page_bytes_));
  if (producer_pages_ == MAP_FAILED) {
    const int error = errno;
    ::munmap(consumer_page_, page_bytes_);
    errno = error;
    posix::throw_errno("map the send stamp ring");
  }
  reader_.emplace(RingReader::Memory{
      .consumer = static_cast<std::atomic<std::uint64_t>*>(consumer_page_),
      .producer = static_cast<const std::atomic<std::uint64_t>*>(producer_pages_),
      .data = static_cast<const std::byte*>(producer_pages_) + page_bytes_,
      .byte_size = byte_size});
}

StampRing::~StampRing() {
  ::munmap(consumer_page_, page_bytes_);
  ::munmap(producer_pages_, producer_bytes_);
}

}  // namespace cuscus::netsim
