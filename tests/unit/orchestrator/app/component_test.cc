#include "orchestrator/app/component.h"

#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "common/ipc/child_session.h"
#include "common/posix/shared_memory.h"

namespace cuscus::orchestrator {
namespace {

using proto::Descriptors;

struct Conversation {
  boost::asio::io_context loop;
  int changes{0};
  std::pair<ipc::ControlSocket, ipc::ControlSocket> sockets{ipc::ControlSocket::pair()};
  Component component{loop, "world", std::move(sockets.first), [this] { ++changes; }};
  std::optional<ipc::ChildSession> child{std::in_place, std::move(sockets.second)};
};

TEST_CASE("a component is configured, becomes ready, reports and goes") {
  Conversation talk;
  const auto memory = posix::create_shared_memory("test", 4096);
  proto::Configure configure;
  configure.mutable_world()->set_seed(5);

  // More descriptors than one message carries.
  std::vector<GivenDescriptor> given;
  for (std::uint32_t node = 0; node < 450; ++node) {
    given.push_back({Descriptors::KIND_SENSOR_MEMORY, node, memory.get()});
  }
  talk.component.configure(given, configure);
  CHECK(talk.child->await_configuration().world().seed() == 5);
  CHECK(talk.child->take(Descriptors::KIND_SENSOR_MEMORY, 449));

  CHECK_FALSE(talk.component.is_ready());
  talk.child->ready();
  talk.child->beat(1, "flying");
  talk.loop.poll();
  CHECK(talk.component.is_ready());
  CHECK(talk.component.state() == "flying");

  CHECK_FALSE(talk.component.report_so_far());
  proto::Report report;
  report.mutable_world()->set_steps(3);
  talk.child->beat(2, report);
  talk.loop.restart();
  talk.loop.poll();
  REQUIRE(talk.component.report_so_far());
  CHECK(talk.component.report_so_far()->world().steps() == 3);
  CHECK_FALSE(talk.component.report());

  report.mutable_world()->set_steps(7);
  talk.child->report(report);
  talk.child.reset();
  talk.loop.restart();
  talk.loop.poll();
  REQUIRE(talk.component.report());
  CHECK(talk.component.report()->world().steps() == 7);
  CHECK(talk.component.is_gone());
  CHECK(talk.changes == 3);
}

TEST_CASE("a component that floods the orchestrator is read in turns, and its state is cut") {
  Conversation talk;
  for (int beat = 0; beat < 100; ++beat) {
    talk.child->beat(beat, std::to_string(beat));
  }

  talk.loop.run_one();
  CHECK(talk.component.state() == std::to_string(ControlChannel::kMostMessagesAtOnce - 1));
  talk.loop.poll();
  CHECK(talk.component.state() == "99");

  talk.child->beat(100, std::string(1000, 'x'));
  talk.loop.poll();
  CHECK(talk.component.state() == std::string(32, 'x'));
}

TEST_CASE("a component that fails says why, and sending to it afterwards does no harm") {
  Conversation talk;

  talk.child->fail("no such model");
  talk.child.reset();
  talk.loop.poll();

  CHECK(talk.component.failure() == "no such model");
  CHECK(talk.component.is_gone());
  talk.component.stop("over");
}

}  // namespace
}  // namespace cuscus::orchestrator
