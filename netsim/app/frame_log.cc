#include "netsim/app/frame_log.h"

#include <utility>

namespace cuscus::netsim {
namespace {

/// At 20 000 frames per second, three seconds of a stalled disk.
constexpr std::size_t kFrameCapacity = std::size_t{1} << 16U;

}  // namespace

FrameLog::FrameLog(posix::UniqueFd file, const AirParameters& parameters)
    : writer_{std::move(file), frame_log_header(parameters), kFrameCapacity} {}

}  // namespace cuscus::netsim
