// How long a fleet takes to build and to take down. Needs root.
//
//   setup_bench [NODES...]      default: 10 100 500
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <variant>
#include <vector>

#include "orchestrator/netlink/send_stamps.h"
#include "orchestrator/node/fleet.h"
#include "tests/support/namespace_watch.h"
#include "tests/support/test_fleet.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>{Clock::now() - start}.count();
}

void measure(std::size_t count, cuscus::node::Attachment attachment,
             const cuscus::netlink::SendStampRing* stamps) {
  const auto networks = cuscus::test::test_fleet(count, attachment);
  auto start = Clock::now();
  Clock::time_point inits_started;
  cuscus::node::FleetOptions options;
  options.send_stamps = stamps;
  options.on_step = [&](std::string_view step) {
    if (step.ends_with("init")) {
      inits_started = Clock::now();
    }
  };
  std::optional<cuscus::node::Fleet> fleet{std::in_place, networks, options};
  const double set_up_s = seconds_since(start);
  const double inits_s = std::chrono::duration<double>{inits_started - start}.count();
  cuscus::test::NamespaceWatch watch;
  watch.add(fleet->fabric().network_namespace().fd());
  for (const auto& node : fleet->nodes()) {
    watch.add(node.network_namespace().fd());
  }
  start = Clock::now();
  fleet.reset();
  const double tear_down_s = seconds_since(start);
  // Or it would slow the next set-up down.
  static_cast<void>(watch.await_end(std::chrono::minutes{1}));
  std::printf(
      "%-7s %5zu nodes  set-up %6.3f s (inits started %6.3f s)  tear-down %6.3f s (namespaces gone "
      "%6.3f s)\n",
      attachment == cuscus::node::Attachment::kBridge ? "bridge" : "direct", count, set_up_s,
      inits_s, tear_down_s, seconds_since(start));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> counts;
  for (int i = 1; i < argc; ++i) {
    counts.push_back(std::strtoul(argv[i], nullptr, 10));
  }
  if (counts.empty()) {
    counts = {10, 100, 500};
  }
  try {
    const auto stamps = cuscus::netlink::SendStampRing::create();
    const auto* const ring = std::get_if<cuscus::netlink::SendStampRing>(&stamps);
    std::printf("send stamps: %s\n",
                ring != nullptr ? "attached"
                                : std::get<cuscus::netlink::NotAvailable>(stamps).reason.c_str());
    for (const std::size_t count : counts) {
      measure(count, cuscus::node::Attachment::kDirect, ring);
      measure(count, cuscus::node::Attachment::kBridge, ring);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "setup_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
