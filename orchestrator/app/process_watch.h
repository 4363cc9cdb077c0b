#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <functional>
#include <optional>
#include <utility>

#include "common/posix/child_process.h"

namespace cuscus::orchestrator {

/// A child process on the event loop: says when it has ended. The child is killed when this goes.
class ProcessWatch {
 public:
  ProcessWatch(boost::asio::io_context& loop, posix::ChildProcess process,
               std::function<void(posix::ExitStatus)> on_exit)
      : process_{std::move(process)}, pidfd_{loop, process_.pidfd()} {
    pidfd_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                      [this, on_exit = std::move(on_exit)](const boost::system::error_code& error) {
                        if (!error) {
                          pidfd_.release();
                          status_ = process_.wait();
                          on_exit(*status_);
                        }
                      });
  }
  ProcessWatch(const ProcessWatch&) = delete;
  ProcessWatch& operator=(const ProcessWatch&) = delete;
  ~ProcessWatch() {
    if (!status_) {
      // The descriptor belongs to process_; Asio only watched it.
      pidfd_.release();
    }
  }

  /// How it ended; nothing while it runs.
  [[nodiscard]] const std::optional<posix::ExitStatus>& status() const noexcept { return status_; }
  [[nodiscard]] pid_t pid() const noexcept { return process_.pid(); }
  void kill(int signal_number) {
    if (!status_) {
      process_.send_signal(signal_number);
    }
  }

 private:
  posix::ChildProcess process_;
  boost::asio::posix::stream_descriptor pidfd_;
  std::optional<posix::ExitStatus> status_;
};

}  // namespace cuscus::orchestrator
