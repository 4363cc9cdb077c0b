#include "orchestrator/app/link_follower.h"

#include <spdlog/spdlog.h>

#include <exception>

namespace cuscus::orchestrator {

LinkFollower::LinkFollower(boost::asio::io_context& loop, const posix::NetworkNamespace& fabric,
                           const Plan& plan)
    : watch_{netlink::LinkWatch::in(fabric)},
      routes_{netlink::RouteSocket::in(fabric)},
      readable_{loop, watch_.fd()} {
  if (plan.attach == scenario::Attach::kBridge) {
    for (const NodePlan& node : plan.nodes) {
      taps_.emplace(node.veth, Tap{.name = node.tap});
    }
  }
  wait();
}

LinkFollower::~LinkFollower() {
  // The descriptor belongs to watch_; Asio only watched it.
  readable_.release();
}

void LinkFollower::wait() {
  readable_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [this](const boost::system::error_code& error) {
                         if (!error) {
                           follow();
                           wait();
                         }
                       });
}

void LinkFollower::follow() {
  for (const netlink::LinkWatch::Change& change : watch_.take()) {
    const auto found = taps_.find(change.name);
    if (found == taps_.end() || found->second.up == change.has_carrier) {
      continue;
    }
    Tap& tap = found->second;
    tap.up = change.has_carrier;
    try {
      routes_.change_link(tap.name, {.up = tap.up});
    } catch (const std::exception& error) {
      spdlog::warn("{}: what its node does not receive may count as received: {}", tap.name,
                   error.what());
    }
  }
}

}  // namespace cuscus::orchestrator
