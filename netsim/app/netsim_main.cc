// cuscus-netsim: the air between the interfaces of a run. Started by the orchestrator, which gives
// it everything it works with; needs no privileges of its own.
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/city/transfer/city_message.h"
#include "common/ipc/child_session.h"
#include "common/log/log.h"
#include "common/posix/processors.h"
#include "common/posix/scheduling.h"
#include "common/posix/shared_memory.h"
#include "netsim/app/city_of_message.h"
#include "netsim/app/fleet_positions.h"
#include "netsim/app/live_air.h"
#include "netsim/app/radio_configuration.h"
#include "proto/shm/clock_page.h"

namespace {

using cuscus::SimTime;
using cuscus::ipc::ChildSession;
using cuscus::posix::MemoryMapping;
namespace netsim = cuscus::netsim;
namespace posix = cuscus::posix;
namespace proto = cuscus::proto;
namespace shm = cuscus::shm;

/// Joins the live air to the orchestrator, and watches that the world moves.
class Session final : public netsim::LiveOwner {
 public:
  Session(ChildSession& child, const shm::FleetMemoryReader& fleet, const netsim::LiveAir& air)
      : child_{&child}, fleet_{&fleet}, air_{&air} {}

  [[nodiscard]] int fd() const override { return child_->fd(); }
  [[nodiscard]] bool should_stop() override { return child_->stop_requested(); }

  void beat(SimTime now) override {
    proto::Report so_far;
    *so_far.mutable_radio() = air_->report();
    child_->beat(cuscus::to_ns(now), so_far);
    const std::uint64_t steps = fleet_->steps();
    if (steps != steps_) {
      steps_ = steps;
      moved_at_ = now;
    } else if (now - moved_at_ > std::chrono::seconds{1} && !warned_) {
      warned_ = true;
      spdlog::warn("the world has stood still at step {} for {:.1f} s: positions are old", steps,
                   cuscus::to_seconds(now - moved_at_));
    }
  }

