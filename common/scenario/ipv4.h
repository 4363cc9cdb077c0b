#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cuscus::scenario {

/// An IPv4 network such as 10.42.0.0/16. Addresses are numbers in host byte order.
struct Subnet {
  std::uint32_t network{};
  std::uint32_t prefix_length{};

  [[nodiscard]] std::uint32_t mask() const;
  [[nodiscard]] std::uint32_t broadcast() const { return network | ~mask(); }
  /// Addresses for hosts: all but the network's own and the broadcast address.
  [[nodiscard]] std::uint32_t host_count() const { return broadcast() - network - 1; }
  /// Address of host `index`, from 0. @pre index < host_count()
  [[nodiscard]] std::uint32_t host(std::uint32_t index) const { return network + 1 + index; }

  friend bool operator==(const Subnet&, const Subnet&) = default;
};

/// "10.42.0.1" as a number; nothing for any other text (no leading zeros, four parts).
[[nodiscard]] std::optional<std::uint32_t> parse_ipv4(std::string_view text);

/// "10.42.0.0/16"; nothing for any other text. Host bits may be set; see `mask`.
[[nodiscard]] std::optional<Subnet> parse_subnet(std::string_view text);

[[nodiscard]] std::string ipv4_text(std::uint32_t address);
[[nodiscard]] std::string subnet_text(const Subnet& subnet);

}  // namespace cuscus::scenario
