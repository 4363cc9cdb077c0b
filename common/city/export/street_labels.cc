#include "common/city/export/street_labels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace cuscus::city {
namespace {

constexpr double kLetterWidth = 0.56;  // of its size, on average in a sans-serif face
constexpr double kSmallest = 5.0;
constexpr double kLargest = 12.0;
constexpr double kOfStreetWidth = 0.75;
constexpr double kStraight = 0.97;  // cos 14 deg
constexpr double kSameNameApart = 400.0;

struct Run {
  Eigen::Vector2d from{Eigen::Vector2d::Zero()};
  Eigen::Vector2d to{Eigen::Vector2d::Zero()};

  [[nodiscard]] double length() const { return (to - from).norm(); }
};

Run longest_straight(const std::vector<Eigen::Vector2d>& axis) {
  Run longest;
  for (std::size_t i = 0; i + 1 < axis.size(); ++i) {
    const Eigen::Vector2d along = (axis[i + 1] - axis[i]).normalized();
    std::size_t end = i + 1;
    while (end + 1 < axis.size() &&
           along.dot((axis[end + 1] - axis[end]).normalized()) > kStraight) {
      ++end;
    }
    if (const Run run{axis[i], axis[end]}; run.length() > longest.length()) {
      longest = run;
    }
  }
  return longest;
}

double text_length(const StreetLabel& label) {
  // Letters beyond ASCII count by their bytes: a little room too much.
  return kLetterWidth * label.size * static_cast<double>(label.name.size());
}

/// Points along the text, a letter's height apart at most.
std::vector<Eigen::Vector2d> points_of(const StreetLabel& label) {
  const double angle_rad = label.angle_deg * std::numbers::pi / 180.0;
  const Eigen::Vector2d along{std::cos(angle_rad), std::sin(angle_rad)};
  const double half = text_length(label) / 2.0;
  std::vector<Eigen::Vector2d> points;
  const auto count = static_cast<int>(2.0 * half / label.size) + 1;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    points.emplace_back(label.middle + along * (i * label.size - half));
  }
  return points;
}

bool collide(const StreetLabel& a, const StreetLabel& b) {
  const double apart = (a.middle - b.middle).norm();
  if (a.name == b.name && apart < kSameNameApart) {
    return true;
  }
  const double size = std::max(a.size, b.size);
  if (apart > (text_length(a) + text_length(b)) / 2.0 + 2.0 * size) {
    return false;
  }
  const auto others = points_of(b);
  for (const Eigen::Vector2d& point : points_of(a)) {
    if (std::any_of(others.begin(), others.end(), [&](const Eigen::Vector2d& other) {
          return (point - other).norm() < 1.2 * size;
        })) {
      return true;
    }
  }
  return false;
}

std::optional<StreetLabel> label_of(const Street& street, const City& city, double units_per_m) {
  const Run run = longest_straight(street.axis_m);
  Eigen::Vector2d along = run.to - run.from;
  if (along.x() < 0.0) {
    along = -along;
  }
  const Eigen::Vector2d middle_m = (run.from + run.to) / 2.0;
  const bool inside = (middle_m.array() >= city.south_west_m.array()).all() &&
                      (middle_m.array() <= city.north_east_m.array()).all();
  const StreetLabel label{
      .name = street.name,
      .middle = Eigen::Vector2d{middle_m.x() - city.south_west_m.x(),
                                city.north_east_m.y() - middle_m.y()} *
                units_per_m,
      .angle_deg = -std::atan2(along.y(), along.x()) * 180.0 / std::numbers::pi,
      .size = std::clamp(kOfStreetWidth * street.width_m * units_per_m, kSmallest, kLargest)};
  if (street.name.empty() || !inside || text_length(label) > run.length() * units_per_m) {
    return std::nullopt;
  }
  return label;
}

}  // namespace

std::vector<StreetLabel> street_labels(const City& city, double units_per_m) {
  std::vector<const Street*> widest_first;
  for (const Street& street : city.streets) {
    widest_first.push_back(&street);
  }
  std::stable_sort(widest_first.begin(), widest_first.end(),
                   [](const Street* a, const Street* b) { return a->width_m > b->width_m; });
  std::vector<StreetLabel> labels;
  for (const Street* street : widest_first) {
    const auto label = label_of(*street, city, units_per_m);
    if (label && std::none_of(labels.begin(), labels.end(),
                              [&](const StreetLabel& other) { return collide(*label, other); })) {
      labels.push_back(*label);
    }
  }
  return labels;
}

}  // namespace cuscus::city
