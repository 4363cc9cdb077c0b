// fleet_owner bridge|direct hold STEP    builds three nodes, says "holds" after STEP and waits;
// after
//                                        the last step each node runs a program
// fleet_owner bridge|direct ping         builds three nodes, pings uav2 from uav0, says how it went
//
// What the tests of this folder kill, or run without root.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <variant>

#include "orchestrator/node/fleet.h"
#include "orchestrator/node/rights.h"
#include "tests/support/node_programs.h"
#include "tests/support/tap_forwarder.h"
#include "tests/support/test_fleet.h"

namespace {

using cuscus::node::Attachment;
using cuscus::node::Fleet;
using cuscus::node::Rights;

[[noreturn]] void hold() {
  std::puts("holds");
  std::fflush(stdout);
  for (;;) {
    ::pause();
  }
}

void build_and_hold(Attachment attachment, int stop_after) {
  int done = 0;
  cuscus::node::FleetOptions options;
  options.on_step = [&](std::string_view /*step*/) {
    if (++done == stop_after) {
      hold();
    }
  };
  Fleet fleet{cuscus::test::test_fleet(3, attachment), options};
  for (cuscus::node::Node& node : fleet.nodes()) {
    node.launch(cuscus::test::launch_of(1, {"sh", "-c", "setsid sleep 1000 & sleep 1000"}));
    if (!cuscus::test::next_event(node).has_launched()) {
      throw std::runtime_error{"a program was not launched"};
    }
  }
  hold();
}

int build_and_ping(Attachment attachment, Rights rights) {
  Fleet fleet{cuscus::test::test_fleet(3, attachment), {}};
  const cuscus::test::TapForwarder air{fleet.nodes()};
  auto launch = cuscus::test::launch_of(
      1, {"sh", "-c", "ping -c 2 -i 0.05 -W 5 uav2; echo ping $?; id -u; echo /proc/[0-9]*"});
  if (rights == Rights::kUserNamespace) {
    launch.set_uid(0);
    launch.set_gid(0);
  }
  const auto run = cuscus::test::run_in(fleet.nodes()[0], launch);
  std::printf("%s%s", run.output.c_str(), run.exited.error().c_str());
  return run.exited.exit_code();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    return 2;
  }
  const auto attachment =
      std::string_view{argv[1]} == "direct" ? Attachment::kDirect : Attachment::kBridge;
  try {
    const auto rights = cuscus::node::acquire_rights();
    if (const auto* const missing = std::get_if<cuscus::netlink::NotAvailable>(&rights)) {
      throw std::runtime_error{missing->reason};
    }
    if (std::string_view{argv[2]} == "ping") {
      return build_and_ping(attachment, std::get<Rights>(rights));
    }
    build_and_hold(attachment, argc > 3 ? std::atoi(argv[3]) : 0);
  } catch (const std::exception& error) {
    std::printf("fleet_owner: %s\n", error.what());
    return 1;
  }
  return 0;
}
