#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "common/posix/unique_fd.h"

namespace cuscus::posix {

/// A mapping of a whole memory file, unmapped on destruction.
class MemoryMapping {
 public:
  MemoryMapping() noexcept = default;
  /// Maps all of `fd` for reading, or for reading and writing. The descriptor may be closed after.
  /// @throws std::system_error, also when the file is not writable.
  [[nodiscard]] static MemoryMapping read_only(const UniqueFd& fd);
  [[nodiscard]] static MemoryMapping read_write(const UniqueFd& fd);

  MemoryMapping(MemoryMapping&& other) noexcept;
  MemoryMapping& operator=(MemoryMapping&& other) noexcept;
  MemoryMapping(const MemoryMapping&) = delete;
  MemoryMapping& operator=(const MemoryMapping&) = delete;
  ~MemoryMapping();

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }
  /// Only of a read_write() mapping.
  [[nodiscard]] std::span<std::byte> writable_bytes() const noexcept { return bytes_; }

 private:
  explicit MemoryMapping(std::span<std::byte> bytes) noexcept : bytes_{bytes} {}

  std::span<std::byte> bytes_;
};

/// An anonymous memory file of `byte_size` zero bytes, whose size nobody can change any more.
/// Without that seal a hostile peer could truncate it and kill its readers with SIGBUS.
[[nodiscard]] UniqueFd create_shared_memory(const std::string& name, std::size_t byte_size);

/// Forbids every new writable mapping of `fd`; those that exist stay writable
/// (F_SEAL_FUTURE_WRITE).
void seal_against_new_writers(const UniqueFd& fd);

}  // namespace cuscus::posix
