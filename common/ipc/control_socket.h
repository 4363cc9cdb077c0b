#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/posix/unique_fd.h"
#include "proto/control.pb.h"

namespace cuscus::ipc {

/// The other end is gone, or sent something that is not an Envelope.
struct PeerError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One end of the socket between the orchestrator and a child: whole messages, with descriptors.
class ControlSocket {
 public:
  /// Descriptors that one message may carry (below the kernel's SCM_MAX_FD, 253).
  static constexpr std::size_t kMaxDescriptors = 200;
  /// Encoded size that one message may have [B].
  static constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 20U;

  struct Received {
    proto::Envelope envelope;
    std::vector<posix::UniqueFd> descriptors;
  };

  /// Takes over a connected SOCK_SEQPACKET socket.
  explicit ControlSocket(posix::UniqueFd fd);

  /// Both ends of a new one; buffers are as large as the kernel allows.
  [[nodiscard]] static std::pair<ControlSocket, ControlSocket> pair();

  /// Sends one message, waiting for room.
  /// @throws PeerError when the other end is gone, std::system_error otherwise.
  void send(const proto::Envelope& envelope, std::span<const int> descriptors = {});

  /// Sends without waiting; false when there was no room (a heartbeat may be lost, a Report not).
  bool try_send(const proto::Envelope& envelope);

  /// The next message; waits for it.
  /// @throws PeerError when the other end closed or sent what is not an Envelope.
  [[nodiscard]] Received receive();

  /// The next message if one is there.
  [[nodiscard]] std::optional<Received> try_receive();

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }
  [[nodiscard]] posix::UniqueFd release() && { return std::move(fd_); }

 private:
  std::optional<Received> receive(int flags);
  bool send(const proto::Envelope& envelope, std::span<const int> descriptors, int flags);

  posix::UniqueFd fd_;
};

}  // namespace cuscus::ipc
