#pragma once

#include "common/ipc/child_session.h"
#include "proto/report.pb.h"
#include "world/app/fleet_simulation.h"
#include "world/app/step_host.h"

namespace cuscus::world {

/// Runs `simulation` in real time until the orchestrator says Stop: step k is due k step lengths
/// after `start_monotonic_ns`. A late step is followed at once by those that have become due
/// meanwhile; none is left out, however late. One sleep per step is the only system call; every
/// 20 ms the control socket is looked at, and twice a second a heartbeat is sent.
/// @throws ipc::PeerError when the orchestrator is gone.
proto::WorldReport run_steps(FleetSimulation& simulation, ipc::ChildSession& session,
                             StepHost& host, std::int64_t start_monotonic_ns);

/// The whole life of the process between its first message and its report.
void run_world(ipc::ChildSession& session, StepHost& host);

}  // namespace cuscus::world
