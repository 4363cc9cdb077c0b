#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace cuscus::netsim {

/// Appends fields of wire formats to octets.
class OctetWriter {
 public:
  /// `octets` must outlive this object; what it holds already stays.
  explicit OctetWriter(std::vector<std::uint8_t>& octets) : octets_{&octets} {}

  void u8(std::uint8_t value) { octets_->push_back(value); }
  // Least significant octet first, as 802.11, radiotap and our pcapng files have them.
  void u16(std::uint16_t value) { little_endian<2>(value); }
  void u32(std::uint32_t value) { little_endian<4>(value); }
  void u64(std::uint64_t value) { little_endian<8>(value); }

  /// 48 bits, the first octet highest.
  void mac_address(std::uint64_t address) {
    constexpr int kTopOctet = 40;
    for (int shift = kTopOctet; shift >= 0; shift -= 8) {
      u8(static_cast<std::uint8_t>(address >> static_cast<unsigned>(shift)));
    }
  }

  void octets(std::span<const std::uint8_t> octets) {
    octets_->insert(octets_->end(), octets.begin(), octets.end());
  }
  void text(std::string_view text) { octets_->insert(octets_->end(), text.begin(), text.end()); }

  /// Zeros until what was written since `from` is a multiple of `alignment`.
  void pad(std::size_t from, std::size_t alignment) {
    while ((octets_->size() - from) % alignment != 0) {
      u8(0);
    }
  }

  /// Where the next octet goes.
  [[nodiscard]] std::size_t position() const { return octets_->size(); }
  /// Overwrites the number at `position`.
  void replace_u16(std::size_t position, std::uint16_t value) {
    (*octets_)[position] = static_cast<std::uint8_t>(value);
    (*octets_)[position + 1] = static_cast<std::uint8_t>(value >> 8U);
  }
  void replace_u32(std::size_t position, std::uint32_t value) {
    replace_u16(position, static_cast<std::uint16_t>(value));
    replace_u16(position + 2, static_cast<std::uint16_t>(value >> 16U));
  }

 private:
  template <unsigned bytes>
  void little_endian(std::uint64_t value) {
    for (unsigned i = 0; i < bytes; ++i) {
      u8(static_cast<std::uint8_t>(value >> (8U * i)));
    }
  }

  std::vector<std::uint8_t>* octets_;
};

}  // namespace cuscus::netsim
