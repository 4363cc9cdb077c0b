#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace cuscus::city {

struct Box {
  Eigen::Vector3d low_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d high_m{Eigen::Vector3d::Zero()};
};

/// Which of many boxes are near a line or a point. Never misses one; may give some that are only
/// nearly there, as it works in single precision with boxes rounded outwards. By Embree.
class BoxTree final {
 public:
  explicit BoxTree(const std::vector<Box>& boxes);
  BoxTree(const BoxTree&) = delete;
  BoxTree& operator=(const BoxTree&) = delete;
  BoxTree(BoxTree&&) noexcept;
  BoxTree& operator=(BoxTree&&) noexcept;
  ~BoxTree();

  /// Of all boxes.
  [[nodiscard]] const Box& bounds() const { return bounds_; }

  /// Calls `visit(box)` for the boxes that p(t) = start + t way, 0 <= t <= 1, meets, in no order;
  /// until it returns true. Tells whether it has.
  template <class Visit>
  [[nodiscard]] bool any_along(const Eigen::Vector3d& start, const Eigen::Vector3d& way,
                               Visit visit) const {
    return visit_along(start, way, &visit, [](void* call, std::uint32_t box) -> bool {
      return (*static_cast<Visit*>(call))(box);
    });
  }

  /// The same of all of them.
  template <class Visit>
  void along(const Eigen::Vector3d& start, const Eigen::Vector3d& way, Visit visit) const {
    visit_along(start, way, &visit, [](void* call, std::uint32_t box) -> bool {
      (*static_cast<Visit*>(call))(box);
      return false;
    });
  }

  /// Calls `visit(box)` for the boxes that p(t) meets, roughly in the order of t. It returns the
  /// largest t that matters from then on.
  template <class Visit>
  void first_along(const Eigen::Vector3d& start, const Eigen::Vector3d& way, Visit visit) const {
    visit_in_order(start, way, &visit, [](void* call, std::uint32_t box) -> double {
      return (*static_cast<Visit*>(call))(box);
    });
  }

  /// Calls `visit(box)` for the boxes that come as near as `radius_m` to a point.
  template <class Visit>
  void around(const Eigen::Vector3d& p, double radius_m, Visit visit) const {
    visit_around(p, radius_m, &visit,
                 [](void* call, std::uint32_t box) { (*static_cast<Visit*>(call))(box); });
  }

 private:
  struct Scene;

  bool visit_along(const Eigen::Vector3d& start, const Eigen::Vector3d& way, void* call,
                   bool (*visit)(void*, std::uint32_t)) const;
  void visit_in_order(const Eigen::Vector3d& start, const Eigen::Vector3d& way, void* call,
                      double (*visit)(void*, std::uint32_t)) const;
  void visit_around(const Eigen::Vector3d& p, double radius_m, void* call,
                    void (*visit)(void*, std::uint32_t)) const;

  Box bounds_;
  double rounding_m_;  ///< By how much a coordinate may be wrong in single precision.
  std::unique_ptr<Scene> scene_;
};

}  // namespace cuscus::city
