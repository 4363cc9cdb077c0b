#include "ground-station/core/link_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace cuscus::gcs {
namespace {

/// Whether `node` ever had a frame to send; without one nobody can have heard it.
bool is_silent(const Observation& observation, std::uint32_t node) {
  return node < observation.tallies.size() && observation.tallies[node] &&
         observation.tallies[node]->offered == 0;
}

/// Joins the two ways of a pair, in place.
void join_pairs(std::vector<Snapshot::Link>& links) {
  std::sort(links.begin(), links.end(), [](const Snapshot::Link& x, const Snapshot::Link& y) {
    return std::tie(x.a, x.b) < std::tie(y.a, y.b);
  });
  auto last = links.begin();
  for (auto way = links.begin(); way != links.end(); ++way) {
    if (way == links.begin()) {
      continue;
    }
    if (way->a == last->a && way->b == last->b) {
      last->received_dbm = std::min(last->received_dbm, way->received_dbm);
      last->rate_kbps = std::min(last->rate_kbps, way->rate_kbps);
      last->age = std::min(last->age, way->age);
      last->one_way = false;
    } else {
      *++last = *way;
    }
  }
  if (!links.empty()) {
    links.erase(std::next(last), links.end());
  }
}

}  // namespace

LinkPicture link_picture(const Observation& observation, SimTime now, std::size_t most) {
  LinkPicture result;
  std::vector<Snapshot::Link>& pairs = result.strongest;
  for (const Observation::Link& link : observation.links) {
    // A frame may carry a time just ahead of the `now` that was taken before the links were read.
    const auto age = std::max(now - link.heard, SimClock::duration{0});
    if (age > kLinkMemory || !std::isfinite(link.received_dbm)) {
      continue;
    }
    pairs.push_back({.a = std::min(link.sender, link.receiver),
                     .b = std::max(link.sender, link.receiver),
                     .received_dbm = static_cast<double>(link.received_dbm),
                     .rate_kbps = link.rate_kbps,
                     .age = age,
                     .one_way = !is_silent(observation, link.receiver)});
    if (link.receiver >= result.hears.size()) {
      result.hears.resize(link.receiver + 1);
    }
    ++result.hears[link.receiver];
  }
  join_pairs(pairs);
  result.left_out = pairs.size() - std::min(pairs.size(), most);
  const auto end = pairs.end() - static_cast<std::ptrdiff_t>(result.left_out);
  std::partial_sort(pairs.begin(), end, pairs.end(),
                    [](const Snapshot::Link& x, const Snapshot::Link& y) {
                      return x.received_dbm > y.received_dbm;
                    });
  pairs.erase(end, pairs.end());
  return result;
}

}  // namespace cuscus::gcs
