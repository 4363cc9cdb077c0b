#include "uav-agent/sdk/sim/sim_session.h"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/unit/uav-agent/simulated_run.h"

namespace cuscus::sdk {
namespace {

using tests::SimulatedRun;

proto::AgentConfiguration configuration() {
  proto::AgentConfiguration result;
  result.set_node(SimulatedRun::kNode);
  result.set_name("uav2");
  return result;
}

TEST_CASE("a program gets its vehicle, its start and its stop") {
  SimulatedRun run;
  run.configure(configuration());
  ipc::ChildSession child{std::move(run.program)};
  SimSession session{child};
  run.start();

  CHECK(session.configuration().name() == "uav2");
  CHECK(session.wait_for_start());
  CHECK(run.orchestrator.receive().envelope.has_ready());
  CHECK_FALSE(session.stop_requested());
  session.beat("flying");
  CHECK(run.orchestrator.receive().envelope.status().state() == "flying");
  run.stop();
  CHECK(session.stop_requested());
  proto::AgentReport report;
  report.set_loops(17);
  session.finish(report);
  CHECK(run.orchestrator.receive().envelope.report().agent().loops() == 17);
}

TEST_CASE("a vehicle shows what the world writes, and its commands reach the world") {
  SimulatedRun run;
  run.configure(configuration());
  ipc::ChildSession child{std::move(run.program)};
  SimSession session{child};
  Vehicle& vehicle = session.vehicle();

  CHECK_FALSE(vehicle.sensors().imu());
  CHECK_FALSE(vehicle.sensors().motion_capture());
  run.sensors.publish(shm::ImuReading{.sim_time_ns = 5,
                                      .sequence = 1,
                                      .angular_rate_B_radps = {1.0, 2.0, 3.0},
                                      .specific_force_B_mps2 = {4.0, 5.0, 6.0}});
  run.sensors.publish(shm::MotionCaptureReading{
      .sim_time_ns = 6, .sequence = 2, .p_WB_m = {7.0, 8.0, 9.0}, .q_WB = {0.5, 0.5, -0.5, 0.5}});
  const auto imu = vehicle.sensors().imu().value();
  CHECK(imu.time == sim_time(5));
  CHECK(imu.sequence == 1);
  CHECK(imu.angular_rate_B_radps == Eigen::Vector3d{1.0, 2.0, 3.0});
  CHECK(imu.specific_force_B_mps2 == Eigen::Vector3d{4.0, 5.0, 6.0});
  const auto capture = vehicle.sensors().motion_capture().value();
  CHECK(capture.p_WB_m == Eigen::Vector3d{7.0, 8.0, 9.0});
  CHECK(capture.q_WB.w() == 0.5);
  CHECK(capture.q_WB.y() == -0.5);

  CHECK_FALSE(vehicle.sensors().ultrasonic());
  CHECK_FALSE(vehicle.sensors().lidar());
  run.sensors.publish(shm::UltrasonicReading{.sim_time_ns = 7, .sequence = 3, .distance_m = 1.5});
  CHECK(vehicle.sensors().ultrasonic()->distance_m == 1.5);
  run.sensors.publish(shm::UltrasonicReading{
      .sim_time_ns = 8, .sequence = 4, .distance_m = std::numeric_limits<double>::infinity()});
  CHECK(vehicle.sensors().ultrasonic()->time == sim_time(8));
  CHECK_FALSE(vehicle.sensors().ultrasonic()->distance_m);
  shm::LidarScan scan{};
  scan.sequence = 5;
  scan.rows = 2;
  scan.rays = 3;
  scan.first_azimuth_rad = -0.5;
  scan.azimuth_step_rad = 0.5;
  scan.elevation_rad[1] = 0.25F;
  scan.range_m[5] = 9.5F;
  run.sensors.publish(scan);
  const auto seen = vehicle.sensors().lidar().value();
  CHECK(seen.rays == 3);
  CHECK(seen.elevations_rad == std::vector{0.0F, 0.25F});
  CHECK(seen.ranges_m == std::vector{0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 9.5F});

  CHECK_FALSE(vehicle.sensors().gnss());
  shm::GnssReading gnss{};
  gnss.sim_time_ns = 9;
  gnss.sequence = 6;
  gnss.satellites_in_view = 8;
  gnss.satellites_received = 3;
  run.sensors.publish(gnss);
  CHECK(vehicle.sensors().gnss()->satellites_in_view == 8);
  CHECK(vehicle.sensors().gnss()->satellites_received == 3);
  CHECK_FALSE(vehicle.sensors().gnss()->fix);
  gnss.has_fix = 1;
  gnss.p_WB_m = {1.0, 2.0, 3.0};
  gnss.v_WB_W_mps = {4.0, 5.0, 6.0};
  gnss.longitude_deg = 2.5;
  gnss.hdop = 1.25;
  run.sensors.publish(gnss);
  const auto fix = vehicle.sensors().gnss()->fix.value();
  CHECK(vehicle.sensors().gnss()->time == sim_time(9));
  CHECK(fix.p_WB_m == Eigen::Vector3d{1.0, 2.0, 3.0});
  CHECK(fix.v_WB_W_mps == Eigen::Vector3d{4.0, 5.0, 6.0});
  CHECK(fix.longitude_deg == 2.5);
  CHECK(fix.hdop == 1.25);

  CHECK_FALSE(vehicle.sensors().camera());
  CHECK(vehicle.sensors().camera_pictures() == 0);
  std::vector<std::byte> rgb(SimulatedRun::kPictures.byte_size(), std::byte{1});
  rgb[3 * (2 * 20 + 7) + 1] = std::byte{200};
  run.camera.publish({.sim_time_ns = 9, .sequence = 6, .p_WC_m = {}, .q_WC = {}}, rgb);
  CHECK(vehicle.sensors().camera_pictures() == 1);
  const auto picture = vehicle.sensors().camera().value();
  CHECK(picture.time == sim_time(9));
  CHECK(picture.sequence == 6);
  CHECK(picture.width_px == 20);
  CHECK(picture.height_px == 16);
  CHECK(picture.focal_px == 12.5);
  CHECK(picture.rgb == rgb);

  vehicle.actuators().set_motors({0.1, 0.2, 0.3, 0.4}, sim_time(77));
  vehicle.actuators().set_motors({0.5, 0.6, 0.7, 0.8}, sim_time(78));
  const auto command = run.actuators.command().value();
  CHECK(command.sequence == 2);
  CHECK(command.sim_time_ns == 78);
  CHECK(command.motors == std::array{0.5, 0.6, 0.7, 0.8, 0.0, 0.0, 0.0, 0.0});
}

TEST_CASE("a vehicle knows those whom its radio has heard, and how much their links can lose") {
  SimulatedRun run;
  run.configure(configuration());
  ipc::ChildSession child{std::move(run.program)};
  SimSession session{child};
  const Radio& radio = session.vehicle().radio();
  CHECK(radio.neighbours().empty());
  CHECK_FALSE(radio.link_budget(1));

  run.radio.heard(1, 7'000, -60.0F, 34.0F, 6'000);
  run.radio.heard(1, 9'000, -52.0F, 42.0F, 54'000);

  const auto neighbours = radio.neighbours();
  REQUIRE(neighbours.size() == 1);
  CHECK(neighbours[0].node == 1);
  CHECK(neighbours[0].heard == sim_time(9'000));
  CHECK(neighbours[0].frames == 2);
  CHECK(neighbours[0].received.value == -52.0);
  CHECK(neighbours[0].mean.value == -59.0);  // -60 + (60 - 52) / 8
  CHECK(neighbours[0].snr.value == 42.0);
  CHECK(neighbours[0].rate_kbps == 54'000);
  CHECK(radio.link_budget(1).value().value == 30.0);  // -52 dBm over -82 dBm
  CHECK_FALSE(radio.link_budget(0));
  CHECK_FALSE(radio.link_budget(SimulatedRun::kNodes));
}

TEST_CASE("a vehicle sees its fleet only where it was given the memory") {
  const bool given = GENERATE(true, false);
  SimulatedRun run;
  run.configure(configuration(), given);
  ipc::ChildSession child{std::move(run.program)};
  SimSession session{child};

  const auto* const fleet = session.vehicle().fleet();

  REQUIRE((fleet != nullptr) == given);
  if (given) {
    CHECK_FALSE(fleet->motion_capture_of(1));
    CHECK_FALSE(fleet->motion_capture_of(SimulatedRun::kNodes));
    run.fleet.publish(1, {.sim_time_ns = 6, .sequence = 3, .p_WB_m = {1.0, 2.0, 3.0}, .q_WB = {}});
    CHECK(fleet->motion_capture_of(1).value().sequence == 3);
  }
}

TEST_CASE("time stands at the beginning until the run starts, then runs") {
  SimulatedRun run;
  run.configure(configuration());
  ipc::ChildSession child{std::move(run.program)};
  SimSession session{child};
  const Clock& clock = session.vehicle().clock();

  CHECK(clock.now() == SimTime{});
  run.clock.start(posix::monotonic_now_ns() - 1'000'000'000);
  const SimTime now = clock.now();
  CHECK(now >= sim_time(1'000'000'000));
  // What has passed is not waited for; what is near is.
  clock.sleep_until(sim_time(1));
  clock.sleep_until(now + std::chrono::milliseconds{2});
  CHECK(clock.now() >= now + std::chrono::milliseconds{2});
}

TEST_CASE("a program that is called off before its start is told so") {
  SimulatedRun run;
  run.configure(configuration());
  ipc::ChildSession child{std::move(run.program)};
  SimSession session{child};
  run.stop();

  CHECK_FALSE(session.wait_for_start());
}

TEST_CASE("the configuration of another component is refused") {
  SimulatedRun run;
  proto::Envelope configure;
  configure.mutable_configure()->mutable_world();
  run.orchestrator.send(configure);
  ipc::ChildSession child{std::move(run.program)};

  CHECK_THROWS_AS(SimSession{child}, ipc::PeerError);
}

}  // namespace
}  // namespace cuscus::sdk
