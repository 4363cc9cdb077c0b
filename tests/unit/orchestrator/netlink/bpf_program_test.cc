#include "orchestrator/netlink/bpf_program.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

#include "orchestrator/netlink/send_stamps.h"

namespace cuscus::netlink::bpf {
namespace {

using Bytes = std::vector<unsigned>;

Bytes bytes_of(const bpf_insn& instruction) {
  std::array<std::uint8_t, sizeof instruction> raw{};
  std::memcpy(raw.data(), &instruction, sizeof instruction);
  return {raw.begin(), raw.end()};
}

// Expected bytes: instruction-set.rst of the kernel's documentation (opcode = class | operation |
// source, then source and destination register in one byte, offset, immediate, little-endian), as
// llvm-objdump shows them.
TEST_CASE("instructions are encoded as the instruction set says") {
  CHECK(bytes_of(move(Register::kR6, Register::kR1)) == Bytes{0xbf, 0x16, 0, 0, 0, 0, 0, 0});
  CHECK(bytes_of(move(Register::kR0, -1)) == Bytes{0xb7, 0, 0, 0, 0xff, 0xff, 0xff, 0xff});
  CHECK(bytes_of(add(Register::kR3, -48)) == Bytes{0x07, 0x03, 0, 0, 0xd0, 0xff, 0xff, 0xff});
  CHECK(bytes_of(load(Width::kWord, Register::kR7, Register::kR6, 4)) ==
        Bytes{0x61, 0x67, 4, 0, 0, 0, 0, 0});
  CHECK(bytes_of(store(Width::kDoubleWord, Register::kFrame, -64, Register::kR0)) ==
        Bytes{0x7b, 0x0a, 0xc0, 0xff, 0, 0, 0, 0});
  CHECK(bytes_of(store(Width::kWord, Register::kFrame, -56, 258)) ==
        Bytes{0x62, 0x0a, 0xc8, 0xff, 2, 1, 0, 0});
  CHECK(bytes_of(skip_if_at_most(1, Register::kR4, 48)) == Bytes{0xb5, 0x04, 1, 0, 48, 0, 0, 0});
  CHECK(bytes_of(skip_if_below(5, Register::kR4, 1)) == Bytes{0xa5, 0x04, 5, 0, 1, 0, 0, 0});
  CHECK(bytes_of(load_map(Register::kR1, 9)) == Bytes{0x18, 0x11, 0, 0, 9, 0, 0, 0});
  CHECK(bytes_of(load_map_end()) == Bytes{0, 0, 0, 0, 0, 0, 0, 0});
  CHECK(bytes_of(call(BPF_FUNC_ktime_get_ns)) == Bytes{0x85, 0, 0, 0, 5, 0, 0, 0});
  CHECK(bytes_of(leave()) == Bytes{0x95, 0, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("stamp programs of two nodes differ in one immediate value") {
  const auto first = send_stamp_program(3, 9);
  const auto second = send_stamp_program(7, 9);

  REQUIRE(first.size() == second.size());
  std::vector<std::pair<std::int32_t, std::int32_t>> differences;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (bytes_of(first[i]) != bytes_of(second[i])) {
      differences.emplace_back(first[i].imm, second[i].imm);
    }
  }
  CHECK(differences == std::vector<std::pair<std::int32_t, std::int32_t>>{{3, 7}});
}

}  // namespace
}  // namespace cuscus::netlink::bpf
