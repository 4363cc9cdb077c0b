#pragma once

#include "common/ipc/child_session.h"

namespace cuscus::camera {

/// Everything between the first message and the report: maps, draws, publishes.
/// @throws std::exception for what keeps it from making pictures.
void run_cameras(ipc::ChildSession& session);

}  // namespace cuscus::camera
