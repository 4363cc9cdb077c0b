// cuscus-gcs: the operator's ground station. Started by the orchestrator.

#include <google/protobuf/stubs/logging.h>

#include <csignal>
#include <exception>

#include "common/ipc/child_session.h"
#include "common/log/log.h"
#include "ground-station/app/ground_station.h"

namespace {

using namespace cuscus;

void run(ipc::ChildSession& session) {
  const proto::Configure configure = session.await_configuration();
  if (!configure.has_ground_station()) {
    throw ipc::PeerError{"the configuration is not one of a ground station"};
  }
  gcs::GroundStation station{session, configure.ground_station()};
  session.ready();
  if (const auto start = session.await_start()) {
    station.run(*start);
  }
  proto::Report report;
  *report.mutable_ground_station() = station.report();
  spdlog::info("telemetry: {} received, {} rejected; page: {} clients",
               report.ground_station().telemetry_received(),
               report.ground_station().telemetry_rejected(),
               report.ground_station().page_clients());
  session.report(report);
}

}  // namespace

int main() {
  try {
    log::start("gcs");
    // Whoever sends garbage to the telemetry port would write our log full: it is counted instead.
    google::protobuf::SetLogHandler(nullptr);
    // Ctrl-C in the orchestrator's terminal reaches us as well; the orchestrator says when to stop.
    std::signal(SIGINT, SIG_IGN);
    auto session = ipc::ChildSession::from_environment();
    try {
      run(session);
      return 0;
    } catch (const ipc::PeerError&) {
      throw;
    } catch (const std::exception& error) {
      session.fail(error.what());
      throw;
    }
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
