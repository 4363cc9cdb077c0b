#include "orchestrator/netlink/bpf_program.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "common/posix/check.h"

namespace cuscus::netlink::bpf {
namespace {

int bpf_call(bpf_cmd command, bpf_attr& attributes) noexcept {
  return static_cast<int>(::syscall(SYS_bpf, command, &attributes, sizeof attributes));
}

/// Object names are at most 15 characters; a longer one is cut.
template <std::size_t Size>
void set_name(char (&field)[Size], const std::string& name) {
  std::copy_n(name.begin(), std::min(name.size(), Size - 1), field);
}

}  // namespace

posix::UniqueFd load_traffic_program(std::span<const bpf_insn> instructions,
                                     const std::string& name) {
  bpf_attr attributes;
  std::memset(&attributes, 0, sizeof attributes);
  attributes.prog_type = BPF_PROG_TYPE_SCHED_CLS;
  attributes.insns = reinterpret_cast<std::uintptr_t>(instructions.data());
  attributes.insn_cnt = static_cast<std::uint32_t>(instructions.size());
  attributes.license = reinterpret_cast<std::uintptr_t>("GPL");
  set_name(attributes.prog_name, name);
  if (const int fd = bpf_call(BPF_PROG_LOAD, attributes); fd >= 0) {
    return posix::UniqueFd{fd};
  }
  const int error = errno;
  // Only now with a log: it slows the verifier down, and a fleet loads a thousand programs.
  std::vector<char> log(std::size_t{64} * 1024);
  attributes.log_buf = reinterpret_cast<std::uintptr_t>(log.data());
  attributes.log_size = static_cast<std::uint32_t>(log.size());
  attributes.log_level = 1;
  if (const int fd = bpf_call(BPF_PROG_LOAD, attributes); fd >= 0) {
    return posix::UniqueFd{fd};
  }
  std::string text = "load BPF program '" + name + "'";
  if (log.front() != '\0') {
    text += ", verifier says:\n" + std::string{log.data()};
  }
  throw std::system_error{error, std::system_category(), text};
}

posix::UniqueFd create_ring_buffer(std::uint32_t byte_size, const std::string& name) {
  bpf_attr attributes;
  std::memset(&attributes, 0, sizeof attributes);
  attributes.map_type = BPF_MAP_TYPE_RINGBUF;
  attributes.max_entries = byte_size;
  set_name(attributes.map_name, name);
  return posix::UniqueFd{
      posix::check("create a BPF ring buffer", bpf_call(BPF_MAP_CREATE, attributes))};
}

}  // namespace cuscus::netlink::bpf
