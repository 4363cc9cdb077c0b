#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/ipc/control_socket.h"
#include "proto/control.pb.h"

namespace cuscus::ipc {

/// A child's side of its conversation with the orchestrator, in the order of its life:
///
///   auto session = ChildSession::from_environment();
///   const proto::Configure configuration = session.await_configuration();
///   ... map and open what session.take(...) gives ...
///   session.ready();
///   const auto start = session.await_start();
///   while (!session.stop_requested()) { ...; session.beat(now, state); }
///   session.report(...);
///
/// Everything throws PeerError once the orchestrator is gone; main then ends the process.
class ChildSession {
 public:
  explicit ChildSession(ControlSocket socket) : socket_{std::move(socket)} {}

  /// On the socket that CUSCUS_CONTROL_FD names.
  /// @throws std::runtime_error when there is none: the program was started by hand.
  [[nodiscard]] static ChildSession from_environment();

  /// Waits for Configure, keeping the descriptors that come before it.
  [[nodiscard]] proto::Configure await_configuration();

  /// Gives out a descriptor that came before Configure.
  /// @throws PeerError when it did not come.
  [[nodiscard]] posix::UniqueFd take(proto::Descriptors::Kind kind, std::uint32_t node = 0);
  [[nodiscard]] std::optional<posix::UniqueFd> take_if_given(proto::Descriptors::Kind kind,
                                                             std::uint32_t node = 0);

  void ready();

  /// CLOCK_MONOTONIC at SimTime 0 [ns]; nothing when Stop came instead.
  [[nodiscard]] std::optional<std::int64_t> await_start();

  /// Whether Stop has come. Never waits.
  [[nodiscard]] bool stop_requested();

  /// A heartbeat; lost without harm when the orchestrator is slow.
  void beat(std::int64_t sim_time_ns, const std::string& state = {});
  /// One that says what the report would be by now.
  void beat(std::int64_t sim_time_ns, const proto::Report& so_far);

  void report(const proto::Report& report);
  void fail(const std::string& text);

  /// For poll(): readable when stop_requested() has something to read.
  [[nodiscard]] int fd() const noexcept { return socket_.fd(); }

 private:
  void keep(ControlSocket::Received& received);

  ControlSocket socket_;
  std::map<std::pair<proto::Descriptors::Kind, std::uint32_t>, posix::UniqueFd> descriptors_;
  bool stop_requested_{false};
};

}  // namespace cuscus::ipc
