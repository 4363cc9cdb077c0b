#include "proto/shm/layout.h"

#include <catch2/catch.hpp>
#include <new>
#include <vector>

#include "proto/shm/clock_page.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/motion_capture_memory.h"
#include "proto/shm/vehicle_memory.h"

namespace cuscus::shm {
namespace {

/// Memory aligned as a mapping is.
class Memory {
 public:
  explicit Memory(std::size_t size)
      : size_{size}, bytes_{new (std::align_val_t{4096}) std::byte[size]{}} {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() { ::operator delete[](bytes_, std::align_val_t{4096}); }
  [[nodiscard]] std::span<std::byte> bytes() const { return {bytes_, size_}; }

 private:
  std::size_t size_;
  std::byte* bytes_;
};

TEST_CASE("fleet memory carries each node's state and the world's progress") {
  const Memory memory{FleetMemoryWriter::byte_size(3)};
  FleetMemoryWriter writer{memory.bytes(), 3};
  const FleetMemoryReader reader{memory.bytes()};

  writer.publish(2, NodeState{.sim_time_ns = 5,
                              .p_WB_m = {1, 2, 3},
                              .v_WB_W_mps = {},
                              .q_WB = {1, 0, 0, 0},
                              .w_WB_B_radps = {},
                              .flags = NodeFlag::kOnGround});
  writer.publish(1, CommandTally{.accepted = 9,
                                 .rejected_not_finite = 1,
                                 .rejected_out_of_range = 0,
                                 .rejected_torn = 0,
                                 .timeouts = 0});
  writer.publish_progress(10, 1, 10'000'000);

  CHECK(reader.node_count() == 3);
  CHECK(reader.state(2)->p_WB_m == std::array{1.0, 2.0, 3.0});
  CHECK(reader.commands(1)->accepted == 9);
  CHECK(reader.steps() == 10);
  CHECK(reader.overruns() == 1);
}

TEST_CASE("attaching to another memory, version or size is refused") {
  const Memory memory{FleetMemoryWriter::byte_size(3)};
  const FleetMemoryWriter writer{memory.bytes(), 3};

  SECTION("other magic") { CHECK_THROWS_AS(SensorMemoryReader{memory.bytes()}, LayoutError); }
  SECTION("other version") {
    memory.bytes()[offsetof(Header, version)] = std::byte{99};
    CHECK_THROWS_WITH(FleetMemoryReader{memory.bytes()}, Catch::Contains("layout version 99"));
  }
  SECTION("cut short") {
    CHECK_THROWS_AS(FleetMemoryReader{memory.bytes().first(memory.bytes().size() - 64)},
                    LayoutError);
  }
  SECTION("shorter than a header") {
    CHECK_THROWS_AS(FleetMemoryReader{memory.bytes().first(8)}, LayoutError);
  }
  SECTION("more nodes than room") {
    memory.bytes()[offsetof(Header, node_count)] = std::byte{200};
    CHECK_THROWS_AS(FleetMemoryReader{memory.bytes()}, LayoutError);
  }
  SECTION("zeroes") {
    const Memory empty{4096};
    CHECK_THROWS_AS(ClockPageReader{empty.bytes()}, LayoutError);
  }
}

TEST_CASE("vehicle memory has no reading before the first and no command before one is written") {
  const Memory sensors{SensorMemoryWriter::byte_size()};
  SensorMemoryWriter world{sensors.bytes()};
  const SensorMemoryReader agent{sensors.bytes()};
  const Memory actuators{ActuatorMemoryWriter::byte_size()};
  ActuatorMemoryWriter::lay_out(actuators.bytes());
  ActuatorMemoryWriter motors{actuators.bytes()};
  const ActuatorMemoryReader plant{actuators.bytes()};

  CHECK_FALSE(agent.imu());
  CHECK_FALSE(agent.motion_capture());
  CHECK(plant.command()->sequence == 0);
  world.publish(ImuReading{.sim_time_ns = 1,
                           .sequence = 1,
                           .angular_rate_B_radps = {},
                           .specific_force_B_mps2 = {0, 0, 9.81}});
  motors.publish({.sim_time_ns = 2, .sequence = 1, .motors = {0.5, 0.5, 0.5, 0.5}});
  CHECK(agent.imu()->specific_force_B_mps2[2] == 9.81);
  CHECK(plant.command()->motors[3] == 0.5);
}

TEST_CASE("a vehicle's memory has room for a lidar only if the vehicle has one") {
  const Memory without{SensorMemoryWriter::byte_size()};
  SensorMemoryWriter plain{without.bytes()};
  const Memory with{SensorMemoryWriter::byte_size(true)};
  SensorMemoryWriter world{with.bytes()};
  const SensorMemoryReader agent{with.bytes()};
  CHECK(without.bytes().size() + sizeof(LidarMemoryLayout) == with.bytes().size());
  CHECK_FALSE(agent.lidar());
  CHECK_FALSE(agent.ultrasonic());
  CHECK_FALSE(agent.gnss());

  plain.publish(UltrasonicReading{.sim_time_ns = 1, .sequence = 1, .distance_m = 2.5});
  GnssReading gnss{};
  gnss.sequence = 4;
  gnss.vdop = 1.5;
  plain.publish(gnss);
  LidarScan scan{};
  scan.sequence = 7;
  scan.rows = 2;
  scan.rays = kMaxLidarRays / 2;
  scan.range_m.back() = 12.5F;
  world.publish(scan);

  CHECK_FALSE(SensorMemoryReader{without.bytes()}.lidar());
  CHECK(SensorMemoryReader{without.bytes()}.ultrasonic()->distance_m == 2.5);
  CHECK(SensorMemoryReader{without.bytes()}.gnss()->vdop == 1.5);
  CHECK(agent.lidar()->sequence == 7);
  CHECK(agent.lidar()->range_m.back() == 12.5F);
  scan.rays += 1;  // more than there can be
  world.publish(scan);
  CHECK_FALSE(agent.lidar());
}

TEST_CASE("motion-capture memory carries one reading per node") {
  const Memory memory{MotionCaptureMemoryWriter::byte_size(2)};
  MotionCaptureMemoryWriter writer{memory.bytes(), 2};
  const MotionCaptureMemoryReader reader{memory.bytes()};

  writer.publish(1, {.sim_time_ns = 1, .sequence = 1, .p_WB_m = {4, 5, 6}, .q_WB = {1, 0, 0, 0}});

  CHECK_FALSE(reader.reading(0));
  CHECK(reader.reading(1)->p_WB_m == std::array{4.0, 5.0, 6.0});
}

TEST_CASE("the clock page says nothing until the run starts") {
  const Memory memory{4096};
  const auto page = memory.bytes().first(ClockPageWriter::byte_size());
  ClockPageWriter writer{page};
  const ClockPageReader reader{page};

  CHECK_FALSE(reader.start_monotonic_ns());
  writer.start(123);
  CHECK(reader.start_monotonic_ns() == 123);
}

}  // namespace
}  // namespace cuscus::shm
