#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <map>
#include <string>

#include "common/posix/network_namespace.h"
#include "orchestrator/netlink/link_watch.h"
#include "orchestrator/netlink/route_socket.h"
#include "orchestrator/plan/plan.h"

namespace cuscus::orchestrator {

/// Takes a bridged node's TAP down while its wlan0 is down, and up again: the bridge between them
/// would swallow what the air delivers meanwhile, and it would count as received. With direct
/// attachment the TAP is wlan0 and there is nothing to do.
class LinkFollower {
 public:
  /// From now on, on `loop`; all nodes' links exist and are up.
  LinkFollower(boost::asio::io_context& loop, const posix::NetworkNamespace& fabric,
               const Plan& plan);
  LinkFollower(const LinkFollower&) = delete;
  LinkFollower& operator=(const LinkFollower&) = delete;
  ~LinkFollower();

 private:
  struct Tap {
    std::string name;
    bool up{true};
  };

  void wait();
  void follow();

  netlink::LinkWatch watch_;
  netlink::RouteSocket routes_;
  std::map<std::string, Tap> taps_;  ///< By the name of the veth's outer end.
  boost::asio::posix::stream_descriptor readable_;
};

}  // namespace cuscus::orchestrator
