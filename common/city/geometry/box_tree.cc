#include "common/city/geometry/box_tree.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace cuscus::city {
namespace {

/// A query on its way through Embree, which hands it back with every box.
struct RayQuery : RTCIntersectContext {
  void* call{nullptr};
  bool (*any)(void*, std::uint32_t){nullptr};
  double (*first)(void*, std::uint32_t){nullptr};
  double begin{0.0};  ///< Embree's ray is the part of the caller's from here ...
  double share{1.0};  ///< ... over this share of it.
};

void bounds_of(const RTCBoundsFunctionArguments* asked) {
  const auto& boxes = *static_cast<const std::vector<RTCBounds>*>(asked->geometryUserPtr);
  *asked->bounds_o = boxes[asked->primID];
}

void meet_any(const RTCOccludedFunctionNArguments* met) {
  if (met->valid[0] == 0) {
    return;
  }
  auto* query = static_cast<RayQuery*>(met->context);
  if (query->any(query->call, met->primID)) {
    reinterpret_cast<RTCRay*>(met->ray)->tfar = -std::numeric_limits<float>::infinity();
  }
}

void meet_first(const RTCIntersectFunctionNArguments* met) {
  if (met->valid[0] == 0) {
    return;
  }
  auto* query = static_cast<RayQuery*>(met->context);
  const double limit = query->first(query->call, met->primID);
  // To spare: a share of 1e-6 is more than single precision loses.
  const double far = (limit - query->begin) / query->share * (1.0 + 1e-6) + 1e-6;
  auto& ray = reinterpret_cast<RTCRayHit*>(met->rayhit)->ray;
  ray.tfar = std::min(ray.tfar, static_cast<float>(far));
}

/// What of [0, 1] is within [low, high] on one axis; false if nothing.
bool clip(double& begin, double& end, double start, double way, double low, double high) {
  if (way == 0.0) {
    return start >= low && start <= high;
  }
  const double at_low = (low - start) / way;
  const double at_high = (high - start) / way;
  begin = std::max(begin, std::min(at_low, at_high));
  end = std::min(end, std::max(at_low, at_high));
  return begin <= end;
}

/// The part of the ray that is near the boxes, as Embree wants it; false if there is none.
bool prepare(const Box& bounds, double rounding_m, const Eigen::Vector3d& start,
             const Eigen::Vector3d& way, RayQuery& query, RTCRay& ray) {
  double begin = 0.0;
  double end = 1.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!clip(begin, end, start[axis], way[axis], bounds.low_m[axis] - 2.0 * rounding_m,
              bounds.high_m[axis] + 2.0 * rounding_m)) {
      return false;
    }
  }
  const Eigen::Vector3f origin = (start + begin * way).cast<float>();
  Eigen::Vector3f along = ((end - begin) * way).cast<float>();
  if (along.squaredNorm() == 0.0F) {
    along.z() = static_cast<float>(rounding_m);  // a direction it must have
  }
  query.begin = begin;
  query.share = std::max(end - begin, std::numeric_limits<double>::min());
  ray = {.org_x = origin.x(),
         .org_y = origin.y(),
         .org_z = origin.z(),
         .tnear = 0.0F,
         .dir_x = along.x(),
         .dir_y = along.y(),
         .dir_z = along.z(),
         .time = 0.0F,
         .tfar = 1.0F + 1e-6F,
         .mask = 0xFFFFFFFFU,
         .id = 0,
         .flags = 0};
  return true;
}

struct PointQuery {
  void* call;
  void (*visit)(void*, std::uint32_t);
};

bool meet_around(RTCPointQueryFunctionArguments* met) {
  const auto* query = static_cast<const PointQuery*>(met->userPtr);
  query->visit(query->call, met->primID);
  return false;  // the radius stays
}

}  // namespace

struct BoxTree::Scene {
  std::vector<RTCBounds> boxes;
  RTCDevice device{nullptr};
  RTCScene scene{nullptr};

