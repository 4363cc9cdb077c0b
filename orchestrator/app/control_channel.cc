#include "orchestrator/app/control_channel.h"

#include <exception>
#include <utility>

namespace cuscus::orchestrator {

ControlChannel::ControlChannel(boost::asio::io_context& loop, ipc::ControlSocket socket,
                               Handlers handlers)
    : socket_{std::move(socket)}, handlers_{std::move(handlers)}, readable_{loop, socket_.fd()} {
  wait();
}

ControlChannel::~ControlChannel() {
  // The descriptor belongs to socket_; Asio only watched it.
  readable_.release();
}

bool ControlChannel::send(const proto::Envelope& envelope, std::span<const int> descriptors) {
  if (!open_) {
    return false;
  }
  try {
    socket_.send(envelope, descriptors);
    return true;
  } catch (const ipc::PeerError&) {
    return false;  // what it sent before it went is still read; then on_closed comes
  }
}

void ControlChannel::wait() {
  readable_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [this](const boost::system::error_code& error) {
                         if (!error) {
                           drain();
                         }
                       });
}

void ControlChannel::drain() {
  try {
    for (int messages = 0; messages < kMostMessagesAtOnce; ++messages) {
      const auto received = socket_.try_receive();
      if (!received) {
        break;
      }
      handlers_.on_message(received->envelope);
    }
  } catch (const ipc::PeerError& error) {
    close(error.what());
    return;
  }
  wait();
}

void ControlChannel::close(const std::string& why) {
  open_ = false;
  handlers_.on_closed(why);
}

}  // namespace cuscus::orchestrator
