// cuscus-camera: pictures of all cameras of a run. Started by 'cuscus run', never by hand.

#include <csignal>
#include <exception>

#include "camera/app/camera_loop.h"
#include "common/ipc/child_session.h"
#include "common/log/log.h"
#include "common/posix/scheduling.h"

namespace {

int run() {
  auto session = cuscus::ipc::ChildSession::from_environment();
  try {
    cuscus::camera::run_cameras(session);
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
    cuscus::log::start("camera");
    // Ctrl-C reaches the whole process group; the orchestrator decides when children stop.
    static_cast<void>(std::signal(SIGINT, SIG_IGN));
    // Before OpenGL starts threads of its own, which inherit it.
    cuscus::posix::give_way_to_others();
    return run();
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
