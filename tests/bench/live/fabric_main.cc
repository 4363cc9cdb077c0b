// bench-fabric: the nodes of a run without its emulator, for comparison in scripts/bench-live.
//
// usage: bench-fabric bare|taps N OUTPUT_FOLDER DURATION_S FABRIC_COMMAND -- NODE_COMMAND...
//
// Builds N nodes as `cuscus run` does in bridge mode. With `bare` one kernel bridge joins them all:
// the limit of what any emulator can reach. With `taps` FABRIC_COMMAND (such as "ns3_tap_bridge 10
// 6 30") runs in the fabric's namespace, where it finds TAP devices tap0 ... tap<N-1>. NODE_COMMAND
// runs in each node, with {i} replaced by its number and its output in OUTPUT_FOLDER/<i>.

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/child_process.h"
#include "common/posix/monotonic_clock.h"
#include "orchestrator/node/fleet.h"
#include "orchestrator/node/node_identity.h"

namespace {

using namespace cuscus;  // NOLINT(google-build-using-namespace): a main

constexpr auto kPath = "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin";
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

struct Options {
  bool bare{};
  std::uint32_t count{};
  std::string output;
  std::int64_t duration_s{};
  std::vector<std::string> fabric_command;
  std::vector<std::string> node_command;
};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream{text};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

Options parse(std::span<char* const> args) {
  if (args.size() < 8 || std::string{args[6]} != "--") {
    throw std::invalid_argument{
        "usage: bench-fabric bare|taps N FOLDER DURATION_S FABRIC_COMMAND -- NODE_COMMAND..."};
  }
  return {.bare = std::string{args[1]} == "bare",
          .count = static_cast<std::uint32_t>(std::stoul(args[2])),
          .output = args[3],
          .duration_s = std::stoll(args[4]),
          .fabric_command = words_of(args[5]),
          .node_command = {args.begin() + 7, args.end()}};
}

std::vector<node::NodeNetwork> networks(std::uint32_t count) {
  std::vector<node::NodeNetwork> all;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto high = static_cast<std::uint8_t>((i + 1) >> 8U);
    const auto low = static_cast<std::uint8_t>(i + 1);
    all.push_back({.index = i,
                   .name = "node" + std::to_string(i),
                   .mac = {0x02, 0x63, 0x75, 0x73, high, low},
                   .address = {.address = {10, 42, high, low}, .length = 16},
                   .attachment = node::Attachment::kBridge});
  }
  return all;
}

/// Moves every node's outer end to one bridge of the kernel's.
void join_all(const node::Fleet& fleet) {
  auto routes = netlink::RouteSocket::in(fleet.fabric().network_namespace());
  routes.create_bridge("joined", 1500);
  const std::uint32_t bridge = routes.index_of("joined");
  for (std::size_t i = 0; i < fleet.nodes().size(); ++i) {
    routes.change_link("veth" + std::to_string(i), {.master_index = bridge, .up = true});
  }
}

void launch_in_nodes(node::Fleet& fleet, const Options& options) {
  for (std::uint32_t i = 0; i < options.count; ++i) {
    const std::string file = options.output + "/" + std::to_string(i);
    const posix::UniqueFd output{posix::check(
        "open " + file, ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644))};
    proto::Launch launch;
    launch.set_program(i);
    for (std::string word : options.node_command) {
      if (const auto at = word.find("{i}"); at != std::string::npos) {
        word.replace(at, 3, std::to_string(i));
      }
      launch.add_arguments(word);
    }
    launch.add_environment(kPath);
    launch.set_working_directory("/");
    launch.set_uid(node::node_uid(i));
    launch.set_gid(node::node_uid(i));
    launch.add_capabilities("cap_net_raw");
    fleet.nodes()[i].launch(launch, output.get());
  }
}

/// Waits until all programs have ended, or the time is over.
void await_exits(node::Fleet& fleet, std::int64_t duration_s) {
  const std::int64_t deadline = posix::monotonic_now_ns() + duration_s * kNanosecondsPerSecond;
  std::size_t running = fleet.nodes().size();
  while (running > 0 && posix::monotonic_now_ns() < deadline) {
    std::vector<pollfd> waiting;
    for (const auto& node : fleet.nodes()) {
      waiting.push_back({.fd = node.control_fd(), .events = POLLIN, .revents = 0});
    }
    ::poll(waiting.data(), waiting.size(), 100);
    for (auto& node : fleet.nodes()) {
      while (const auto envelope = node.try_receive()) {
        running -= envelope->has_exited() ? 1U : 0U;
      }
    }
  }
}

int run(const Options& options) {
  const auto specification = networks(options.count);
  node::Fleet fleet{specification, node::FleetOptions{}};
  std::optional<posix::ChildProcess> emulator;
  if (options.bare) {
    join_all(fleet);
  } else {
    for (auto& node : fleet.nodes()) {
      node.close_tap();
    }
    emulator = posix::ChildProcess::spawn(
        {.arguments = options.fabric_command,
         .environment = {kPath},
         .network_namespace_fd = fleet.fabric().network_namespace().fd()});
    // ns-3 builds its nodes before it reads its TAPs; what comes earlier waits in their queues.
    posix::sleep_until_monotonic(posix::monotonic_now_ns() + 3 * kNanosecondsPerSecond);
  }
  launch_in_nodes(fleet, options);
  await_exits(fleet, options.duration_s);
  if (emulator) {
    rusage usage{};
    emulator->send_signal(SIGTERM);
    emulator->wait();
    ::getrusage(RUSAGE_CHILDREN, &usage);
    std::printf("emulator_cpu_s %.3f\n",
                static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                    static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) * 1e-6);
  }
  return 0;
}

}  // namespace

int main(int argc, char* argv[]) try {
  return run(parse(std::span{argv, static_cast<std::size_t>(argc)}));
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench-fabric: %s\n", error.what());
  return 1;
}
