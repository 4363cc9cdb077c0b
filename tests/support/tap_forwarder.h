#pragma once

#include <span>
#include <thread>
#include <vector>

#include "orchestrator/node/node.h"

namespace cuscus::test {

/// A perfect air: copies each frame of one node to all others, on a thread of its own.
class TapForwarder {
 public:
  explicit TapForwarder(std::span<const node::Node> nodes);

 private:
  void forward(const std::stop_token& stop) const;

  std::vector<int> taps_;
  std::jthread thread_;
};

}  // namespace cuscus::test
