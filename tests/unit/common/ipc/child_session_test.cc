#include "common/ipc/child_session.h"

#include <array>
#include <catch2/catch.hpp>

#include "common/posix/shared_memory.h"

namespace cuscus::ipc {
namespace {

void send_tap(ControlSocket& socket, std::uint32_t node, int fd) {
  proto::Envelope envelope;
  auto* const item = envelope.mutable_descriptors()->add_items();
  item->set_kind(proto::Descriptors::KIND_TAP);
  item->set_node(node);
  socket.send(envelope, std::array{fd});
}

TEST_CASE("a child gets its descriptors, configuration, start and stop") {
  auto [parent, child] = ControlSocket::pair();
  ChildSession session{std::move(child)};
  const posix::UniqueFd memory = posix::create_shared_memory("test", 4096);
  send_tap(parent, 5, memory.get());
  proto::Envelope configure;
  configure.mutable_configure()->mutable_agent()->set_name("uav5");
  parent.send(configure);
  proto::Envelope start;
  start.mutable_start()->set_start_monotonic_ns(1234);

  CHECK(session.await_configuration().agent().name() == "uav5");
  CHECK(session.take(proto::Descriptors::KIND_TAP, 5));
  CHECK_THROWS_AS(session.take(proto::Descriptors::KIND_TAP, 6), PeerError);
  session.ready();
  CHECK(parent.receive().envelope.has_ready());
  parent.send(start);
  CHECK(session.await_start() == 1234);
  CHECK_FALSE(session.stop_requested());
  session.beat(17, "flying");
  CHECK(parent.receive().envelope.status().state() == "flying");
  proto::Envelope stop;
  stop.mutable_stop();
  parent.send(stop);
  CHECK(session.stop_requested());
}

TEST_CASE("a stop before the start ends the wait for it") {
  auto [parent, child] = ControlSocket::pair();
  ChildSession session{std::move(child)};
  proto::Envelope stop;
  stop.mutable_stop();
  parent.send(stop);

  CHECK(session.await_start() == std::nullopt);
  CHECK(session.stop_requested());
}

}  // namespace
}  // namespace cuscus::ipc
