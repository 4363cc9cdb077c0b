#include <cstdio>
#include <cstdlib>
#include <exception>

#include "common/ipc/child_session.h"
#include "uav-agent/sdk/periodic_timer.h"
#include "uav-agent/sdk/sim/sim_session.h"

namespace {

/// One line per neighbour: node, frames, RSSI, mean and SNR, rate, age, link budget.
void print_neighbours(const cuscus::sdk::Radio& radio) {
  for (const cuscus::sdk::Neighbour& neighbour : radio.neighbours()) {
    std::printf(
        "neighbour %u frames %llu rssi_dbm %.3f mean_dbm %.3f snr_db %.3f rate_kbps %u "
        "age_s %.3f budget_db %.3f\n",
        neighbour.node, static_cast<unsigned long long>(neighbour.frames), neighbour.received.value,
        neighbour.mean.value, neighbour.snr.value, neighbour.rate_kbps,
        cuscus::to_seconds(neighbour.age), radio.link_budget(neighbour.node).value().value);
  }
  std::fflush(stdout);
}

/// Stands where it is and prints twice a second whom its radio has heard.
void listen(cuscus::ipc::ChildSession& child) {
  using namespace std::chrono_literals;
  cuscus::sdk::SimSession session{child};
  cuscus::sdk::PeriodicTimer look{500ms};
  if (session.wait_for_start()) {
    while (!session.stop_requested()) {
      session.vehicle().clock().sleep_until(look.deadline());
      look.advance(session.vehicle().clock().now());
      print_neighbours(session.vehicle().radio());
      session.beat("standing");
    }
  }
  session.finish({});
}

}  // namespace

int main() {
  try {
    auto child = cuscus::ipc::ChildSession::from_environment();
    listen(child);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "neighbours-agent: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
