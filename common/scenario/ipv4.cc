#include "common/scenario/ipv4.h"

#include <charconv>

namespace cuscus::scenario {
namespace {

/// A decimal number 0 ... `largest` without leading zeros, taken from the front of `text`.
std::optional<std::uint32_t> take_number(std::string_view& text, std::uint32_t largest) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto digits = static_cast<std::size_t>(end - text.data());
  if (error != std::errc{} || value > largest || (digits > 1 && text.front() == '0')) {
    return std::nullopt;
  }
  text.remove_prefix(digits);
  return value;
}

}  // namespace

std::uint32_t Subnet::mask() const {
  return prefix_length == 0 ? 0U : ~std::uint32_t{0} << (32U - prefix_length);
}

std::optional<std::uint32_t> parse_ipv4(std::string_view text) {
  std::uint32_t address = 0;
  for (int part = 0; part < 4; ++part) {
    if (part > 0) {
      if (!text.starts_with('.')) {
        return std::nullopt;
      }
      text.remove_prefix(1);
    }
    const auto number = take_number(text, 255);
    if (!number) {
      return std::nullopt;
    }
    address = (address << 8U) | *number;
  }
  return text.empty() ? std::optional{address} : std::nullopt;
}

std::optional<Subnet> parse_subnet(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) {
    return std::nullopt;
  }
  const auto network = parse_ipv4(text.substr(0, slash));
  text.remove_prefix(slash + 1);
  const auto prefix_length = take_number(text, 32);
  if (!network || !prefix_length || !text.empty()) {
    return std::nullopt;
  }
  return Subnet{.network = *network, .prefix_length = *prefix_length};
}

std::string ipv4_text(std::uint32_t address) {
  return std::to_string(address >> 24U) + '.' + std::to_string((address >> 16U) & 255U) + '.' +
         std::to_string((address >> 8U) & 255U) + '.' + std::to_string(address & 255U);
}

std::string subnet_text(const Subnet& subnet) {
  return ipv4_text(subnet.network) + '/' + std::to_string(subnet.prefix_length);
}

}  // namespace cuscus::scenario
