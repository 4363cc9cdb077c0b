#include "orchestrator/app/service.h"

#include <fmt/core.h>

#include <csignal>
#include <cstring>
#include <utility>

namespace cuscus::orchestrator {
namespace {

posix::ChildProcess spawn(posix::ChildSpecification specification,
                          const ipc::ControlSocket& child_end) {
  specification.control_fd = child_end.fd();
  return posix::ChildProcess::spawn(specification);
}

}  // namespace

Service::Service(boost::asio::io_context& loop, std::string name,
                 posix::ChildSpecification specification, const std::function<void()>& on_change)
    : Service{loop, std::move(name), std::move(specification), on_change,
              ipc::ControlSocket::pair()} {}

Service::Service(boost::asio::io_context& loop, std::string name,
                 posix::ChildSpecification specification, const std::function<void()>& on_change,
                 std::pair<ipc::ControlSocket, ipc::ControlSocket> sockets)
    : watch_{loop, spawn(std::move(specification), sockets.second),
             [on_change](posix::ExitStatus) { on_change(); }},
      component_{loop, std::move(name), std::move(sockets.first), on_change} {}

std::string Service::trouble() const {
  if (component_.failure()) {
    return component_.name() + ": " + *component_.failure();
  }
  if (status() && !component_.report()) {
    return component_.name() + " ended: " + text_of(*status());
  }
  return {};
}

std::string text_of(const posix::ExitStatus& status) {
  if (status.signal_number == 0) {
    return fmt::format("exit code {}", status.exit_code);
  }
  return fmt::format("signal {} ({})", status.signal_number, ::sigdescr_np(status.signal_number));
}

}  // namespace cuscus::orchestrator
