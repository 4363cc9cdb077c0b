#include "netsim/app/radio_configuration.h"

#include <catch2/catch.hpp>

namespace cuscus::netsim {
namespace {

proto::RadioConfiguration with_node() {
  proto::RadioConfiguration c;
  auto* const node = c.add_nodes();
  node->set_mac("abcdef");
  node->set_tx_power_dbm(17.0);
  node->set_antenna_gain_db(2.0);
  return c;
}

TEST_CASE("every setting of the radio arrives in its own place") {
  proto::RadioConfiguration c = with_node();
  c.set_seed(5);
  c.set_standard("802.11g");
  c.set_data_rate_kbps(54'000);
  c.set_group_rate_kbps(12'000);
  c.add_basic_rates_kbps(24'000);
  c.set_carrier_hz(2.4e9);
  c.set_noise_figure_db(6.0);
  c.set_slot_ns(9'000);
  c.set_retry_limit(3);
  c.set_long_retry_limit(4);
  c.set_rts_threshold_bytes(500);
  c.set_rate_control("aarf");
  c.set_mac("tdma");
  c.mutable_tdma()->set_slot_ns(3'000'000);
  c.mutable_tdma()->set_guard_ns(7'000);
  c.mutable_tdma()->add_frame(0);
  c.mutable_tdma()->add_frame(kNobody);
  for (const std::uint32_t aifsn : {9U, 6U, 3U, 2U}) {
    auto* const category = c.mutable_edca()->add_categories();
    category->set_aifsn(aifsn);
    category->set_cw_min(7);
    category->set_cw_max(63);
  }
  c.mutable_ideal()->set_delay_ns(4'000);
  c.mutable_ideal()->set_jitter_ns(3'000);
  c.mutable_ideal()->set_loss(0.125);
  c.mutable_ideal()->set_range_m(250.0);
  c.set_queue_frames(10);
  c.set_queue_lifetime_ns(1'000);
  c.set_error_model("yans");
  c.set_cca_preamble_dbm(-80.0);
  c.set_cca_energy_dbm(-60.0);
  c.set_detection_minimum_dbm(-81.0);
  c.set_detection_minimum_sinr_db(3.0);
  c.set_capture_in_preamble_db(5.5);
  c.set_capture_in_frame_db(10.5);
  c.set_answer_in_any_class(true);
  c.set_short_preamble(true);
  proto::PropagationConfiguration& p = *c.mutable_propagation();
  p.set_model("two-ray");
  p.set_exponent(2.5);
  p.set_reference_loss_db(40.0);
  p.set_alpha(21.0);
  p.set_chi_db2(4.0);
  p.set_ground("wet");
  p.set_horizontal_polarisation(true);
  p.set_roughness_m(0.25);
  p.set_canyon_bound("upper");
  p.set_environment("suburban");
  p.set_area("UMi-AV");
  p.set_line_of_sight("mean");
  p.set_line_of_sight_decorrelation_m(33.0);
  p.set_shadowing_db(3.5);
  p.set_shadowing_decorrelation_m(11.0);
  p.set_fading("rice");
  p.set_k_factor_db(6.5);
  p.set_k_factor_overhead_db(14.5);
  p.set_residual_doppler_hz(0.75);
  p.set_nakagami_m(1.25);
  c.set_antenna("pattern");
  c.add_antenna_pattern_dbi(1.5);
  c.add_antenna_pattern_dbi(-2.5);
  c.set_antenna_pattern_azimuths(1);
  c.set_disruption_fraction(0.7);
  c.set_disruption_interval_ns(2'000'000);
  c.set_disruption_offset_ns(300);
  c.set_disruption_at_random(true);
  c.mutable_propagation()->set_outer_wall_db(15.0);
  c.mutable_propagation()->set_inner_wall_db(4.0);
  proto::BoxObstacle& box = *c.add_obstacles();
  box.set_centre_x_m(1.0);
  box.set_centre_y_m(2.0);
  box.mutable_size_m()->set_x(3.0);
  box.mutable_size_m()->set_y(4.0);
  box.mutable_size_m()->set_z(5.0);
  box.set_heading_rad(0.5);
  box.set_outer_wall_db(13.0);
  box.set_inner_spacing_m(2.5);
  box.set_inner_wall_db(6.0);
  proto::Jammer& jammer = *c.add_jammers();
  jammer.mutable_p_wj_m()->set_x(7.0);
  jammer.mutable_p_wj_m()->set_y(8.0);
  jammer.mutable_p_wj_m()->set_z(9.0);
  jammer.set_power_dbm(21.0);
  jammer.set_frequency_hz(2.44e9);
  jammer.set_bandwidth_hz(5e6);
  jammer.set_duty(0.25);
  jammer.set_period_ns(2'000'000);
  jammer.set_start_ns(300);
  jammer.set_stop_ns(400);

  const AirParameters air = air_parameters(c);

  CHECK(air.seed == 5);
  CHECK(air.standard == "802.11g");
  CHECK(air.data_rate_kbps == 54'000);
  CHECK(air.group_rate_kbps == 12'000);
  CHECK(air.basic_rates_kbps == std::vector<std::uint32_t>{24'000});
  CHECK(air.noise_figure.value == 6.0);
  CHECK(air.slot == Duration{9'000});
  CHECK(air.retry_limit == 3);
  CHECK(air.long_retry_limit == 4);
  CHECK(air.rts_threshold_bytes == 500);
  CHECK(air.rate_control == "aarf");
  CHECK(air.mac == "tdma");
  CHECK(air.tdma.slot == Duration{3'000'000});
  CHECK(air.tdma.guard == Duration{7'000});
  CHECK(air.tdma.frame == std::vector<std::int32_t>{0, kNobody});
  CHECK(air.edca == EdcaParameters{{9, 7, 63}, {6, 7, 63}, {3, 7, 63}, {2, 7, 63}});
  CHECK(air.ideal.delay == Duration{4'000});
  CHECK(air.ideal.jitter == Duration{3'000});
  CHECK(air.ideal.loss == 0.125);
  CHECK(air.ideal.range_m == 250.0);
  CHECK(air.queue_frames == 10);
  CHECK(air.queue_lifetime == Duration{1'000});
  CHECK(air.error_model == "yans");
  CHECK(air.cca_preamble.value == -80.0);
  CHECK(air.cca_energy.value == -60.0);
  CHECK(air.detection_minimum.value == -81.0);
  CHECK(air.detection_minimum_sinr.value == 3.0);
  CHECK(air.capture_in_preamble.value == 5.5);
  CHECK(air.capture_in_frame.value == 10.5);
  CHECK(air.control_answer == ControlAnswerRule::kAnyClass);
  CHECK(air.dsss_preamble == DsssPreamble::kShort);
  CHECK(air.channel.model == "two-ray");
  CHECK(air.channel.carrier_hz == 2.4e9);
  CHECK(air.channel.exponent == 2.5);
  CHECK(air.channel.reference_loss.value == 40.0);
  CHECK(air.channel.alpha == 21.0);
  CHECK(air.channel.chi_db2 == 4.0);
  CHECK(air.channel.ground == "wet");
  CHECK(air.channel.polarisation == Polarisation::kHorizontal);
  CHECK(air.channel.roughness_m == 0.25);
  CHECK(air.channel.canyon_bound == "upper");
  CHECK(air.channel.environment == "suburban");
  CHECK(air.channel.area == "UMi-AV");
  CHECK(air.channel.line_of_sight == "mean");
  CHECK(air.channel.line_of_sight_decorrelation_m == 33.0);
  CHECK(air.channel.shadowing_db == 3.5);
  CHECK(air.channel.shadowing_decorrelation_m == 11.0);
  CHECK(air.channel.fading == "rice");
  CHECK(air.channel.k_factor.value == 6.5);
  CHECK(air.channel.k_factor_overhead.value == 14.5);
  CHECK(air.channel.residual_doppler_hz == 0.75);
  CHECK(air.channel.nakagami_m == 1.25);
  CHECK(air.channel.seed == 5);
  CHECK(air.antenna.model == "pattern");
  CHECK(air.antenna.pattern_dbi == std::vector<double>{1.5, -2.5});
  CHECK(air.antenna.pattern_azimuths == 1);
  CHECK(air.disruption.fraction == 0.7);
  CHECK(air.disruption.interval == Duration{2'000'000});
  CHECK(air.disruption.offset == Duration{300});
  CHECK(air.disruption.phase == DisruptionPhase::kRandom);
  CHECK(air.disruption.seed == 5);
  CHECK(air.channel.outer_wall.value == 15.0);
  CHECK(air.channel.inner_wall.value == 4.0);
  REQUIRE(air.channel.obstacles.size() == 1);
  const BoxObstacle& wall = air.channel.obstacles[0];
  CHECK(wall.shape.centre_m == Eigen::Vector2d{1.0, 2.0});
  CHECK(wall.shape.size_m == Eigen::Vector3d{3.0, 4.0, 5.0});
  CHECK(wall.shape.heading_rad == 0.5);
  CHECK(wall.outer_wall.value == 13.0);
  CHECK(wall.inner_spacing_m == 2.5);
  CHECK(wall.inner_wall.value == 6.0);
  REQUIRE(air.jammers.size() == 1);
  const JammerParameters& noise = air.jammers[0];
  CHECK(noise.p_WJ == Eigen::Vector3d{7.0, 8.0, 9.0});
  CHECK(noise.power.value == 21.0);
  CHECK(noise.band.centre_hz == 2.44e9);
  CHECK(noise.band.width_hz == 5e6);
  CHECK(noise.duty == 0.25);
  CHECK(noise.period == Duration{2'000'000});
  CHECK(noise.start == Duration{300});
  CHECK(noise.stop == Duration{400});
  REQUIRE(air.nodes.size() == 1);
  CHECK(air.nodes[0].tx_power.value == 17.0);
  CHECK(air.nodes[0].antenna_gain.value == 2.0);
}

TEST_CASE("nodes out of order and addresses of the wrong length are refused") {
  proto::RadioConfiguration out_of_order = with_node();
  out_of_order.mutable_nodes(0)->set_node(1);
  CHECK_THROWS_WITH(air_parameters(out_of_order), Catch::Contains("in order"));

  proto::RadioConfiguration short_address = with_node();
  short_address.mutable_nodes(0)->set_mac("abc");
  CHECK_THROWS_WITH(air_parameters(short_address), Catch::Contains("must have 6 octets"));
}

}  // namespace
}  // namespace cuscus::netsim
