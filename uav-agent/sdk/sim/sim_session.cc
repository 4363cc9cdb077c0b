#include "uav-agent/sdk/sim/sim_session.h"

#include <utility>

namespace cuscus::sdk {
namespace {

proto::AgentConfiguration agent_configuration(ipc::ChildSession& session) {
  proto::Configure configure = session.await_configuration();
  if (!configure.has_agent()) {
    throw ipc::PeerError{"expected the configuration of an agent"};
  }
  return std::move(*configure.mutable_agent());
}

SimVehicle::Memories mapped(ipc::ChildSession& session, std::uint32_t node) {
  using posix::MemoryMapping;
  using proto::Descriptors;
  SimVehicle::Memories memories{
      .clock_page = MemoryMapping::read_only(session.take(Descriptors::KIND_CLOCK_PAGE)),
      .sensors = MemoryMapping::read_only(session.take(Descriptors::KIND_SENSOR_MEMORY, node)),
      .actuators =
          MemoryMapping::read_write(session.take(Descriptors::KIND_ACTUATOR_MEMORY, node))};
  if (const auto fleet = session.take_if_given(Descriptors::KIND_MOTION_CAPTURE_MEMORY)) {
    memories.fleet = MemoryMapping::read_only(*fleet);
  }
  if (const auto radio = session.take_if_given(Descriptors::KIND_RADIO_READINGS, node)) {
    memories.radio = MemoryMapping::read_only(*radio);
  }
  if (const auto camera = session.take_if_given(Descriptors::KIND_CAMERA_MEMORY, node)) {
    memories.camera = MemoryMapping::read_only(*camera);
  }
  return memories;
}

}  // namespace

SimSession::SimSession(ipc::ChildSession& session)
    : session_{session},
      configuration_{agent_configuration(session_)},
      vehicle_{mapped(session_, configuration_.node())} {}

bool SimSession::wait_for_start() {
  session_.ready();
  return session_.await_start().has_value();
}

void SimSession::beat(const std::string& state) {
  session_.beat(to_ns(vehicle_.clock().now()), state);
}

void SimSession::finish(const proto::AgentReport& report) {
  proto::Report envelope;
  *envelope.mutable_agent() = report;
  session_.report(envelope);
}

}  // namespace cuscus::sdk
