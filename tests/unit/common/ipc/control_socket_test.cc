#include "common/ipc/control_socket.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <thread>

#include "common/posix/shared_memory.h"

namespace cuscus::ipc {
namespace {

TEST_CASE("a message and its descriptors arrive together") {
  auto [left, right] = ControlSocket::pair();
  const posix::UniqueFd memory = posix::create_shared_memory("test", 4096);
  proto::Envelope envelope;
  auto* const item = envelope.mutable_descriptors()->add_items();
  item->set_kind(proto::Descriptors::KIND_TAP);
  item->set_node(3);

  left.send(envelope, std::array{memory.get()});
  const auto received = right.receive();

  REQUIRE(received.envelope.has_descriptors());
  CHECK(received.envelope.descriptors().items(0).node() == 3);
  REQUIRE(received.descriptors.size() == 1);
  CHECK(posix::MemoryMapping::read_only(received.descriptors[0]).bytes().size() == 4096);
}

TEST_CASE("a configuration of a thousand nodes passes in one message") {
  auto [left, right] = ControlSocket::pair();
  proto::Envelope envelope;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    auto* const node = envelope.mutable_configure()->mutable_radio()->add_nodes();
    node->set_node(i);
    node->set_name("uav" + std::to_string(i));
    node->set_mac("\x02\x00\x00\x00\x00\x01");
    node->set_tx_power_dbm(16.0);
  }

  REQUIRE(left.try_send(envelope));

  CHECK(right.receive().envelope.configure().radio().nodes_size() == 1000);
}

TEST_CASE("a closed end is an error for receiver and sender") {
  auto [left, right] = ControlSocket::pair();
  proto::Envelope envelope;
  envelope.mutable_ready();
  { const ControlSocket gone = std::move(left); }

  CHECK_THROWS_AS(right.receive(), PeerError);
  CHECK_THROWS_AS(right.send(envelope), PeerError);
}

TEST_CASE("an end that closes without having read leaves its own messages behind") {
  auto [left, right] = ControlSocket::pair();
  proto::Envelope envelope;
  envelope.mutable_ready();
  right.send(envelope);
  left.send(envelope);
  { const ControlSocket gone = std::move(left); }

  CHECK(right.receive().envelope.has_ready());
  CHECK_THROWS_AS(right.receive(), PeerError);
}

TEST_CASE("an end that closes at any instant of a receive is gone, never a failure of its own") {
  for (int round = 0; round < 2000; ++round) {
    auto [left, right] = ControlSocket::pair();
    proto::Envelope envelope;
    envelope.mutable_status();
    right.send(envelope);
    std::thread sender{[&] {
      ControlSocket closing = std::move(left);
      for (int message = 0; message < round % 20; ++message) {
        closing.send(envelope);
      }
    }};
    int received = 0;
    CHECK_THROWS_AS(
        [&] {
          while (true) {
            static_cast<void>(right.receive());
            ++received;
          }
        }(),
        PeerError);
    sender.join();
    CHECK(received == round % 20);
  }
}

TEST_CASE("bytes that are no message are an error") {
  auto [left, right] = ControlSocket::pair();
  REQUIRE(::send(left.fd(), "\xff\xff\xff", 3, 0) == 3);

  CHECK_THROWS_AS(right.receive(), PeerError);
}

TEST_CASE("try_send gives up when the other end reads nothing") {
  auto [left, right] = ControlSocket::pair();
  proto::Envelope envelope;
  envelope.mutable_status()->set_state(std::string(1000, 'x'));

  bool full = false;
  for (int i = 0; i < 1'000'000 && !full; ++i) {
    full = !left.try_send(envelope);
  }

  CHECK(full);
}

}  // namespace
}  // namespace cuscus::ipc
