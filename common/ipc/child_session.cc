#include "common/ipc/child_session.h"

#include <fcntl.h>

#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "common/posix/check.h"

namespace cuscus::ipc {

ChildSession ChildSession::from_environment() {
  // Read before any thread exists.
  const char* const text = std::getenv("CUSCUS_CONTROL_FD");  // NOLINT(concurrency-mt-unsafe)
  const std::string_view number = text == nullptr ? "" : text;
  int fd = -1;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), fd);
  if (error != std::errc{} || end != number.data() + number.size() || fd < 0) {
    throw std::runtime_error{
        "CUSCUS_CONTROL_FD is not set: this program is started by 'cuscus run'"};
  }
  posix::check("CUSCUS_CONTROL_FD", ::fcntl(fd, F_SETFD, FD_CLOEXEC));
  return ChildSession{ControlSocket{posix::UniqueFd{fd}}};
}

proto::Configure ChildSession::await_configuration() {
  for (;;) {
    auto received = socket_.receive();
    if (received.envelope.has_configure()) {
      return received.envelope.configure();
    }
    if (!received.envelope.has_descriptors()) {
      throw PeerError{"expected Descriptors or Configure from the orchestrator"};
    }
    keep(received);
  }
}

void ChildSession::keep(ControlSocket::Received& received) {
  const auto& items = received.envelope.descriptors().items();
  if (static_cast<std::size_t>(items.size()) != received.descriptors.size()) {
    throw PeerError{"a Descriptors message names " + std::to_string(items.size()) +
                    " descriptors and carries " + std::to_string(received.descriptors.size())};
  }
  for (int i = 0; i < items.size(); ++i) {
    descriptors_[{items[i].kind(), items[i].node()}] =
        std::move(received.descriptors[static_cast<std::size_t>(i)]);
  }
}

posix::UniqueFd ChildSession::take(proto::Descriptors::Kind kind, std::uint32_t node) {
  if (auto fd = take_if_given(kind, node)) {
    return std::move(*fd);
  }
  throw PeerError{"the orchestrator gave no descriptor of kind " + std::to_string(kind) +
                  " for node " + std::to_string(node)};
}

std::optional<posix::UniqueFd> ChildSession::take_if_given(proto::Descriptors::Kind kind,
                                                           std::uint32_t node) {
  const auto found = descriptors_.find({kind, node});
  if (found == descriptors_.end()) {
    return std::nullopt;
  }
  posix::UniqueFd fd = std::move(found->second);
  descriptors_.erase(found);
  return fd;
}

void ChildSession::ready() {
  proto::Envelope envelope;
  envelope.mutable_ready();
  socket_.send(envelope);
}

std::optional<std::int64_t> ChildSession::await_start() {
  for (;;) {
    const auto received = socket_.receive();
    if (received.envelope.has_start()) {
      return received.envelope.start().start_monotonic_ns();
    }
    if (received.envelope.has_stop()) {
      stop_requested_ = true;
      return std::nullopt;
    }
  }
}

bool ChildSession::stop_requested() {
  while (!stop_requested_) {
    const auto received = socket_.try_receive();
    if (!received) {
      break;
    }
    stop_requested_ = received->envelope.has_stop();
  }
  return stop_requested_;
}

void ChildSession::beat(std::int64_t sim_time_ns, const std::string& state) {
  proto::Envelope envelope;
  envelope.mutable_status()->set_sim_time_ns(sim_time_ns);
  envelope.mutable_status()->set_state(state);
  socket_.try_send(envelope);
}

void ChildSession::beat(std::int64_t sim_time_ns, const proto::Report& so_far) {
  proto::Envelope envelope;
  envelope.mutable_status()->set_sim_time_ns(sim_time_ns);
  *envelope.mutable_status()->mutable_so_far() = so_far;
  socket_.try_send(envelope);
}

void ChildSession::report(const proto::Report& report) {
  proto::Envelope envelope;
  *envelope.mutable_report() = report;
  socket_.send(envelope);
}

void ChildSession::fail(const std::string& text) {
  proto::Envelope envelope;
  envelope.mutable_failure()->set_text(text);
  socket_.send(envelope);
}

}  // namespace cuscus::ipc