  explicit Scene(std::vector<RTCBounds> rounded) : boxes{std::move(rounded)} {
    // One thread: no pool is started, and nothing depends on it.
    device = rtcNewDevice("threads=1,set_affinity=0");
    if (device == nullptr) {
      throw std::runtime_error{"Embree: no device (error " +
                               std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))) + ")"};
    }
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
    rtcSetGeometryUserData(geometry, &boxes);
    rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
    rtcSetGeometryIntersectFunction(geometry, meet_first);
    rtcSetGeometryOccludedFunction(geometry, meet_any);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
      const int number = static_cast<int>(error);
      rtcReleaseScene(scene);
      rtcReleaseDevice(device);
      throw std::runtime_error{"Embree: cannot build the tree of a city (error " +
                               std::to_string(number) + ")"};
    }
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

BoxTree::BoxTree(const std::vector<Box>& boxes) : rounding_m_{0.0} {
  if (boxes.empty()) {
    return;
  }
  bounds_ = boxes.front();
  for (const Box& box : boxes) {
    bounds_.low_m = bounds_.low_m.cwiseMin(box.low_m);
    bounds_.high_m = bounds_.high_m.cwiseMax(box.high_m);
  }
  // A coordinate in single precision is off by 2^-24 of itself; origin, direction and Embree's own
  // arithmetic on them by a few of these.
  const double largest_m =
      std::max(bounds_.low_m.cwiseAbs().maxCoeff(), bounds_.high_m.cwiseAbs().maxCoeff());
  rounding_m_ = 0x1p-20 * std::max(largest_m, 1.0);
  std::vector<RTCBounds> rounded;
  rounded.reserve(boxes.size());
  for (const Box& box : boxes) {
    const Eigen::Vector3f low = (box.low_m.array() - rounding_m_).matrix().cast<float>();
    const Eigen::Vector3f high = (box.high_m.array() + rounding_m_).matrix().cast<float>();
    rounded.push_back({.lower_x = low.x(),
                       .lower_y = low.y(),
                       .lower_z = low.z(),
                       .align0 = 0.0F,
                       .upper_x = high.x(),
                       .upper_y = high.y(),
                       .upper_z = high.z(),
                       .align1 = 0.0F});
  }
  scene_ = std::make_unique<Scene>(std::move(rounded));
}

BoxTree::BoxTree(BoxTree&&) noexcept = default;
BoxTree& BoxTree::operator=(BoxTree&&) noexcept = default;
BoxTree::~BoxTree() = default;

bool BoxTree::visit_along(const Eigen::Vector3d& start, const Eigen::Vector3d& way, void* call,
                          bool (*visit)(void*, std::uint32_t)) const {
  RayQuery query;
  RTCRay ray;
  if (!scene_ || !prepare(bounds_, rounding_m_, start, way, query, ray)) {
    return false;
  }
  rtcInitIntersectContext(&query);
  query.call = call;
  query.any = visit;
  rtcOccluded1(scene_->scene, &query, &ray);
  return ray.tfar < 0.0F;
}

void BoxTree::visit_in_order(const Eigen::Vector3d& start, const Eigen::Vector3d& way, void* call,
                             double (*visit)(void*, std::uint32_t)) const {
  RayQuery query;
  RTCRayHit met{};
  if (!scene_ || !prepare(bounds_, rounding_m_, start, way, query, met.ray)) {
    return;
  }
  rtcInitIntersectContext(&query);
  query.call = call;
  query.first = visit;
  met.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &query, &met);
}

void BoxTree::visit_around(const Eigen::Vector3d& p, double radius_m, void* call,
                           void (*visit)(void*, std::uint32_t)) const {
  if (!scene_ || ((p - bounds_.low_m).array() < -radius_m).any() ||
      ((p - bounds_.high_m).array() > radius_m).any()) {
    return;
  }
  const Eigen::Vector3f centre = p.cast<float>();
  RTCPointQuery query{.x = centre.x(),
                      .y = centre.y(),
                      .z = centre.z(),
                      .time = 0.0F,
                      // As much again as a rounded centre so far out may be off.
                      .radius = static_cast<float>(radius_m * (1.0 + 1e-6) + rounding_m_)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  PointQuery visitor{.call = call, .visit = visit};
  rtcPointQuery(scene_->scene, &query, &context, meet_around, &visitor);
}

}  // namespace cuscus::city
