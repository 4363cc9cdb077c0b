#include "orchestrator/plan/radio_configuration.h"

#include <limits>
#include <optional>
#include <variant>

#include "common/scenario/names.h"

namespace cuscus::orchestrator {
namespace {

void add_fading(const scenario::Fading& from, proto::PropagationConfiguration& result) {
  if (const auto* rice = std::get_if<scenario::RiceFading>(&from)) {
    const Decibel none{-std::numeric_limits<double>::infinity()};
    result.set_fading("rice");
    result.set_k_factor_db(rice->k_factor.value_or(none).value);
    result.set_k_factor_overhead_db((rice->k_factor ? rice->k_factor_overhead : none).value);
    result.set_residual_doppler_hz(rice->residual_doppler_Hz);
  } else if (const auto* nakagami = std::get_if<scenario::NakagamiFading>(&from)) {
    result.set_fading("nakagami");
    result.set_nakagami_m(nakagami->m);
  } else {
    result.set_fading("none");
  }
}

void add_antenna(const scenario::Antenna& from, proto::RadioConfiguration& result) {
  if (const auto* pattern = std::get_if<scenario::PatternAntenna>(&from)) {
    result.set_antenna("pattern");
    result.set_antenna_pattern_azimuths(
        static_cast<std::uint32_t>(pattern->gains_dBi.front().size()));
    for (const auto& row : pattern->gains_dBi) {
      result.mutable_antenna_pattern_dbi()->Add(row.begin(), row.end());
    }
  } else {
    result.set_antenna(std::holds_alternative<scenario::DipoleAntenna>(from) ? "dipole"
                                                                             : "isotropic");
  }
}

void add_category(const scenario::EdcaCategory& from, proto::EdcaConfiguration& result) {
  proto::EdcaCategory& category = *result.add_categories();
  category.set_aifsn(from.aifsn);
  category.set_cw_min(from.cw_min);
  category.set_cw_max(from.cw_max);
}

void add_mac(const scenario::Mac& from, proto::RadioConfiguration& result) {
  if (const auto* tdma = std::get_if<scenario::TdmaMac>(&from)) {
    result.set_mac("tdma");
    result.mutable_tdma()->set_slot_ns(tdma->slot.count());
    result.mutable_tdma()->set_guard_ns(tdma->guard.count());
  } else if (const auto* edca = std::get_if<scenario::EdcaMac>(&from)) {
    result.set_mac("edca");
    for (const scenario::EdcaCategory& category :
         {edca->background, edca->best_effort, edca->video, edca->voice}) {
      add_category(category, *result.mutable_edca());
    }
  } else if (const auto* ideal = std::get_if<scenario::IdealMac>(&from)) {
    result.set_mac("ideal");
    result.mutable_ideal()->set_delay_ns(ideal->delay.count());
    result.mutable_ideal()->set_jitter_ns(ideal->jitter.count());
    result.mutable_ideal()->set_loss(ideal->loss);
    result.mutable_ideal()->set_range_m(
        ideal->range_m.value_or(std::numeric_limits<double>::infinity()));
  } else {
    result.set_mac("dcf");
  }
}

void set_line_of_sight(const scenario::LineOfSight& from, proto::PropagationConfiguration& result) {
  result.set_line_of_sight(from.mean ? "mean" : "drawn");
  result.set_line_of_sight_decorrelation_m(from.decorrelation_m);
}

void add_model(const scenario::Propagation& from, proto::PropagationConfiguration& result) {
  if (const auto* model = std::get_if<scenario::LogDistancePropagation>(&from)) {
    result.set_model("log-distance");
    result.set_exponent(model->exponent);
    result.set_reference_loss_db(model->reference_loss ? model->reference_loss->value : 0.0);
  } else if (const auto* paper = std::get_if<scenario::PaperPropagation>(&from)) {
    result.set_model("paper-eq1");
    result.set_alpha(paper->alpha);
    result.set_chi_db2(paper->chi_dB2);
    result.set_outer_wall_db(paper->outer_wall.value);
    result.set_inner_wall_db(paper->inner_wall.value);
  } else if (const auto* two_ray = std::get_if<scenario::TwoRayPropagation>(&from)) {
    result.set_model("two-ray");
    result.set_ground(name_of(scenario::kGroundNames, two_ray->ground));
    result.set_horizontal_polarisation(two_ray->polarisation ==
                                       scenario::Polarisation::kHorizontal);
    result.set_roughness_m(two_ray->roughness_m);
  } else if (const auto* canyon = std::get_if<scenario::StreetCanyonPropagation>(&from)) {
    result.set_model("p1411");
    result.set_canyon_bound(name_of(scenario::kCanyonBoundNames, canyon->bound));
  } else if (const auto* built_up = std::get_if<scenario::AlHouraniPropagation>(&from)) {
    result.set_model("al-hourani");
    result.set_environment(name_of(scenario::kBuiltUpAreaNames, built_up->environment));
    set_line_of_sight(built_up->line_of_sight, result);
  } else if (const auto* aerial = std::get_if<scenario::Tr36777Propagation>(&from)) {
    result.set_model("tr36777");
    result.set_area(name_of(scenario::kAerialAreaNames, aerial->area));
    set_line_of_sight(aerial->line_of_sight, result);
  } else {
    result.set_model("friis");
  }
}

proto::PropagationConfiguration propagation_of(const scenario::Radio& radio) {
  proto::PropagationConfiguration result;
  add_model(radio.propagation, result);
  if (const auto& shadowing = radio.shadowing) {
    result.set_shadowing_db(shadowing->deviation_dB);
    result.set_shadowing_decorrelation_m(shadowing->decorrelation_m);
  }
  add_fading(radio.fading, result);
  return result;
}

template <typename Array>
void set_vector(const Array& from, proto::Vector3& result) {
  result.set_x(from[0]);
  result.set_y(from[1]);
  result.set_z(from[2]);
}

void add_obstacle(const scenario::BoxObstacle& from, proto::RadioConfiguration& radio) {
  proto::BoxObstacle& box = *radio.add_obstacles();
  box.set_name(from.name);
  box.set_centre_x_m(from.centre_m[0]);
  box.set_centre_y_m(from.centre_m[1]);
  set_vector(from.size_m, *box.mutable_size_m());
  box.set_heading_rad(from.heading_rad);
  box.set_outer_wall_db(from.outer_wall.value);
  if (from.inner_walls) {
    box.set_inner_spacing_m(from.inner_walls->spacing_m);
    box.set_inner_wall_db(from.inner_walls->loss.value);
  }
}

void add_jammer(const scenario::Jammer& from, double channel_hz, proto::RadioConfiguration& radio) {
  proto::Jammer& jammer = *radio.add_jammers();
  jammer.set_name(from.name);
  set_vector(from.position_m, *jammer.mutable_p_wj_m());
  jammer.set_power_dbm(from.power.value);
  jammer.set_frequency_hz(from.frequency_hz.value_or(channel_hz));
  jammer.set_bandwidth_hz(from.bandwidth_hz);
  jammer.set_duty(from.duty);
  jammer.set_period_ns(from.period.count());
  jammer.set_start_ns(from.start.count());
  jammer.set_stop_ns(from.stop.value_or(scenario::Duration::max()).count());
}

}  // namespace

proto::RadioConfiguration radio_configuration(const scenario::Radio& from, std::uint64_t seed) {
  proto::RadioConfiguration radio;
  radio.set_seed(seed);
  radio.set_standard(name_of(scenario::kRadioStandardNames, from.standard));
  radio.set_data_rate_kbps(from.data_rate_kbps);
  radio.set_group_rate_kbps(from.group_rate_kbps);
  radio.set_rate_control(name_of(scenario::kRateControlNames, from.rate_control));
  for (const std::uint32_t rate_kbps : from.basic_rates_kbps) {
    radio.add_basic_rates_kbps(rate_kbps);
  }
  radio.set_answer_in_any_class(from.control_answer == scenario::ControlAnswer::kAnyClass);
  radio.set_short_preamble(from.dsss_preamble == scenario::DsssPreamble::kShort);
  radio.set_carrier_hz(from.channel_frequency_hz);
  radio.set_noise_figure_db(from.noise_figure.value);
  radio.set_slot_ns(from.slot.count());
  radio.set_retry_limit(from.retry_limit);
  radio.set_long_retry_limit(from.long_retry_limit);
  radio.set_rts_threshold_bytes(
      from.rts_threshold_bytes.value_or(std::numeric_limits<std::uint32_t>::max()));
  add_mac(from.mac, radio);
  radio.set_queue_frames(from.queue_frames);
  radio.set_queue_lifetime_ns(from.queue_lifetime.count());
  radio.set_error_model(name_of(scenario::kErrorModelNames, from.error_model));
  radio.set_cca_preamble_dbm(from.cca_preamble.value);
  radio.set_cca_energy_dbm(from.cca_energy.value);
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  const scenario::PreambleDetection detection = from.preamble_detection.value_or(
      scenario::PreambleDetection{.minimum_power = {kNone}, .minimum_sinr = {kNone}});
  radio.set_detection_minimum_dbm(detection.minimum_power.value);
  radio.set_detection_minimum_sinr_db(detection.minimum_sinr.value);
  const auto captures_from = [](const std::optional<Decibel>& sinr) {
    return sinr ? sinr->value : std::numeric_limits<double>::infinity();
  };
  radio.set_capture_in_preamble_db(
      captures_from(from.capture ? std::optional{from.capture->preamble} : std::nullopt));
  radio.set_capture_in_frame_db(captures_from(from.capture ? from.capture->frame : std::nullopt));
  add_antenna(from.antenna, radio);
  if (const auto& disruption = from.disruption) {
    radio.set_disruption_fraction(disruption->fraction);
    radio.set_disruption_interval_ns(disruption->interval.count());
    radio.set_disruption_offset_ns(disruption->phase.value_or(scenario::Duration{0}).count());
    radio.set_disruption_at_random(!disruption->phase);
  }
  radio.set_walls(scenario::name_of(scenario::kWallModelNames, from.walls));
  for (const scenario::BoxObstacle& box : from.obstacles) {
    add_obstacle(box, radio);
  }
  for (const scenario::Jammer& jammer : from.jammers) {
    add_jammer(jammer, from.channel_frequency_hz, radio);
  }
  *radio.mutable_propagation() = propagation_of(from);
  return radio;
}

}  // namespace cuscus::orchestrator
