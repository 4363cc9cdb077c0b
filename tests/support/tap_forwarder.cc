#include "tests/support/tap_forwarder.h"

#include <poll.h>
#include <unistd.h>

#include <array>

namespace cuscus::test {

TapForwarder::TapForwarder(std::span<const node::Node> nodes) {
  for (const node::Node& node : nodes) {
    taps_.push_back(node.tap_fd());
  }
  thread_ = std::jthread{[this](const std::stop_token& stop) { forward(stop); }};
}

void TapForwarder::forward(const std::stop_token& stop) const {
  constexpr int kLookUpMs = 20;  // how late it may notice that it is to stop
  std::vector<pollfd> sources;
  for (const int tap : taps_) {
    sources.push_back({.fd = tap, .events = POLLIN, .revents = 0});
  }
  std::array<char, 2048> frame{};
  while (!stop.stop_requested()) {
    if (::poll(sources.data(), sources.size(), kLookUpMs) <= 0) {
      continue;
    }
    for (const int from : taps_) {
      ssize_t length = 0;
      while ((length = ::read(from, frame.data(), frame.size())) > 0) {
        for (const int to : taps_) {
          if (to != from) {
            static_cast<void>(!::write(to, frame.data(), static_cast<std::size_t>(length)));
          }
        }
      }
    }
  }
}

}  // namespace cuscus::test
