#include "proto/shm/layout.h"

#include <cstring>
#include <string>

namespace cuscus::shm {
namespace {

std::string text_of(std::uint64_t magic) {
  std::string text(8, '\0');
  std::memcpy(text.data(), &magic, text.size());
  return text;
}

}  // namespace

void write_header(std::span<std::byte> memory, const Header& header) {
  if (memory.size() < header.byte_size) {
    throw LayoutError{"shared memory " + text_of(header.magic) + " needs " +
                      std::to_string(header.byte_size) + " B, has " +
                      std::to_string(memory.size())};
  }
  std::memcpy(memory.data(), &header, sizeof header);
}

Header checked_header(std::span<const std::byte> memory, std::uint64_t magic,
                      std::uint32_t version) {
  const std::string name = "shared memory " + text_of(magic);
  if (memory.size() < sizeof(Header)) {
    throw LayoutError{name + " is only " + std::to_string(memory.size()) + " B long"};
  }
  Header header{};
  std::memcpy(&header, memory.data(), sizeof header);
  if (header.magic != magic) {
    throw LayoutError{name + " begins with another magic number"};
  }
  if (header.version != version) {
    throw LayoutError{name + " has layout version " + std::to_string(header.version) +
                      ", this program speaks " + std::to_string(version)};
  }
  if (header.byte_size != memory.size()) {
    throw LayoutError{name + " says it is " + std::to_string(header.byte_size) + " B, but " +
                      std::to_string(memory.size()) + " are mapped"};
  }
  return header;
}

}  // namespace cuscus::shm
