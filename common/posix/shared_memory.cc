#include "common/posix/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <utility>

#include "common/posix/check.h"

namespace cuscus::posix {
namespace {

std::span<std::byte> map_all(const UniqueFd& fd, int protection) {
  struct stat file {};
  check("fstat of shared memory", ::fstat(fd.get(), &file));
  const auto size = static_cast<std::size_t>(file.st_size);
  void* const address = ::mmap(nullptr, size, protection, MAP_SHARED, fd.get(), 0);
  if (address == MAP_FAILED) {
    throw_errno("mmap of shared memory");
  }
  return {static_cast<std::byte*>(address), size};
}

}  // namespace

MemoryMapping MemoryMapping::read_only(const UniqueFd& fd) {
  return MemoryMapping{map_all(fd, PROT_READ)};
}

MemoryMapping MemoryMapping::read_write(const UniqueFd& fd) {
  return MemoryMapping{map_all(fd, PROT_READ | PROT_WRITE)};
}

MemoryMapping::MemoryMapping(MemoryMapping&& other) noexcept
    : bytes_{std::exchange(other.bytes_, {})} {}

MemoryMapping& MemoryMapping::operator=(MemoryMapping&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

MemoryMapping::~MemoryMapping() {
  if (!bytes_.empty()) {
    static_cast<void>(::munmap(bytes_.data(), bytes_.size()));
  }
}

UniqueFd create_shared_memory(const std::string& name, std::size_t byte_size) {
  UniqueFd fd{check("memfd_create", ::memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING))};
  check("ftruncate of shared memory", ::ftruncate(fd.get(), static_cast<off_t>(byte_size)));
  check("seal the size of shared memory",
        ::fcntl(fd.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW));
  return fd;
}

void seal_against_new_writers(const UniqueFd& fd) {
  check("seal shared memory against writers",
        ::fcntl(fd.get(), F_ADD_SEALS, F_SEAL_FUTURE_WRITE | F_SEAL_SEAL));
}

}  // namespace cuscus::posix
