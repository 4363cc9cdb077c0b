#include "ground-station/core/telemetry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "proto/air.pb.h"

namespace cuscus::gcs {
namespace {

constexpr std::size_t kLongestState = 24;
// Clocks of one run agree; what is told cannot have happened later than it is heard.
constexpr SimClock::duration kFutureTolerance = std::chrono::milliseconds{10};

bool is_state(std::string_view text) {
  return !text.empty() && text.size() <= kLongestState &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
         });
}

template <typename Range, typename Predicate>
bool all(const Range& range, Predicate predicate) {
  return std::all_of(range.begin(), range.end(), predicate);
}

}  // namespace

std::variant<TelemetrySample, TelemetryFault> decode_telemetry(std::span<const std::byte> datagram,
                                                               SimTime now) {
  proto::Telemetry message;
  if (datagram.size() > kLongestTelemetry_bytes ||
      !message.ParseFromArray(datagram.data(), static_cast<int>(datagram.size()))) {
    return TelemetryFault::kMalformed;
  }
  const std::array<double, 3> position{message.x_m(), message.y_m(), message.z_m()};
  const std::array<double, 3> velocity{message.vx_mps(), message.vy_mps(), message.vz_mps()};
  const double yaw = message.yaw_rad();
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!all(position, finite) || !all(velocity, finite) || !finite(yaw)) {
    return TelemetryFault::kNotFinite;
  }
  if (!all(position, [](double x) { return std::abs(x) <= kFarthest_m; }) ||
      !all(velocity, [](double v) { return std::abs(v) <= kFastest_mps; }) ||
      std::abs(yaw) > 4 * std::numbers::pi) {
    return TelemetryFault::kOutOfRange;
  }
  if (!is_state(message.state())) {
    return TelemetryFault::kBadState;
  }
  if (message.sim_time_ns() > std::uint64_t{std::numeric_limits<std::int64_t>::max()} ||
      sim_time(static_cast<std::int64_t>(message.sim_time_ns())) > now + kFutureTolerance) {
    return TelemetryFault::kFromTheFuture;
  }
  return TelemetrySample{.node = message.node(),
                         .sequence = message.sequence(),
                         .at = sim_time(static_cast<std::int64_t>(message.sim_time_ns())),
                         .p_WB_m = position,
                         .v_WB_W_mps = velocity,
                         .yaw_rad = yaw,
                         .state = message.state(),
                         .neighbours_heard = message.neighbours_heard()};
}

}  // namespace cuscus::gcs
