// How a run is set up: LiveRun's beginning.
#include <spdlog/spdlog.h>

#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "common/posix/monotonic_clock.h"
#include "orchestrator/app/live_run.h"
#include "orchestrator/node/node_identity.h"

namespace cuscus::orchestrator {
namespace {

using proto::Descriptors;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kReadyLimit{20'000};
/// From Start to SimTime 0: every child has read its Start by then.
constexpr std::int64_t kStartLead_ns = 100'000'000;

enum Services : std::uint32_t { kWorldService = 0, kNetsimService = 1, kCameraService = 2 };

netlink::Ipv4Address address_of(const std::string& text) {
  const std::uint32_t number = scenario::parse_ipv4(text).value();
  return {static_cast<std::uint8_t>(number >> 24U), static_cast<std::uint8_t>(number >> 16U),
          static_cast<std::uint8_t>(number >> 8U), static_cast<std::uint8_t>(number)};
}

node::Attachment attachment_of(const Plan& plan) {
  return plan.attach == scenario::Attach::kBridge ? node::Attachment::kBridge
                                                  : node::Attachment::kDirect;
}

std::vector<node::NodeNetwork> networks_of(const Plan& plan) {
  std::vector<node::NodeNetwork> networks;
  for (const auto& node : plan.nodes) {
    networks.push_back({.index = node.index,
                        .name = node.name,
                        .mac = node.mac,
                        .address = {.address = address_of(node.ip),
                                    .length = static_cast<std::uint8_t>(plan.subnet.prefix_length)},
                        .mtu_bytes = plan.mtu_bytes,
                        .attachment = attachment_of(plan),
                        .ipv6 = plan.ipv6,
                        .monitor = plan.monitor});
  }
  return networks;
}

/// Of the node's camera, if it has one.
std::optional<shm::PictureShape> pictures_of(std::uint32_t node, const Plan& plan) {
  if (plan.cameras) {
    for (const proto::CameraNode& camera : plan.cameras->cameras()) {
      if (camera.node() == node) {
        return shm::PictureShape{.width_px = camera.width_px(), .height_px = camera.height_px()};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<RunMemories::VehicleNode> LiveRun::vehicles() const {
  std::vector<RunMemories::VehicleNode> vehicles;
  for (const proto::WorldNode& node : plan_.world.nodes()) {
    if (node.has_multirotor()) {
      vehicles.push_back({.node = node.node(),
                          .has_lidar = node.has_lidar(),
                          .pictures = pictures_of(node.node(), plan_)});
    }
  }
  return vehicles;
}

void LiveRun::start_world() {
  const auto log = settings_.directory.create_log("world.log");
  world_ = std::make_unique<Service>(
      loop_, "world", service_specification("cuscus-world", kWorldService, log.get()), [] {});
  std::vector<GivenDescriptor> given{
      {Descriptors::KIND_CLOCK_PAGE, 0, memories_.clock()},
      {Descriptors::KIND_FLEET_MEMORY, 0, memories_.fleet()},
      {Descriptors::KIND_MOTION_CAPTURE_MEMORY, 0, memories_.motion_capture()}};
  for (const auto& [node, has_lidar, pictures] : vehicles()) {
    given.push_back({Descriptors::KIND_SENSOR_MEMORY, node, memories_.sensors(node)});
    given.push_back({Descriptors::KIND_ACTUATOR_MEMORY, node, memories_.actuators(node)});
  }
  if (settings_.city) {
    given.push_back({Descriptors::KIND_CITY, 0, settings_.city.get()});
  }
  proto::Configure configure;
  *configure.mutable_world() = plan_.world;
  world_->component().configure(given, configure);
  await([] { return "the world to be ready"; }, kReadyLimit,
        [&] { return world_->component().is_ready(); });
  memories_.world_has_mapped();
}

void LiveRun::start_camera() {
  if (!plan_.cameras) {
    return;
  }
  const auto log = settings_.directory.create_log("camera.log");
  auto specification = service_specification("cuscus-camera", kCameraService, log.get());
  specification.realtime = false;
  // Its user has no home to keep compiled shaders in; Mesa's software draws in one thread.
  specification.environment.insert(specification.environment.end(),
                                   {"MESA_SHADER_CACHE_DISABLE=true", "LP_NUM_THREADS=0"});
  camera_ = std::make_unique<Service>(loop_, "camera", std::move(specification), [] {});
  std::vector<GivenDescriptor> given{{Descriptors::KIND_FLEET_MEMORY, 0, memories_.fleet()}};
  for (const proto::CameraNode& camera : plan_.cameras->cameras()) {
    given.push_back(
        {Descriptors::KIND_CAMERA_MEMORY, camera.node(), memories_.camera(camera.node())});
  }
  if (settings_.city) {
    given.push_back({Descriptors::KIND_CITY, 0, settings_.city.get()});
  }
  proto::Configure configure;
  *configure.mutable_camera() = *plan_.cameras;
  camera_->component().configure(given, configure);
  await([] { return "the cameras to be ready"; }, kReadyLimit,
        [&] { return camera_->component().is_ready(); });
  memories_.camera_has_mapped();
}

void LiveRun::reserve_processor() {
  if (!plan_.realtime) {
    return;
  }
  auto reserved = EmulatorProcessor::reserve();
  if (auto* const processor = std::get_if<EmulatorProcessor>(&reserved)) {
    processor_.emplace(std::move(*processor));
  } else {
    spdlog::warn("netsim gets no processor for itself ({}): large fleets may be late",
                 std::get<netlink::NotAvailable>(reserved).reason);
  }
}

void LiveRun::build_nodes() {
  auto ring = netlink::SendStampRing::create();
  if (auto* const made = std::get_if<netlink::SendStampRing>(&ring)) {
    send_stamps_.emplace(std::move(*made));
    send_stamps_text_ = "tc-bpf";
  } else {
    send_stamps_text_ = std::get<netlink::NotAvailable>(ring).reason;
    spdlog::warn("send stamps are not available ({}): frames enter the air when they are read",
                 send_stamps_text_);
  }
  const auto look = [this] {
    serve();
    check_trouble();
  };
  const auto receive_processors = processor_ ? processor_->others() : std::span<const int>{};
  fleet_ = std::make_unique<node::Fleet>(
      networks_of(plan_), node::FleetOptions{.init_path = settings_.programs / "cuscus-init",
                                             .static_neighbours = plan_.static_neighbours,
                                             .hosts = !plan_.hosts.empty(),
                                             .send_stamps = send_stamps_ ? &*send_stamps_ : nullptr,
                                             .receive_processors = receive_processors,
                                             .on_step = [look](std::string_view) { look(); },
                                             .on_wait = look});
  canary_ = std::make_unique<node::Canary>(
      fleet_->fabric(), static_cast<std::uint32_t>(plan_.nodes.size()), attachment_of(plan_),
      node::Surroundings{.send_stamps = send_stamps_ ? &*send_stamps_ : nullptr,
                         .receive_processors = receive_processors});
  links_ = std::make_unique<LinkFollower>(loop_, fleet_->fabric().network_namespace(), plan_);
  if (on_nodes_built_) {
    on_nodes_built_();
  }
}

void LiveRun::start_netsim() {
  const auto log = settings_.directory.create_log("netsim.log");
  auto specification = service_specification("cuscus-netsim", kNetsimService, log.get());
  specification.network_namespace_fd = fleet_->fabric().network_namespace().fd();
  netsim_ = std::make_unique<Service>(loop_, "netsim", std::move(specification), [] {});
  std::vector<GivenDescriptor> given{{Descriptors::KIND_CLOCK_PAGE, 0, memories_.clock()},
                                     {Descriptors::KIND_FLEET_MEMORY, 0, memories_.fleet()},
                                     {Descriptors::KIND_RADIO_MEMORY, 0, memories_.radio()}};
  if (send_stamps_) {
    given.push_back({Descriptors::KIND_SEND_STAMP_RING, 0, send_stamps_->fd()});
  }
  if (settings_.city) {
    given.push_back({Descriptors::KIND_CITY, 0, settings_.city.get()});
  }
  if (settings_.frame_log) {
    given.push_back({Descriptors::KIND_FRAME_LOG, 0, settings_.frame_log.get()});
  }
  for (const auto& [node, has_lidar, pictures] : vehicles()) {
    given.push_back({Descriptors::KIND_RADIO_READINGS, node, memories_.radio_readings(node)});
  }
  if (settings_.reception_log) {
    given.push_back({Descriptors::KIND_RECEPTION_LOG, 0, settings_.reception_log.get()});
  }
  for (const auto& [node, file] : settings_.captures) {
    given.push_back({Descriptors::KIND_CAPTURE, node, file.get()});
  }
  for (const auto& node : fleet_->nodes()) {
    given.push_back({Descriptors::KIND_TAP, node.network().index, node.tap_fd()});
    given.push_back({Descriptors::KIND_MONITOR, node.network().index, node.monitor_fd()});
  }
  for (std::uint32_t end = 0; end < 2; ++end) {
    given.push_back({Descriptors::KIND_TAP, static_cast<std::uint32_t>(plan_.nodes.size()) + end,
                     canary_->tap_fd(end)});
  }
  proto::Configure configure;
  *configure.mutable_radio() = plan_.radio;
  configure.mutable_radio()->set_canary_delay_ns(node::Canary::kDelay.count());
  if (processor_) {
    configure.mutable_radio()->set_processor(processor_->number());
  }
  netsim_->component().configure(given, configure);
  await([] { return "netsim to be ready"; }, kReadyLimit,
        [&] { return netsim_->component().is_ready(); });
  memories_.netsim_has_mapped();
  settings_.captures.clear();
}

void LiveRun::start_programs() {
  crew_ = std::make_unique<NodeCrew>(
      loop_, *fleet_,
      NodeCrew::Surroundings{.plan = plan_,
                             .memories = memories_,
                             .rights = settings_.rights,
                             .programs = settings_.programs,
                             .directory = settings_.directory,
                             .run_id = settings_.run_id,
                             .page_listener = settings_.page_listener.get(),
                             .city = settings_.city.get()},
      [] {});
  crew_->launch_own();
  await([&] { return crew_->not_ready() + " to be ready"; }, kReadyLimit,
        [&] { return crew_->own_are_ready(); });
  settings_.page_listener.reset();
}

void LiveRun::start_clock() {
  crew_->set_clock([this] { return sim_time_s(); });
  start_monotonic_ns_ = posix::monotonic_now_ns() + kStartLead_ns;
  memories_.start(start_monotonic_ns_);
  world_->component().start(start_monotonic_ns_);
  netsim_->component().start(start_monotonic_ns_);
  if (camera_) {
    camera_->component().start(start_monotonic_ns_);
  }
  crew_->start(start_monotonic_ns_);
  const auto start = steady_clock::time_point{std::chrono::nanoseconds{start_monotonic_ns_}};
  while (steady_clock::now() < start) {
    wait_step(start);
    check_trouble();
  }
  crew_->launch_commands();
  canary_->start();
}

posix::ChildSpecification LiveRun::service_specification(const char* program, std::uint32_t service,
                                                         int output_fd) const {
  const uid_t uid = settings_.rights == node::Rights::kRoot ? node::service_uid(service) : 0;
  return {.arguments = {settings_.programs / program},
          .environment = {"PATH=/usr/bin:/bin"},
          .working_directory = "/",
          .output_fd = output_fd,
          .identity = posix::ChildIdentity{.uid = uid, .gid = uid},
          .realtime = plan_.realtime,
          .open_files = 65'536};
}

}  // namespace cuscus::orchestrator