 private:
  ChildSession* child_;
  const shm::FleetMemoryReader* fleet_;
  const netsim::LiveAir* air_;
  std::uint64_t steps_{0};
  SimTime moved_at_{};
  bool warned_{false};
};

/// What the descriptors give, alive as long as the run.
struct Memories {
  MemoryMapping clock;
  MemoryMapping fleet;
  MemoryMapping radio;
  std::vector<MemoryMapping> readings;
};

/// Null when no node is captured.
std::unique_ptr<netsim::CaptureFiles> take_captures(ChildSession& session,
                                                    const proto::RadioConfiguration& configuration,
                                                    const netsim::LiveSetup& setup) {
  netsim::CaptureSetup captures{.snap_length = configuration.capture_snap_length(),
                                .failed = configuration.capture_failed()};
  bool any = false;
  for (const proto::RadioNode& node : configuration.nodes()) {
    auto file = session.take_if_given(proto::Descriptors::KIND_CAPTURE, node.node());
    any = any || file;
    captures.files.push_back(file ? std::move(*file) : posix::UniqueFd{});
    captures.names.push_back(node.name());
  }
  if (!any) {
    return nullptr;
  }
  return std::make_unique<netsim::CaptureFiles>(std::move(captures),
                                                netsim::PpduEncoder{setup.air, setup.addresses});
}

/// Null when no node has one.
std::unique_ptr<netsim::MonitorDevices> take_monitors(ChildSession& session,
                                                      const netsim::LiveSetup& setup) {
  std::vector<posix::UniqueFd> devices;
  bool any = false;
  for (std::uint32_t node = 0; node < setup.addresses.size(); ++node) {
    auto device = session.take_if_given(proto::Descriptors::KIND_MONITOR, node);
    any = any || device;
    devices.push_back(device ? std::move(*device) : posix::UniqueFd{});
  }
  if (!any) {
    return nullptr;
  }
  return std::make_unique<netsim::MonitorDevices>(std::move(devices),
                                                  netsim::PpduEncoder{setup.air, setup.addresses});
}

/// Memory for what a node's radio tells its program, if that node has one that asks.
std::span<std::byte> take_readings(ChildSession& session, std::uint32_t node,
                                   std::uint32_t node_count, Memories& memories) {
  const auto fd = session.take_if_given(proto::Descriptors::KIND_RADIO_READINGS, node);
  if (!fd) {
    return {};
  }
  memories.readings.push_back(MemoryMapping::read_write(*fd));
  const auto bytes = memories.readings.back().writable_bytes();
  if (bytes.size() != shm::RadioReadingsWriter::byte_size(node_count)) {
    throw std::runtime_error{"radio readings of node " + std::to_string(node) + " have " +
                             std::to_string(bytes.size()) + " B"};
  }
  return bytes;
}

netsim::LiveSetup take_setup(ChildSession& session, const proto::RadioConfiguration& configuration,
                             Memories& memories) {
  using Kind = proto::Descriptors;
  netsim::LiveSetup setup;
  setup.air = netsim::air_parameters(configuration);
  if (const auto memory = session.take_if_given(Kind::KIND_CITY)) {
    setup.air.channel.city_file = cuscus::city::kCityFile;
    netsim::put_city(MemoryMapping::read_only(*memory).bytes(), setup.air.channel);
  }
  memories.clock = MemoryMapping::read_only(session.take(Kind::KIND_CLOCK_PAGE));
  memories.fleet = MemoryMapping::read_only(session.take(Kind::KIND_FLEET_MEMORY));
  memories.radio = MemoryMapping::read_write(session.take(Kind::KIND_RADIO_MEMORY));
  setup.radio_memory = memories.radio.writable_bytes();
  const auto nodes = static_cast<std::uint32_t>(configuration.nodes_size());
  const std::size_t radio_bytes = shm::RadioMemoryWriter::byte_size(nodes);
  if (setup.radio_memory.size() < radio_bytes) {
    throw std::runtime_error{"radio memory is too small for " + std::to_string(nodes) + " nodes"};
  }
  setup.radio_memory = setup.radio_memory.first(radio_bytes);
  for (const proto::RadioNode& node : configuration.nodes()) {
    const auto* const octets = reinterpret_cast<const std::uint8_t*>(node.mac().data());
    setup.addresses.push_back(netsim::mac_address(std::span<const std::uint8_t, 6>{octets, 6}));
    auto tap = session.take_if_given(Kind::KIND_TAP, node.node());
    if (!tap) {
      spdlog::warn("node {} ('{}') has no TAP and stays silent", node.node(), node.name());
    }
    setup.taps.push_back(tap ? std::move(*tap) : posix::UniqueFd{});
    setup.radio_readings.push_back(take_readings(session, node.node(), nodes, memories));
  }
  setup.canary_delay = netsim::Duration{configuration.canary_delay_ns()};
  for (std::uint32_t end = 0; configuration.canary_delay_ns() > 0 && end < 2; ++end) {
    setup.taps.push_back(session.take(Kind::KIND_TAP, nodes + end));
  }
  if (auto ring = session.take_if_given(Kind::KIND_SEND_STAMP_RING)) {
    setup.stamps = std::make_unique<netsim::StampRing>(std::move(*ring));
  } else {
    spdlog::warn("no send stamps: frames are taken as sent when they are read from the TAP");
  }
  if (auto log = session.take_if_given(Kind::KIND_FRAME_LOG)) {
    setup.log = std::make_unique<netsim::FrameLog>(std::move(*log), setup.air);
  }
  if (auto log = session.take_if_given(Kind::KIND_RECEPTION_LOG)) {
    setup.reception_log = std::move(*log);
    for (const proto::RadioNode& node : configuration.nodes()) {
      setup.names.push_back(node.name());
    }
  }
  setup.captures = take_captures(session, configuration, setup);
  setup.monitors = take_monitors(session, setup);
  return setup;
}

/// True when this process was given a processor and is pinned to it. Done before it says that it is
/// ready: to lock memory means to read it all in, which takes longer than a run waits for its
/// start.
bool take_the_processor(const proto::RadioConfiguration& configuration) {
  if (configuration.realtime_priority() > 0 &&
      !posix::try_realtime_scheduling(configuration.realtime_priority())) {
    spdlog::warn("SCHED_FIFO {} was refused: releases may be late",
                 configuration.realtime_priority());
  }
  if (!posix::try_lock_memory()) {
    spdlog::warn("memory could not be locked: page faults may delay releases");
  }
  // This thread alone: those that write files may go wherever there is room.
  return configuration.has_processor() && posix::try_pin(configuration.processor());
}

void serve(ChildSession& session) {
  const proto::Configure configure = session.await_configuration();
  if (!configure.has_radio()) {
    throw std::runtime_error{"the configuration is not a radio's"};
  }
  const proto::RadioConfiguration& configuration = configure.radio();
  Memories memories;
  netsim::LiveSetup setup = take_setup(session, configuration, memories);
  const shm::ClockPageReader clock{memories.clock.bytes()};
  const shm::FleetMemoryReader fleet{memories.fleet.bytes()};
  netsim::FleetPositions positions{fleet, static_cast<std::uint32_t>(configuration.nodes_size())};
  netsim::LiveAir air{std::move(setup), positions};
  const bool pinned = take_the_processor(configuration);
  session.ready();

  if (const auto start_ns = session.await_start()) {
    Session owner{session, fleet, air};
    air.run(*start_ns, owner);
  }
  proto::Report report;
  *report.mutable_radio() = air.report();
  if (pinned) {
    report.mutable_radio()->set_processor(configuration.processor());
  }
  for (int node = 0; node < configuration.nodes_size(); ++node) {
    *report.mutable_radio()->add_nodes() = air.service_report(static_cast<std::uint32_t>(node));
  }
  session.report(report);
}

}  // namespace

int main() {
  std::optional<ChildSession> session;
  try {
    cuscus::log::start("netsim");
    session = ChildSession::from_environment();
    serve(*session);
    return 0;
  } catch (const cuscus::ipc::PeerError& error) {
    spdlog::error("{}", error.what());
    return 1;
  } catch (const std::exception& error) {
    try {
      spdlog::error("{}", error.what());
      if (session) {
        session->fail(error.what());
      }
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): nobody is left to tell
    }
    return 1;
  }
}
