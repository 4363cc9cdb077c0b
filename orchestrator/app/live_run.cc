#include "orchestrator/app/live_run.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <stdexcept>
#include <utility>

#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "orchestrator/node/node_identity.h"
#include "orchestrator/results/fidelity.h"

namespace cuscus::orchestrator {
namespace {

using proto::Descriptors;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kReadyLimit{20'000};
/// From Start to SimTime 0: every child has read its Start by then.
constexpr std::int64_t kStartLead_ns = 100'000'000;
/// Together below the five seconds in which an interrupted run has to be over.
constexpr milliseconds kCrewStopLimit{1'500};
constexpr milliseconds kTerminateLimit{700};
constexpr milliseconds kKillLimit{500};
constexpr milliseconds kServiceStopLimit{1'500};
constexpr milliseconds kProgressPeriod{200};
constexpr milliseconds kServiceTurn{10};

enum Services : std::uint32_t { kWorldService = 0, kNetsimService = 1 };

struct RunFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct RunInterrupted {};
/// It is late, and the scenario wants no such run.
struct RunLate : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::vector<std::uint32_t> vehicles_of(const Plan& plan) {
  std::vector<std::uint32_t> vehicles;
  for (const auto& node : plan.nodes) {
    if (node.role == NodeRole::kUav) {
      vehicles.push_back(node.index);
    }
  }
  return vehicles;
}

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

/// As nohup(1) leaves SIGHUP, so that the terminal may be closed.
bool is_ignored(int signal_number) {
  struct sigaction action {};
  posix::check("sigaction", ::sigaction(signal_number, nullptr, &action));
  return action.sa_handler == SIG_IGN;
}

}  // namespace

LiveRun::LiveRun(const Plan& plan, RunSettings settings)
    : plan_{plan},
      settings_{std::move(settings)},
      signals_{loop_, SIGINT, SIGTERM},
      memories_{static_cast<std::uint32_t>(plan.nodes.size()), vehicles_of(plan)} {
  if (!is_ignored(SIGHUP)) {
    signals_.add(SIGHUP);
  }
  watch_signals();
}

LiveRun::~LiveRun() = default;

template <typename Body>
bool LiveRun::guarded(const Body& body) {
  try {
    body();
    return true;
  } catch (const RunInterrupted&) {
    end_.kind = FlightEnd::Kind::kInterrupted;
    end_.signal_number = signal_number_;
  } catch (const RunLate& late) {
    end_.kind = FlightEnd::Kind::kStoppedLate;
    end_.reason = late.what();
  } catch (const std::exception& error) {
    end_.kind = FlightEnd::Kind::kFailed;
    end_.reason = error.what();
  }
  end_.flown_s = sim_time_s();
  return false;
}

bool LiveRun::set_up() {
  return guarded([&] {
    start_world();
    reserve_processor();
    build_nodes();
    start_netsim();
    start_programs();
  });
}

void LiveRun::fly(const OnSample& on_sample) {
  guarded([&] {
    start_clock();
    Progress progress{plan_.duration};
    const auto start = steady_clock::time_point{std::chrono::nanoseconds{start_monotonic_ns_}};
    const auto finish = start + plan_.duration;
    auto next_sample = start;
    auto next_progress = start;
    auto last_look = start;
    while (steady_clock::now() < finish) {
      wait_step(std::min({next_sample, next_progress, finish}));
      check_trouble();
      const auto now = steady_clock::now();
      longest_gap_ = std::max(longest_gap_, std::chrono::nanoseconds{now - last_look});
      last_look = now;
      if (now >= next_sample) {
        on_sample(sim_time_s());
        // What a slow disk has missed is missed, not made up for.
        next_sample += plan_.metrics_period * ((now - next_sample) / plan_.metrics_period + 1);
      }
      if (now >= next_progress) {
        check_heartbeats();
        check_validity();
        progress.show(now - start, progress_text());
        next_progress = now + kProgressPeriod;
      }
    }
    end_.flown_s = std::chrono::duration<double>{plan_.duration}.count();
  });
  const double flown_s = end_.flown_s;
  guarded([&] { stop_all(); });
  end_.flown_s = flown_s;
}

void LiveRun::start_world() {
  const auto log = settings_.directory.create_log("world.log");
  world_ = std::make_unique<Service>(
      loop_, "world", service_specification("cuscus-world", kWorldService, log.get()), [] {});
  std::vector<GivenDescriptor> given{
      {Descriptors::KIND_CLOCK_PAGE, 0, memories_.clock()},
      {Descriptors::KIND_FLEET_MEMORY, 0, memories_.fleet()},
      {Descriptors::KIND_MOTION_CAPTURE_MEMORY, 0, memories_.motion_capture()}};
  for (const std::uint32_t node : vehicles_of(plan_)) {
    given.push_back({Descriptors::KIND_SENSOR_MEMORY, node, memories_.sensors(node)});
    given.push_back({Descriptors::KIND_ACTUATOR_MEMORY, node, memories_.actuators(node)});
  }
  proto::Configure configure;
  *configure.mutable_world() = plan_.world;
  world_->component().configure(given, configure);
  await([] { return "the world to be ready"; }, kReadyLimit,
        [&] { return world_->component().is_ready(); });
  memories_.world_has_mapped();
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
  if (settings_.frame_log) {
    given.push_back({Descriptors::KIND_FRAME_LOG, 0, settings_.frame_log.get()});
  }
  for (const std::uint32_t node : vehicles_of(plan_)) {
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
                             .page_listener = settings_.page_listener.get()},
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
  crew_->start(start_monotonic_ns_);
  const auto start = steady_clock::time_point{std::chrono::nanoseconds{start_monotonic_ns_}};
  while (steady_clock::now() < start) {
    wait_step(start);
    check_trouble();
  }
  crew_->launch_commands();
  canary_->start();
}

void LiveRun::stop_all() {
  if (canary_) {
    canary_->stop();
  }
  if (const auto& fleet = memories_.fleet_reader()) {
    for (const auto& node : plan_.nodes) {
      commands_.push_back(fleet->commands(node.index));
    }
  }
  const std::string reason =
      end_.kind == FlightEnd::Kind::kCompleted ? "the flight is over" : "the run has ended early";
  if (crew_) {
    crew_->stop(reason);
    const auto ended = [&] { return crew_->all_have_ended(); };
    if (!settle(kCrewStopLimit, ended)) {
      crew_->terminate();
      if (!settle(kTerminateLimit, ended)) {
        crew_->kill();
        settle(kKillLimit, ended);
      }
    }
  }
  for (Service* const service : {netsim_.get(), world_.get()}) {
    if (service != nullptr) {
      service->component().stop(reason);
    }
  }
  settle(kServiceStopLimit,
         [&] { return (!netsim_ || netsim_->status()) && (!world_ || world_->status()); });
}

void LiveRun::watch_signals() {
  signals_.async_wait([this](const boost::system::error_code& error, int number) {
    if (error) {
      return;
    }
    if (signal_number_ == 0) {
      signal_number_ = number;
    }
    ++signals_seen_;
    watch_signals();
  });
}

void LiveRun::check_trouble() const {
  if (signal_number_ != 0) {
    throw RunInterrupted{};
  }
  for (const Service* const service : {world_.get(), netsim_.get()}) {
    if (service != nullptr) {
      if (const auto trouble = service->trouble(); !trouble.empty()) {
        throw RunFailed{trouble};
      }
    }
  }
  if (crew_ && !crew_->trouble().empty()) {
    throw RunFailed{crew_->trouble()};
  }
}

void LiveRun::check_heartbeats() {
  for (Service* const service : {world_.get(), netsim_.get()}) {
    if (service->hangs()) {
      throw RunFailed{fmt::format("{} hangs: no heartbeat for {} s", service->component().name(),
                                  HangWatch::kSilenceLimit.count())};
    }
  }
}

void LiveRun::check_validity() {
  const auto& radio = netsim_->component().report_so_far();
  const auto& world = world_->component().report_so_far();
  if (lost_validity_ || !radio || !world) {
    return;
  }
  FidelityInputs so_far;
  so_far.radio = radio->radio();
  so_far.world = world->world();
  so_far.longest_supervision_gap = longest_gap_;
  so_far.realtime_wanted = plan_.realtime;
  so_far.flown_share =
      std::clamp(sim_time_s() / std::chrono::duration<double>{plan_.duration}.count(), 1e-9, 1.0);
  if (const auto reason = lost_validity(so_far)) {
    lost_validity_ = true;
    if (plan_.on_late == scenario::OnLate::kStop) {
      throw RunLate{"cannot become VALID any more: " + *reason};
    }
    spdlog::warn("since {:.1f} s the run cannot become VALID any more: {}", sim_time_s(), *reason);
  }
}

void LiveRun::await(const std::function<std::string()>& what, milliseconds limit,
                    const std::function<bool()>& done) {
  const auto deadline = steady_clock::now() + limit;
  while (!done()) {
    check_trouble();
    if (steady_clock::now() >= deadline) {
      throw RunFailed{fmt::format("waited {} s in vain for {}", limit.count() / 1000, what())};
    }
    wait_step(std::min(deadline, steady_clock::now() + milliseconds{100}));
  }
}

bool LiveRun::settle(milliseconds limit, const std::function<bool()>& done) {
  const auto deadline = steady_clock::now() + limit;
  while (!done() && steady_clock::now() < deadline && signals_seen_ < 2) {
    wait_step(deadline);
  }
  return done();
}

void LiveRun::wait_step(steady_clock::time_point deadline) {
  loop_.restart();
  loop_.run_one_until(deadline);
  serve();  // also after the deadline, such as when this process was stopped for a while
}

void LiveRun::serve() {
  // Whoever floods its control socket always has something ready.
  const auto enough = steady_clock::now() + kServiceTurn;
  while (loop_.poll_one() > 0 && steady_clock::now() < enough) {
  }
}

double LiveRun::sim_time_s() const {
  return start_monotonic_ns_ == 0
             ? 0.0
             : std::max(0.0, static_cast<double>(posix::monotonic_now_ns() - start_monotonic_ns_) *
                                 1e-9);
}

std::string LiveRun::progress_text() const {
  std::size_t flying = 0;
  std::size_t agents = 0;
  for (const auto& node : plan_.nodes) {
    if (node.agent) {
      ++agents;
      flying += crew_->state_of(node.index) == "flying" ? 1U : 0U;
    }
  }
  std::string text = fmt::format("{}/{} flying", flying, agents);
  if (const auto timing = memories_.radio_reader()->timing()) {
    text += fmt::format(", {} receptions, late p99 {:.3f} ms", timing->releases,
                        static_cast<double>(timing->release_lateness_p99_ns) * 1e-6);
  }
  return text;
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

std::vector<std::uint64_t> LiveRun::tap_drops() const {
  std::vector<std::uint64_t> drops;
  if (fleet_) {
    for (const auto& node : fleet_->nodes()) {
      try {
        drops.push_back(node.tap_counters(fleet_->fabric()).send_drops);
      } catch (const std::exception&) {
        drops.push_back(0);  // its program has deleted the interface: nothing can be lost there
      }
    }
  }
  return drops;
}

std::optional<shm::CommandTally> LiveRun::commands(std::uint32_t node) const {
  return node < commands_.size() ? commands_[node] : std::nullopt;
}

std::vector<pid_t> LiveRun::init_pids() const {
  std::vector<pid_t> pids;
  if (fleet_) {
    for (const auto& node : fleet_->nodes()) {
      pids.push_back(node.init_pid());
    }
  }
  return pids;
}

}  // namespace cuscus::orchestrator
