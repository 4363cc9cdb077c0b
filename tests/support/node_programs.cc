#include "tests/support/node_programs.h"

#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>

#include "common/posix/check.h"
#include "orchestrator/node/node_identity.h"

namespace cuscus::test {

proto::Launch launch_of(std::uint32_t program, const std::vector<std::string>& arguments) {
  proto::Launch launch;
  launch.set_program(program);
  launch.mutable_arguments()->Assign(arguments.begin(), arguments.end());
  launch.add_environment("PATH=/usr/sbin:/usr/bin:/sbin:/bin");
  launch.set_working_directory("/");
  launch.set_uid(node::node_uid(0));
  launch.set_gid(node::node_uid(0));
  return launch;
}

posix::UniqueFd memory_file() {
  return posix::UniqueFd{posix::check("memfd_create", ::memfd_create("output", MFD_CLOEXEC))};
}

std::string content_of(const posix::UniqueFd& file) {
  std::string text(std::size_t{64} * 1024, '\0');
  text.resize(static_cast<std::size_t>(
      posix::check("pread", ::pread(file.get(), text.data(), text.size(), 0))));
  return text;
}

proto::Envelope next_event(node::Node& node) {
  constexpr int kLimitMs = 10'000;
  for (;;) {
    if (auto event = node.try_receive()) {
      return *event;
    }
    pollfd readable{.fd = node.control_fd(), .events = POLLIN, .revents = 0};
    if (::poll(&readable, 1, kLimitMs) == 0) {
      throw std::runtime_error{"no event from " + node.network().name + " in ten seconds"};
    }
  }
}

proto::Exited await_exit(node::Node& node, std::uint32_t program) {
  for (;;) {
    const auto event = next_event(node);
    if (event.has_exited() && event.exited().program() == program) {
      return event.exited();
    }
  }
}

ProgramRun run_in(node::Node& node, const proto::Launch& launch) {
  const auto output = memory_file();
  node.launch(launch, output.get());
  auto exited = await_exit(node, launch.program());
  return {.exited = std::move(exited), .output = content_of(output)};
}

ProgramRun run_in(node::Node& node, const std::vector<std::string>& arguments) {
  return run_in(node, launch_of(1, arguments));
}

}  // namespace cuscus::test
