#pragma once

#include <linux/bpf.h>

#include <cstdint>
#include <span>
#include <string>

#include "common/posix/unique_fd.h"

namespace cuscus::netlink::bpf {

/// The ten registers that a program may use, and its read-only frame pointer (r10).
enum class Register : std::uint8_t { kR0, kR1, kR2, kR3, kR4, kR5, kR6, kR7, kR8, kR9, kFrame };

enum class Width : std::uint8_t { kWord = BPF_W, kDoubleWord = BPF_DW };

/// One instruction; the others below name the useful ones.
[[nodiscard]] constexpr bpf_insn instruction(unsigned code, Register destination, Register source,
                                             std::int16_t offset, std::int32_t value) noexcept {
  bpf_insn made{};
  made.code = static_cast<std::uint8_t>(code);
  made.dst_reg = static_cast<unsigned>(destination) & 0xFU;
  made.src_reg = static_cast<unsigned>(source) & 0xFU;
  made.off = offset;
  made.imm = value;
  return made;
}

// Encoders of single instructions (Linux, Documentation/bpf/standardization/instruction-set.rst),
// named by what they do; the destination comes first.

/// to = from
[[nodiscard]] constexpr bpf_insn move(Register to, Register from) noexcept {
  return instruction(BPF_ALU64 | BPF_MOV | BPF_X, to, from, 0, 0);
}

/// to = value, sign-extended
[[nodiscard]] constexpr bpf_insn move(Register to, std::int32_t value) noexcept {
  return instruction(BPF_ALU64 | BPF_MOV | BPF_K, to, Register::kR0, 0, value);
}

/// to += value
[[nodiscard]] constexpr bpf_insn add(Register to, std::int32_t value) noexcept {
  return instruction(BPF_ALU64 | BPF_ADD | BPF_K, to, Register::kR0, 0, value);
}

/// to = *(width*)(base + offset)
[[nodiscard]] constexpr bpf_insn load(Width width, Register to, Register base,
                                      std::int16_t offset) noexcept {
  return instruction(BPF_LDX | BPF_MEM | static_cast<unsigned>(width), to, base, offset, 0);
}

/// *(width*)(base + offset) = from
[[nodiscard]] constexpr bpf_insn store(Width width, Register base, std::int16_t offset,
                                       Register from) noexcept {
  return instruction(BPF_STX | BPF_MEM | static_cast<unsigned>(width), base, from, offset, 0);
}

/// *(width*)(base + offset) = value, sign-extended
[[nodiscard]] constexpr bpf_insn store(Width width, Register base, std::int16_t offset,
                                       std::int32_t value) noexcept {
  return instruction(BPF_ST | BPF_MEM | static_cast<unsigned>(width), base, Register::kR0, offset,
                     value);
}

/// Skips `instructions` when left <= right, unsigned.
[[nodiscard]] constexpr bpf_insn skip_if_at_most(std::int16_t instructions, Register left,
                                                 std::int32_t right) noexcept {
  return instruction(BPF_JMP | BPF_JLE | BPF_K, left, Register::kR0, instructions, right);
}

/// Skips `instructions` when left < right, unsigned.
[[nodiscard]] constexpr bpf_insn skip_if_below(std::int16_t instructions, Register left,
                                               std::int32_t right) noexcept {
  return instruction(BPF_JMP | BPF_JLT | BPF_K, left, Register::kR0, instructions, right);
}

/// First of the two halves of: to = the map behind a descriptor.
[[nodiscard]] constexpr bpf_insn load_map(Register to, std::int32_t map_fd) noexcept {
  static_assert(static_cast<unsigned>(Register::kR1) == BPF_PSEUDO_MAP_FD);
  return instruction(BPF_LD | BPF_DW | BPF_IMM, to, Register::kR1, 0, map_fd);
}

/// Second half of load_map().
[[nodiscard]] constexpr bpf_insn load_map_end() noexcept { return {}; }

/// r0 = helper(r1, ... r5); r1 to r5 are lost.
[[nodiscard]] constexpr bpf_insn call(bpf_func_id helper) noexcept {
  return instruction(BPF_JMP | BPF_CALL, Register::kR0, Register::kR0, 0,
                     static_cast<std::int32_t>(helper));
}

/// return r0
[[nodiscard]] constexpr bpf_insn leave() noexcept {
  return instruction(BPF_JMP | BPF_EXIT, Register::kR0, Register::kR0, 0, 0);
}

/// Loads a program for tc (BPF_PROG_TYPE_SCHED_CLS).
/// @throws std::system_error with the verifier's log when the kernel refuses the program itself.
[[nodiscard]] posix::UniqueFd load_traffic_program(std::span<const bpf_insn> instructions,
                                                   const std::string& name);

/// A ring buffer map (BPF_MAP_TYPE_RINGBUF) of `byte_size`, a power of two and whole pages.
[[nodiscard]] posix::UniqueFd create_ring_buffer(std::uint32_t byte_size, const std::string& name);

}  // namespace cuscus::netlink::bpf
