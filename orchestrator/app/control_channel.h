#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <functional>
#include <string>

#include "common/ipc/control_socket.h"

namespace cuscus::orchestrator {

/// The orchestrator's end of one control socket, on its event loop.
///
/// Handlers run on the loop. After on_closed nothing more comes; sending then does nothing.
class ControlChannel {
 public:
  /// Read in one go; then the others' turn comes, however much a process sends.
  static constexpr int kMostMessagesAtOnce = 64;

  struct Handlers {
    std::function<void(const proto::Envelope&)> on_message;
    std::function<void(const std::string& why)> on_closed;
  };

  ControlChannel(boost::asio::io_context& loop, ipc::ControlSocket socket, Handlers handlers);
  ControlChannel(const ControlChannel&) = delete;
  ControlChannel& operator=(const ControlChannel&) = delete;
  ~ControlChannel();

  /// Waits for room; false when the other end is gone.
  bool send(const proto::Envelope& envelope, std::span<const int> descriptors = {});

 private:
  void wait();
  void drain();
  void close(const std::string& why);

  ipc::ControlSocket socket_;
  Handlers handlers_;
  boost::asio::posix::stream_descriptor readable_;
  bool open_{true};
};

}  // namespace cuscus::orchestrator
