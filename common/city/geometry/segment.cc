#include "common/city/geometry/segment.h"

#include <algorithm>
#include <tuple>

namespace cuscus::city {
namespace {

bool greater(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::tuple{a.x(), a.y(), a.z()} > std::tuple{b.x(), b.y(), b.z()};
}

}  // namespace

Segment::Segment(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB)
    : a{p_WA}, b{p_WB}, reversed{greater(p_WA, p_WB)} {
  if (reversed) {
    a.swap(b);
  }
}

void unite(Intervals& parts, double seam) {
  if (parts.size() < 2) {
    return;
  }
  std::sort(parts.begin(), parts.end(), [](const Interval& x, const Interval& y) {
    return std::tuple{x.begin, x.end} < std::tuple{y.begin, y.end};
  });
  std::size_t last = 0;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (parts[i].begin <= parts[last].end + seam) {
      parts[last].end = std::max(parts[last].end, parts[i].end);
    } else {
      parts[++last] = parts[i];
    }
  }
  parts.resize(last + 1);
}

void cut_to_segment(Intervals& parts) {
  std::size_t kept = 0;
  for (const Interval& part : parts) {
    const Interval cut{.begin = std::max(part.begin, 0.0), .end = std::min(part.end, 1.0)};
    if (cut.begin < cut.end) {
      parts[kept++] = cut;
    }
  }
  parts.resize(kept);
}

}  // namespace cuscus::city
