#include "orchestrator/app/node_crew.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "orchestrator/app/ownership.h"
#include "orchestrator/app/service.h"
#include "orchestrator/node/node_identity.h"

namespace cuscus::orchestrator {
namespace {

using boost::asio::posix::stream_descriptor;

std::string program_name(const NodePlan& node, const Program& program) {
  return program.kind == ProgramKind::kCommand ? node.name + " command" : node.name;
}

}  // namespace

NodeCrew::NodeCrew(boost::asio::io_context& loop, node::Fleet& fleet, Surroundings surroundings,
                   std::function<void()> on_change)
    : loop_{loop},
      fleet_{fleet},
      surroundings_{std::move(surroundings)},
      on_change_{std::move(on_change)} {
  for (const auto& node : surroundings_.plan.nodes) {
    for (const auto& program : node.programs) {
      programs_.push_back({.number = static_cast<std::uint32_t>(programs_.size()),
                           .node = node.index,
                           .name = program_name(node, program),
                           .plan = &program,
                           .component = {},
                           .status = {},
                           .error = {}});
    }
  }
  for (std::uint32_t node = 0; node < fleet_.nodes().size(); ++node) {
    watches_.push_back(
        std::make_unique<stream_descriptor>(loop_, fleet_.nodes()[node].control_fd()));
    watch(node);
  }
}

NodeCrew::~NodeCrew() {
  for (const auto& watch : watches_) {
    watch->release();  // the descriptor belongs to the node
  }
}

void NodeCrew::watch(std::uint32_t node) {
  watches_[node]->async_wait(stream_descriptor::wait_read,
                             [this, node](const boost::system::error_code& error) {
                               if (!error) {
                                 drain(node);
                               }
                             });
}

void NodeCrew::drain(std::uint32_t node) {
  try {
    for (int messages = 0; messages < ControlChannel::kMostMessagesAtOnce; ++messages) {
      const auto envelope = fleet_.nodes()[node].try_receive();
      if (!envelope) {
        break;
      }
      if (envelope->has_exited()) {
        note_exit(envelope->exited());
      }
    }
  } catch (const ipc::PeerError&) {
    const std::string name = surroundings_.plan.nodes[node].name;
    for (auto& program : programs_) {
      if (program.node == node && !program.has_ended()) {
        program.status = posix::ExitStatus{.exit_code = 0, .signal_number = SIGKILL};
      }
    }
    if (trouble_.empty() && !stopping_) {
      trouble_ = name + ": its init is dead, and all its programs with it";
    }
    on_change_();
    return;
  }
  watch(node);
}

void NodeCrew::note_exit(const proto::Exited& exited) {
  if (exited.program() >= programs_.size()) {
    return;
  }
  NodeProgram& program = programs_[exited.program()];
  program.ended_at_s = sim_time_s_ ? sim_time_s_() : 0.0;
  program.ended_early = !stopping_;
  if (!exited.error().empty()) {
    program.error = exited.error();
  } else {
    program.status =
        posix::ExitStatus{.exit_code = exited.exit_code(), .signal_number = exited.signal_number()};
  }
  const bool failed = !program.status || !program.status->succeeded();
  const bool own = program.plan->kind != ProgramKind::kCommand;
  // A program that cannot be started is a mistake in the scenario, whatever its end would mean.
  const bool mistake = !program.error.empty();
  const bool ignored = program.plan->on_exit == scenario::OnExit::kIgnore && !mistake;
  if (!stopping_ && (failed || own) && !ignored) {
    std::string how =
        program.status ? "ended: " + text_of(*program.status) : "did not start: " + program.error;
    if (program.component && program.component->failure()) {
      how += ": " + *program.component->failure();
    }
    spdlog::warn("{} {} at {:.3f} s", program.name, how, program.ended_at_s);
    if (trouble_.empty() && (program.plan->on_exit == scenario::OnExit::kFail || mistake)) {
      trouble_ = program.name + " " + how;
    }
  }
  on_change_();
}

posix::ChildIdentity NodeCrew::identity_of(const NodeProgram& program) const {
  if (surroundings_.rights == node::Rights::kUserNamespace) {
    return {.uid = 0, .gid = 0, .capabilities = program.plan->capabilities};
  }
  const uid_t own = node::node_uid(program.node);
  posix::ChildIdentity identity{.uid = own, .gid = own, .capabilities = program.plan->capabilities};
  if (program.plan->from_scenario) {
    // What the user brings may live in folders that only the user can read, and its files should
    // belong to the user.
    if (const auto user = sudo_caller()) {
      identity.uid = user->uid;
      identity.gid = user->gid;
    }
  }
  return identity;
}

void NodeCrew::launch_own() {
  for (auto& program : programs_) {
    if (program.plan->kind != ProgramKind::kCommand) {
      launch(program);
    }
  }
}

void NodeCrew::launch_commands() {
  for (auto& program : programs_) {
    if (program.plan->kind == ProgramKind::kCommand) {
      launch(program);
    }
  }
}

void NodeCrew::launch(NodeProgram& program) {
  const Program& plan = *program.plan;
  const auto identity = identity_of(program);
  proto::Launch launch;
  launch.set_program(program.number);
  for (const auto& argument : plan.arguments) {
    launch.add_arguments(argument);
  }
  if (!plan.from_scenario) {
    launch.set_arguments(0, (surroundings_.programs / plan.arguments.at(0)).native());
  }
  for (const auto& variable : plan.environment) {
    launch.add_environment(variable);
  }
  launch.set_working_directory(plan.working_directory.empty() ? "/" : plan.working_directory);
  launch.set_uid(identity.uid);
  launch.set_gid(identity.gid);
  for (const auto& capability : identity.capabilities) {
    launch.add_capabilities(capability);
  }
  launch.set_has_control_socket(plan.has_control_socket);
  launch.set_realtime(surroundings_.plan.realtime && plan.has_control_socket);

  const posix::UniqueFd log = surroundings_.directory.create_log(plan.log_name);
  auto& node = fleet_.nodes()[program.node];
  if (!plan.has_control_socket) {
    node.launch(launch, log.get());
  } else {
    auto [own, theirs] = ipc::ControlSocket::pair();
    node.launch(launch, log.get(), theirs.fd());
    program.component =
        std::make_unique<Component>(loop_, program.name, std::move(own), on_change_);
    configure(program);
  }
  program.launched = true;
}

void NodeCrew::configure(NodeProgram& program) {
  using proto::Descriptors;
  const RunMemories& memories = surroundings_.memories;
  const NodePlan& node = surroundings_.plan.nodes[program.node];
  std::vector<GivenDescriptor> given{{Descriptors::KIND_CLOCK_PAGE, 0, memories.clock()}};
  proto::Configure configure;
  if (program.plan->kind == ProgramKind::kAgent) {
    given.push_back({Descriptors::KIND_SENSOR_MEMORY, node.index, memories.sensors(node.index)});
    given.push_back(
        {Descriptors::KIND_ACTUATOR_MEMORY, node.index, memories.actuators(node.index)});
    given.push_back(
        {Descriptors::KIND_RADIO_READINGS, node.index, memories.radio_readings(node.index)});
    if (const int camera = memories.camera(node.index); camera >= 0) {
      given.push_back({Descriptors::KIND_CAMERA_MEMORY, node.index, camera});
    }
    if (node.sees_motion_capture) {
      given.push_back({Descriptors::KIND_MOTION_CAPTURE_MEMORY, 0, memories.motion_capture()});
    }
    *configure.mutable_agent() = node.agent.value();
  } else {
    given.push_back({Descriptors::KIND_FLEET_MEMORY, 0, memories.fleet()});
    given.push_back({Descriptors::KIND_RADIO_MEMORY, 0, memories.radio()});
    if (surroundings_.page_listener >= 0) {
      given.push_back({Descriptors::KIND_PAGE_LISTENER, 0, surroundings_.page_listener});
    }
    if (surroundings_.city >= 0) {
      given.push_back({Descriptors::KIND_CITY, 0, surroundings_.city});
    }
    *configure.mutable_ground_station() = surroundings_.plan.ground_station.value();
    configure.mutable_ground_station()->set_run_id(surroundings_.run_id);
  }
  program.component->configure(given, configure);
}

std::string NodeCrew::not_ready() const {
  std::string names;
  for (const auto& program : programs_) {
    if (program.component && !program.component->is_ready() && !program.has_ended()) {
      names += (names.empty() ? "" : ", ") + program.name;
    }
  }
  return names;
}

void NodeCrew::start(std::int64_t start_monotonic_ns) {
  for (auto& program : programs_) {
    if (program.component) {
      program.component->start(start_monotonic_ns);
    }
  }
}

void NodeCrew::stop(const std::string& reason) {
  stopping_ = true;
  for (auto& program : programs_) {
    if (program.has_ended() || !program.launched) {
      continue;
    }
    if (program.component) {
      program.component->stop(reason);
    } else {
      fleet_.nodes()[program.node].signal(program.number, SIGINT);
    }
  }
}

void NodeCrew::terminate() {
  for (auto& program : programs_) {
    if (program.launched && !program.has_ended() && !program.component) {
      fleet_.nodes()[program.node].signal(program.number, SIGTERM);
    }
  }
}

void NodeCrew::kill() {
  for (auto& program : programs_) {
    if (program.launched && !program.has_ended()) {
      program.killed = true;
      fleet_.nodes()[program.node].signal(program.number, SIGKILL);
    }
  }
}

bool NodeCrew::all_have_ended() const {
  return std::all_of(programs_.begin(), programs_.end(), [](const NodeProgram& program) {
    return !program.launched || program.has_ended();
  });
}

std::string NodeCrew::state_of(std::uint32_t node) const {
  for (const auto& program : programs_) {
    if (program.node == node && program.plan->kind == ProgramKind::kAgent) {
      return program.has_ended() ? "ended" : program.component ? program.component->state() : "";
    }
  }
  return {};
}

}  // namespace cuscus::orchestrator
