#include "orchestrator/app/emulator_processor.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "common/posix/network_namespace.h"
#include "common/posix/processors.h"
#include "orchestrator/netlink/receive_steering.h"

namespace cuscus::orchestrator {
namespace {

/// An address that only one socket can have, without a file that would be left behind. Empty when
/// another has it.
posix::UniqueFd reserve_processor(int processor) {
  const std::string name = fmt::format("cuscus-processor-{}", processor);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address.sun_path + 1);  // from 0: an abstract address
  posix::UniqueFd socket{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0) {
    socket.reset();
  }
  return socket;
}

/// Of all processors, since the machine started: the second column of a line each.
std::uint64_t all_backlog_drops() {
  std::ifstream file{"/proc/net/softnet_stat"};
  std::uint64_t drops = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream columns{line};
    std::uint64_t processed = 0;
    std::uint64_t dropped = 0;
    columns >> std::hex >> processed >> dropped;
    drops += dropped;
  }
  return drops;
}

}  // namespace

EmulatorProcessor::EmulatorProcessor(int number, std::vector<int> others,
                                     posix::UniqueFd reservation)
    : number_{number},
      others_{std::move(others)},
      reservation_{std::move(reservation)},
      drops_before_{all_backlog_drops()} {}

std::uint64_t EmulatorProcessor::backlog_drops() const {
  return all_backlog_drops() - drops_before_;
}

std::variant<EmulatorProcessor, netlink::NotAvailable> EmulatorProcessor::reserve() {
  std::vector<int> processors = posix::allowed_processors();
  if (processors.size() < 2) {
    return netlink::NotAvailable{"there is one processor only"};
  }
  try {
    posix::NetworkNamespace::create().run(
        [&] { netlink::steer_receiving("lo", std::span{processors}.last(1)); });
  } catch (const std::system_error& error) {
    return netlink::NotAvailable{error.what()};
  }
  for (auto candidate = processors.begin(); candidate != processors.end(); ++candidate) {
    if (auto reservation = reserve_processor(*candidate)) {
      const int number = *candidate;
      processors.erase(candidate);
      return EmulatorProcessor{number, std::move(processors), std::move(reservation)};
    }
  }
  return netlink::NotAvailable{"other runs have them all"};
}

}  // namespace cuscus::orchestrator
