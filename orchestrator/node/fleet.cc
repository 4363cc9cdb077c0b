#include "orchestrator/node/fleet.h"

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>

#include "common/posix/check.h"
#include "common/posix/open_file_limit.h"

namespace cuscus::node {
namespace {

/// The table of names in a memory file, which every init reads.
posix::UniqueFd write_hosts(std::span<const NodeNetwork> networks) {
  std::vector<HostEntry> entries;
  for (const NodeNetwork& network : networks) {
    entries.push_back({.name = network.name, .address = network.address.address});
  }
  const std::string text = hosts_file(entries);
  posix::UniqueFd file{posix::check("memfd_create", ::memfd_create("cuscus-hosts", MFD_CLOEXEC))};
  for (std::string_view rest = text; !rest.empty();) {
    rest.remove_prefix(static_cast<std::size_t>(
        posix::check("write the table of names", ::write(file.get(), rest.data(), rest.size()))));
  }
  return file;
}

std::vector<netlink::Neighbour> neighbours_of(std::span<const NodeNetwork> networks) {
  std::vector<netlink::Neighbour> neighbours;
  neighbours.reserve(networks.size());
  for (const NodeNetwork& network : networks) {
    neighbours.push_back({.address = network.address.address, .mac = network.mac});
  }
  return neighbours;
}

void tell(const FleetOptions& options, std::string_view step) {
  if (options.on_step) {
    options.on_step(step);
  }
}

void await_ready(Node& node, const FleetOptions& options) {
  constexpr std::chrono::milliseconds kLook{100};
  const auto deadline = std::chrono::steady_clock::now() + options.ready_limit;
  while (!node.await_ready(kLook)) {
    if (options.on_wait) {
      options.on_wait();
    }
    if (std::chrono::steady_clock::now() >= deadline) {
      throw std::runtime_error{node.network().name + ": its init was not ready in " +
                               std::to_string(options.ready_limit.count()) + " ms"};
    }
  }
}

}  // namespace

Fleet::Fleet(std::span<const NodeNetwork> networks, const FleetOptions& options)
    : fabric_{Fabric::create()} {
  tell(options, "fabric");
  const std::uint64_t needed = open_files_for(networks.size());
  if (const auto limit = posix::raise_open_file_limit(needed); limit < needed) {
    throw std::runtime_error{std::to_string(networks.size()) + " nodes need " +
                             std::to_string(needed) + " open files, and the limit is " +
                             std::to_string(limit) + " (ulimit -n)"};
  }
  start_inits(networks, options);
  const auto neighbours =
      options.static_neighbours ? neighbours_of(networks) : std::vector<netlink::Neighbour>{};
  auto fabric_routes = netlink::RouteSocket::in(fabric_.network_namespace());
  for (Node& node : nodes_) {
    await_ready(node, options);
    node.build_links(fabric_, fabric_routes,
                     {.neighbours = neighbours,
                      .send_stamps = options.send_stamps,
                      .receive_processors = options.receive_processors});
    tell(options, node.network().name + " links");
  }
}

void Fleet::start_inits(std::span<const NodeNetwork> networks, const FleetOptions& options) {
  const auto hosts = options.hosts ? write_hosts(networks) : posix::UniqueFd{};
  const InitProgram program{
      .path = options.init_path, .hosts_fd = hosts.get(), .output_fd = options.output_fd};
  nodes_.reserve(networks.size());
  for (const NodeNetwork& network : networks) {
    nodes_.push_back(Node::start(network, program));
    tell(options, network.name + " init");
  }
}

Fleet::~Fleet() {
  // All together: the kernel takes a node's namespaces down while the next ones die.
  for (Node& node : nodes_) {
    try {
      node.kill();
    } catch (const std::exception&) {
      continue;  // its destructor tries again
    }
  }
}

}  // namespace cuscus::node
