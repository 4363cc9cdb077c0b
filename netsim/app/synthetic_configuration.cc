#include "netsim/app/synthetic_configuration.h"

#include <array>
#include <stdexcept>
#include <utility>

#include "netsim/app/radio_configuration.h"

namespace cuscus::netsim {

Traffic::Kind traffic_kind(const std::string& name) {
  using Kind = Traffic::Kind;
  static constexpr std::array kKinds{
      std::pair{"beacons", Kind::kBeacons}, std::pair{"saturated", Kind::kSaturated},
      std::pair{"flow", Kind::kFlow}, std::pair{"ping", Kind::kPing}};
  std::string allowed;
  for (const auto& [known, kind] : kKinds) {
    if (name == known) {
      return kind;
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string{known};
  }
  throw std::invalid_argument{"traffic '" + name + "' is unknown; allowed: " + allowed};
}

SyntheticParameters synthetic_parameters(const proto::SyntheticRun& run) {
  const proto::SyntheticTraffic& traffic = run.traffic();
  const auto nodes = static_cast<std::uint32_t>(run.nodes_size());
  if (nodes < 2 || run.radio().nodes_size() != run.nodes_size()) {
    throw std::invalid_argument{"a run needs two nodes or more, and the radio of each"};
  }
  SyntheticParameters p;
  p.air = air_parameters(run.radio());
  p.senders = nodes;
  p.layout.kind = Layout::Kind::kGiven;
  for (const proto::SyntheticNode& node : run.nodes()) {
    p.layout.p_WN_m.emplace_back(node.p_wb_m().x(), node.p_wb_m().y(), node.p_wb_m().z());
    p.layout.q_WN.emplace_back(Eigen::AngleAxisd{node.yaw_rad(), Eigen::Vector3d::UnitZ()});
  }
  p.traffic = {.kind = traffic_kind(traffic.kind()),
               .group = !traffic.unicast(),
               .from = traffic.from(),
               .to = traffic.to(),
               .udp_payload_bytes = traffic.udp_payload_bytes(),
               .period = Duration{traffic.period_ns()},
               .jitter = Duration{traffic.jitter_ns()}};
  const bool pair =
      p.traffic.kind == Traffic::Kind::kFlow || p.traffic.kind == Traffic::Kind::kPing;
  if (pair &&
      (traffic.from() >= nodes || traffic.to() >= nodes || traffic.from() == traffic.to())) {
    throw std::invalid_argument{"traffic '" + traffic.kind() + "' needs two of the run's nodes"};
  }
  p.warm_up = Duration{run.warm_up_ns()};
  p.duration = Duration{run.duration_ns()};
  return p;
}

}  // namespace cuscus::netsim
