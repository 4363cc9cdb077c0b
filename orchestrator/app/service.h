#pragma once

#include <boost/asio/io_context.hpp>
#include <csignal>
#include <functional>
#include <string>

#include "common/posix/child_process.h"
#include "orchestrator/app/component.h"
#include "orchestrator/app/hang_watch.h"
#include "orchestrator/app/process_watch.h"

namespace cuscus::orchestrator {

/// A process of ours that serves the whole run: netsim or the world. Killed when this goes.
class Service {
 public:
  /// Starts `specification`, whose control descriptor is filled in here.
  /// @throws std::system_error when it cannot be started.
  Service(boost::asio::io_context& loop, std::string name, posix::ChildSpecification specification,
          const std::function<void()>& on_change);

  [[nodiscard]] Component& component() noexcept { return component_; }
  [[nodiscard]] const Component& component() const noexcept { return component_; }
  /// How it ended; nothing while it runs.
  [[nodiscard]] const std::optional<posix::ExitStatus>& status() const noexcept {
    return watch_.status();
  }
  void kill() { watch_.kill(SIGKILL); }

  /// Silent for too long, and not for want of the processor. To be asked often.
  [[nodiscard]] bool hangs() {
    return hang_watch_.hangs(component_.last_heard(), std::chrono::steady_clock::now());
  }
  /// Why the run cannot go on with it; empty while it can.
  [[nodiscard]] std::string trouble() const;

 private:
  Service(boost::asio::io_context& loop, std::string name, posix::ChildSpecification specification,
          const std::function<void()>& on_change,
          std::pair<ipc::ControlSocket, ipc::ControlSocket> sockets);

  ProcessWatch watch_;
  Component component_;
  HangWatch hang_watch_{watch_.pid()};
};

/// "exit code 1", "signal 9 (Killed)".
[[nodiscard]] std::string text_of(const posix::ExitStatus& status);

}  // namespace cuscus::orchestrator
