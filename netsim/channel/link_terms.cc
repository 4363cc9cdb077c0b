#include "netsim/channel/link_terms.h"

namespace cuscus::netsim {
namespace {

std::size_t links_between(std::size_t nodes) { return nodes * (nodes - 1) / 2; }

bool within(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double radius_m) {
  return (p - q).squaredNorm() <= radius_m * radius_m;
}

}  // namespace

LinkTerms::LinkTerms(const Channel& channel, std::uint32_t nodes) : channel_{&channel} {
  if (channel.has_obstacles() && nodes >= 2 && nodes <= kMostNodes) {
    known_.resize(links_between(nodes));
  }
}

StaticTerms LinkTerms::of(const Link& link) {
  if (known_.empty()) {
    return channel_->static_terms(link);
  }
  // Rounding, of distances and where a box begins, takes part of the slack.
  constexpr double kRounding_m = 1e-3;
  Known& known = known_[links_between(link.high) + link.low];
  if (known.any && known.terms_at.p_WL == link.p_WL && known.terms_at.p_WH == link.p_WH) {
    return known.terms;
  }
  if (!known.any || !within(known.nearby_at.p_WL, link.p_WL, kSlack_m - kRounding_m) ||
      !within(known.nearby_at.p_WH, link.p_WH, kSlack_m - kRounding_m)) {
    channel_->look_around(link, kSlack_m, known.nearby);
    known.nearby_at = {link.p_WL, link.p_WH};
  }
  known.terms = channel_->static_terms(link, known.nearby);
  known.terms_at = {link.p_WL, link.p_WH};
  known.any = true;
  return known.terms;
}

}  // namespace cuscus::netsim
