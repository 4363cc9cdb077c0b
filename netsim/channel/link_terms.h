#pragma once

#include <cstdint>
#include <vector>

#include "netsim/channel/channel.h"

namespace cuscus::netsim {

/// Channel::static_terms() of the links between nodes, to the bit, looked up where that is cheaper:
///
/// - the terms of a link are kept until one of its ends has moved, for both directions;
/// - which buildings and trees a link may meet is kept until one of its ends has gone kSlack_m, and
///   only these are looked at (a list of neighbours: L. Verlet, Physical Review 159, 1967).
///
/// Both are exact: what is asked before, and how often, changes nothing. Without obstacles, and for
/// more than kMostNodes nodes, nothing is kept. Not for several threads at once.
class LinkTerms final {
 public:
  /// How far an end may go before a link is looked around anew. Longer lists cost more at every
  /// look: 4 m is about the best for 1 to 20 m/s (adr/0013).
  static constexpr double kSlack_m = 4.0;
  /// Of n nodes n (n - 1) / 2 links are kept, of some 300 B each.
  static constexpr std::uint32_t kMostNodes = 500;

  /// `channel` must outlive this object.
  LinkTerms(const Channel& channel, std::uint32_t nodes);

  /// Of a link between two of the nodes.
  [[nodiscard]] StaticTerms of(const Link& link);
  [[nodiscard]] Decibel loss(const Link& link) { return of(link).sum(); }

 private:
  /// Where the ends of a link were.
  struct Ends {
    Eigen::Vector3d p_WL;
    Eigen::Vector3d p_WH;
  };
  struct Known {
    Ends terms_at{};
    Ends nearby_at{};
    bool any{false};
    StaticTerms terms{};
    Nearby nearby{};
  };

  const Channel* channel_;
  std::vector<Known> known_;  ///< By the higher node, then the lower.
};

}  // namespace cuscus::netsim
