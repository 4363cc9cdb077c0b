#include "ground-station/app/ground_station.h"

#include <fcntl.h>

#include <exception>
#include <limits>
#include <stdexcept>

#include "common/city/export/json.h"
#include "common/city/transfer/city_message.h"
#include "common/log/log.h"
#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/resource_usage.h"
#include "common/posix/shared_memory.h"

namespace cuscus::gcs {
namespace {

constexpr SimClock::duration kDefaultPagePeriod = std::chrono::milliseconds{100};
constexpr SimClock::duration kShortestPagePeriod = std::chrono::milliseconds{10};
constexpr auto kBeatPeriod = std::chrono::milliseconds{500};
constexpr auto kFarewell = std::chrono::milliseconds{400};
constexpr auto kFarewellStep = std::chrono::milliseconds{10};

SimClock::duration checked_period(std::int64_t period_ns) {
  const SimClock::duration period{period_ns};
  if (period == SimClock::duration{0}) {
    return kDefaultPagePeriod;
  }
  if (period < kShortestPagePeriod) {
    throw std::invalid_argument{"page_period_ns is " + std::to_string(period_ns) +
                                "; allowed is 0 (100 ms), or 10000000 and more"};
  }
  return period;
}

std::uint16_t checked_port(std::uint32_t port) {
  if (port == 0 || port > std::numeric_limits<std::uint16_t>::max()) {
    throw std::invalid_argument{"telemetry_port is " + std::to_string(port) +
                                "; allowed is 1 to 65535"};
  }
  return static_cast<std::uint16_t>(port);
}

/// What stands around the fleet, as JSON: null when nothing does.
std::string take_city(ipc::ChildSession& session) {
  const auto memory = session.take_if_given(proto::Descriptors::KIND_CITY);
  if (!memory) {
    return "null";
  }
  const city::City city = city::from_bytes(posix::MemoryMapping::read_only(*memory).bytes());
  return city::json_text(city, {.title = {}, .attribution = city.attribution});
}

}  // namespace

GroundStation::GroundStation(ipc::ChildSession& session,
                             const proto::GroundStationConfiguration& configuration)
    : session_{session},
      page_period_{checked_period(configuration.page_period_ns())},
      fleet_{configuration},
      memory_{session.take(proto::Descriptors::KIND_FLEET_MEMORY),
              session.take(proto::Descriptors::KIND_RADIO_MEMORY)},
      telemetry_{io_, checked_port(configuration.telemetry_port()),
                 [this](std::span<const std::byte> datagram) { fleet_.receive(datagram, now()); }} {
  if (auto listener = session.take_if_given(proto::Descriptors::KIND_PAGE_LISTENER)) {
    page_.emplace(
        io_, std::move(*listener), [this] { return picture(); }, take_city(session), census_);
  }
}

SimTime GroundStation::now() const {
  return sim_time(posix::monotonic_now_ns() - start_monotonic_ns_);
}

std::string GroundStation::picture() const {
  const Observation observation = memory_.observe();
  // Asked after the memories were read, so that nothing they hold is from the future.
  const SimTime time = now();
  RunState state = time < SimTime{} ? RunState::kStarting : RunState::kRunning;
  if (ended_) {
    state = RunState::kEnded;
  }
  return to_json(fleet_.snapshot(observation, time, state));
}

void GroundStation::spawn(asio::awaitable<void> task) {
  asio::co_spawn(io_, std::move(task), [](const std::exception_ptr& failure) {
    if (failure) {
      std::rethrow_exception(failure);  // out of io_.run()
    }
  });
}

void GroundStation::run(std::int64_t start_monotonic_ns) {
  start_monotonic_ns_ = start_monotonic_ns;
  spawn(telemetry_.receive());
  spawn(beat());
  spawn(await_stop());
  if (page_) {
    spawn(page_->accept());
    spawn(publish_pictures());
  }
  io_.run();
}

asio::awaitable<void> GroundStation::publish_pictures() {
  asio::steady_timer timer{io_, std::chrono::steady_clock::now()};
  while (!ended_) {
    // A late picture delays the next one: pictures are never sent in a burst.
    timer.expires_at(std::max(timer.expiry() + page_period_, std::chrono::steady_clock::now()));
    co_await timer.async_wait(asio::use_awaitable);
    if (!ended_ && !census_.clients.empty()) {
      page_->publish(picture());
    }
  }
}

asio::awaitable<void> GroundStation::beat() {
  asio::steady_timer timer{io_};
  for (;;) {
    session_.beat(to_ns(now()));
    timer.expires_after(kBeatPeriod);
    co_await timer.async_wait(asio::use_awaitable);
  }
}

asio::awaitable<void> GroundStation::await_stop() {
  asio::posix::stream_descriptor control{
      io_,
      posix::check("duplicate the control socket", ::fcntl(session_.fd(), F_DUPFD_CLOEXEC, 0))};
  while (!session_.stop_requested()) {
    co_await control.async_wait(asio::posix::stream_descriptor::wait_read, asio::use_awaitable);
  }
  ended_ = true;
  control.close();
  // Waiting made the socket non-blocking, its original too; the report must wait for room.
  posix::check("make the control socket blocking", ::fcntl(session_.fd(), F_SETFL, 0));
  if (page_) {
    page_->end(picture());
    co_await farewell();
  }
  io_.stop();
}

asio::awaitable<void> GroundStation::farewell() {
  const auto deadline = std::chrono::steady_clock::now() + kFarewell;
  asio::steady_timer timer{io_};
  while (!census_.clients.empty() && std::chrono::steady_clock::now() < deadline) {
    timer.expires_after(kFarewellStep);
    co_await timer.async_wait(asio::use_awaitable);
  }
  if (!census_.clients.empty()) {
    spdlog::info("page: {} clients did not close in time", census_.clients.size());
  }
}

proto::GroundStationReport GroundStation::report() const {
  proto::GroundStationReport report;
  report.set_telemetry_received(fleet_.received());
  report.set_telemetry_rejected(fleet_.rejected());
  report.set_page_clients(census_.clients_ever);
  report.set_cpu_s(posix::process_cpu_s());
  return report;
}

}  // namespace cuscus::gcs
