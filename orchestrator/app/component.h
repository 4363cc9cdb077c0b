#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "orchestrator/app/control_channel.h"

namespace cuscus::orchestrator {

/// A descriptor that a component is given before its configuration.
struct GivenDescriptor {
  proto::Descriptors::Kind kind;
  std::uint32_t node;
  int fd;
};

/// The orchestrator's view of one process of ours: netsim, world, an agent or the ground station.
class Component {
 public:
  /// `on_change` is called after each message that changes what the queries below answer.
  Component(boost::asio::io_context& loop, std::string name, ipc::ControlSocket socket,
            std::function<void()> on_change);

  /// Gives descriptors, as many messages as they need, then the configuration.
  void configure(const std::vector<GivenDescriptor>& descriptors,
                 const proto::Configure& configure);
  void start(std::int64_t start_monotonic_ns);
  void stop(const std::string& reason);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] bool is_ready() const noexcept { return ready_; }
  /// What it said of itself in its latest heartbeat, as far as it is brief: an agent's flight
  /// state.
  [[nodiscard]] const std::string& state() const noexcept { return state_; }
  /// When it was last heard.
  [[nodiscard]] std::chrono::steady_clock::time_point last_heard() const noexcept {
    return last_heard_;
  }
  [[nodiscard]] const std::optional<proto::Report>& report() const noexcept { return report_; }
  /// The latest of what it would have reported while it ran.
  [[nodiscard]] const std::optional<proto::Report>& report_so_far() const noexcept {
    return so_far_;
  }
  /// Why it failed, in its own words.
  [[nodiscard]] const std::optional<std::string>& failure() const noexcept { return failure_; }
  /// Whether its control socket has closed: it has ended, or is about to.
  [[nodiscard]] bool is_gone() const noexcept { return gone_; }

 private:
  void handle(const proto::Envelope& envelope);

  std::string name_;
  std::function<void()> on_change_;
  bool ready_{false};
  bool gone_{false};
  std::string state_;
  std::optional<proto::Report> report_;
  std::optional<proto::Report> so_far_;
  std::optional<std::string> failure_;
  std::chrono::steady_clock::time_point last_heard_;
  ControlChannel channel_;
};

}  // namespace cuscus::orchestrator
