#include "orchestrator/node/node.h"

#include <poll.h>
#include <sched.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "orchestrator/node/node_identity.h"

namespace cuscus::node {
namespace {

constexpr std::uint32_t kAllPrograms = 0xffffffff;  // Signal::program, control.proto

posix::ChildProcess start_init(const NodeNetwork& network, const InitProgram& program,
                               int control_fd) {
  std::vector<std::string> arguments{program.path, network.name};
  if (network.ipv6) {
    arguments.emplace_back("--ipv6");
  }
  return posix::ChildProcess::spawn({.arguments = std::move(arguments),
                                     .environment = {"PATH=/usr/local/bin:/usr/bin:/bin"},
                                     .working_directory = "/",
                                     .input_fd = program.hosts_fd,
                                     .output_fd = program.output_fd,
                                     .control_fd = control_fd,
                                     .namespaces = kNodeNamespaces});
}

}  // namespace

std::string default_init_path() {
  return std::filesystem::read_symlink("/proc/self/exe").replace_filename("cuscus-init").string();
}

Node Node::start(NodeNetwork network, const InitProgram& program) {
  if (network.index >= kMaximumNodes) {
    throw std::invalid_argument{"node " + std::to_string(network.index) + ": there are at most " +
                                std::to_string(kMaximumNodes) + " nodes"};
  }
  auto [own, init_end] = ipc::ControlSocket::pair();
  return Node{std::move(network), program, std::move(own), std::move(init_end)};
}

Node::Node(NodeNetwork network, const InitProgram& program, ipc::ControlSocket own,
           ipc::ControlSocket init_end)
    : network_{std::move(network)},
      control_{std::move(own)},
      init_{start_init(network_, program, init_end.fd())} {
  namespace_ = posix::NetworkNamespace::of_process(init_.pid());
}

bool Node::await_ready(std::chrono::milliseconds limit) {
  pollfd readable{.fd = control_.fd(), .events = POLLIN, .revents = 0};
  int ready = -1;
  while ((ready = ::poll(&readable, 1, static_cast<int>(limit.count()))) < 0 && errno == EINTR) {
  }
  if (ready <= 0) {
    return false;
  }
  try {
    const auto received = control_.receive();
    if (received.envelope.has_failure()) {
      throw std::runtime_error{received.envelope.failure().text()};
    }
    return true;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error{network_.name + ": " + error.what()};
  }
}

void Node::build_links(const Fabric& fabric, netlink::RouteSocket& fabric_routes,
                       const Surroundings& surroundings) {
  tap_ = node::build_links(network_, *namespace_, fabric, fabric_routes, surroundings);
  monitor_ = build_monitor(network_, *namespace_);
}

netlink::LinkCounters Node::tap_counters(const Fabric& fabric) const {
  return node::tap_counters(network_, *namespace_, fabric);
}

void Node::launch(const proto::Launch& launch, int output_fd, int program_control_fd) {
  proto::Envelope envelope;
  *envelope.mutable_launch() = launch;
  envelope.mutable_launch()->set_has_control_socket(program_control_fd >= 0);
  std::vector<int> descriptors;
  if (output_fd >= 0 || program_control_fd >= 0) {
    // The control socket is the second: without an output of its own, the program gets ours.
    descriptors.push_back(output_fd >= 0 ? output_fd : STDERR_FILENO);
  }
  if (program_control_fd >= 0) {
    descriptors.push_back(program_control_fd);
  }
  try {
    control_.send(envelope, descriptors);
  } catch (const ipc::PeerError&) {
    throw ipc::PeerError{network_.name + ": its init is dead"};
  }
}

void Node::signal(std::uint32_t program, int signal_number) {
  proto::Envelope envelope;
  envelope.mutable_signal()->set_program(program);
  envelope.mutable_signal()->set_signal_number(signal_number);
  try {
    control_.send(envelope);
  } catch (const ipc::PeerError&) {
    return;  // the init is dead, and with it all that could be signalled
  }
}

void Node::signal_all(int signal_number) { signal(kAllPrograms, signal_number); }

std::optional<proto::Envelope> Node::try_receive() {
  auto received = control_.try_receive();
  return received ? std::optional{std::move(received->envelope)} : std::nullopt;
}

void Node::kill() { init_.send_signal(SIGKILL); }

}  // namespace cuscus::node
