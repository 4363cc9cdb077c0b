#include "common/posix/shared_memory.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <system_error>

namespace cuscus::posix {
namespace {

TEST_CASE("what one mapping writes the other reads") {
  const UniqueFd fd = create_shared_memory("test", 4096);
  const MemoryMapping writer = MemoryMapping::read_write(fd);
  const MemoryMapping reader = MemoryMapping::read_only(fd);

  writer.writable_bytes()[17] = std::byte{42};

  CHECK(reader.bytes().size() == 4096);
  CHECK(reader.bytes()[17] == std::byte{42});
}

TEST_CASE("nobody can change the size of shared memory") {
  const UniqueFd fd = create_shared_memory("test", 4096);

  CHECK(::ftruncate(fd.get(), 0) == -1);
  CHECK(::ftruncate(fd.get(), 8192) == -1);
}

TEST_CASE("sealed memory takes no new writer, and the old one goes on") {
  const UniqueFd fd = create_shared_memory("test", 4096);
  const MemoryMapping writer = MemoryMapping::read_write(fd);

  seal_against_new_writers(fd);

  CHECK_THROWS_AS(MemoryMapping::read_write(fd), std::system_error);
  CHECK(::write(fd.get(), "x", 1) == -1);
  writer.writable_bytes()[0] = std::byte{1};
  CHECK(MemoryMapping::read_only(fd).bytes()[0] == std::byte{1});
}

}  // namespace
}  // namespace cuscus::posix
