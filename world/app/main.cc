// cuscus-world: physics and sensors of the fleet. Started by 'cuscus run', never by hand.

#include <sys/resource.h>

#include <csignal>
#include <exception>

#include "common/ipc/child_session.h"
#include "common/log/log.h"
#include "world/app/step_host.h"
#include "world/app/step_loop.h"

namespace {

/// Two descriptors per vehicle pass through before Ready: use all that the machine grants.
void raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = limit.rlim_max;
    static_cast<void>(::setrlimit(RLIMIT_NOFILE, &limit));
  }
}

int run() {
  auto session = cuscus::ipc::ChildSession::from_environment();
  try {
    cuscus::world::LinuxStepHost host;
    cuscus::world::run_world(session, host);
    return 0;
  } catch (const cuscus::ipc::PeerError& error) {
    spdlog::error("{}", error.what());
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    session.fail(error.what());
  }
  return 1;
}

}  // namespace

int main() {
  try {
    cuscus::log::start("world");
    // Ctrl-C reaches the whole process group; the orchestrator decides when children stop.
    static_cast<void>(std::signal(SIGINT, SIG_IGN));
    raise_descriptor_limit();
    return run();
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
