#include "netsim/app/radio_configuration.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace cuscus::netsim {
namespace {

std::vector<BoxObstacle> obstacles_of(const proto::RadioConfiguration& c) {
  std::vector<BoxObstacle> boxes;
  for (const proto::BoxObstacle& box : c.obstacles()) {
    boxes.push_back({.shape = {.centre_m = {box.centre_x_m(), box.centre_y_m()},
                               .size_m = {box.size_m().x(), box.size_m().y(), box.size_m().z()},
                               .heading_rad = box.heading_rad()},
                     .outer_wall = {box.outer_wall_db()},
                     .inner_spacing_m = box.inner_spacing_m(),
                     .inner_wall = {box.inner_wall_db()}});
  }
  return boxes;
}

std::vector<JammerParameters> jammers_of(const proto::RadioConfiguration& c) {
  std::vector<JammerParameters> jammers;
  for (const proto::Jammer& jammer : c.jammers()) {
    const proto::Vector3& p_WJ = jammer.p_wj_m();
    jammers.push_back(
        {.p_WJ = {p_WJ.x(), p_WJ.y(), p_WJ.z()},
         .power = {jammer.power_dbm()},
         .band = {.centre_hz = jammer.frequency_hz(), .width_hz = jammer.bandwidth_hz()},
         .duty = jammer.duty(),
         .period = Duration{jammer.period_ns()},
         .start = Duration{jammer.start_ns()},
         .stop = Duration{jammer.stop_ns()}});
  }
  return jammers;
}

}  // namespace

AirParameters air_parameters(const proto::RadioConfiguration& c) {
  AirParameters air;
  air.seed = c.seed();
  air.standard = c.standard();
  air.data_rate_kbps = c.data_rate_kbps();
  air.group_rate_kbps = c.group_rate_kbps();
  air.basic_rates_kbps.assign(c.basic_rates_kbps().begin(), c.basic_rates_kbps().end());
  air.rate_control = c.rate_control();
  air.control_answer =
      c.answer_in_any_class() ? ControlAnswerRule::kAnyClass : ControlAnswerRule::kSameClass;
  air.dsss_preamble = c.short_preamble() ? DsssPreamble::kShort : DsssPreamble::kLong;
  air.noise_figure = {c.noise_figure_db()};
  air.slot = Duration{c.slot_ns()};
  air.retry_limit = c.retry_limit();
  air.long_retry_limit = c.long_retry_limit();
  air.rts_threshold_bytes = c.rts_threshold_bytes();
  air.mac = c.mac();
  air.tdma = {.slot = Duration{c.tdma().slot_ns()},
              .guard = Duration{c.tdma().guard_ns()},
              .frame = {c.tdma().frame().begin(), c.tdma().frame().end()}};
  for (const proto::EdcaCategory& category : c.edca().categories()) {
    air.edca.push_back(
        {.aifsn = category.aifsn(), .cw_min = category.cw_min(), .cw_max = category.cw_max()});
  }
  if (c.has_ideal()) {
    air.ideal = {.delay = Duration{c.ideal().delay_ns()},
                 .jitter = Duration{c.ideal().jitter_ns()},
                 .loss = c.ideal().loss(),
                 .range_m = c.ideal().range_m()};
  }
  air.queue_frames = c.queue_frames();
  air.queue_lifetime = Duration{c.queue_lifetime_ns()};
  air.error_model = c.error_model();
  air.cca_preamble = {c.cca_preamble_dbm()};
  air.cca_energy = {c.cca_energy_dbm()};
  air.detection_minimum = {c.detection_minimum_dbm()};
  air.detection_minimum_sinr = {c.detection_minimum_sinr_db()};
  air.capture_in_preamble = {c.capture_in_preamble_db()};
  air.capture_in_frame = {c.capture_in_frame_db()};
  const proto::PropagationConfiguration& p = c.propagation();
  air.channel = {.model = p.model(),
                 .carrier_hz = c.carrier_hz(),
                 .exponent = p.exponent(),
                 .reference_loss = {p.reference_loss_db()},
                 .alpha = p.alpha(),
                 .chi_db2 = p.chi_db2(),
                 .outer_wall = {p.outer_wall_db()},
                 .inner_wall = {p.inner_wall_db()},
                 .ground = p.ground(),
                 .polarisation = p.horizontal_polarisation() ? Polarisation::kHorizontal
                                                             : Polarisation::kVertical,
                 .roughness_m = p.roughness_m(),
                 .canyon_bound = p.canyon_bound(),
                 .environment = p.environment(),
                 .area = p.area(),
                 .line_of_sight = p.line_of_sight(),
                 .line_of_sight_decorrelation_m = p.line_of_sight_decorrelation_m(),
                 .shadowing_db = p.shadowing_db(),
                 .shadowing_decorrelation_m = p.shadowing_decorrelation_m(),
                 .fading = p.fading(),
                 .k_factor = {p.k_factor_db()},
                 .k_factor_overhead = {p.k_factor_overhead_db()},
                 .residual_doppler_hz = p.residual_doppler_hz(),
                 .nakagami_m = p.nakagami_m(),
                 .obstacles = obstacles_of(c),
                 .walls = c.walls().empty() ? "paper" : c.walls(),
                 .seed = c.seed()};
  air.jammers = jammers_of(c);
  if (!c.antenna().empty()) {
    air.antenna = {.model = c.antenna(),
                   .pattern_dbi = {c.antenna_pattern_dbi().begin(), c.antenna_pattern_dbi().end()},
                   .pattern_azimuths = c.antenna_pattern_azimuths()};
  }
  air.disruption = {
      .fraction = c.disruption_fraction(),
      .interval = Duration{c.disruption_interval_ns()},
      .phase = c.disruption_at_random() ? DisruptionPhase::kRandom : DisruptionPhase::kFixed,
      .offset = Duration{c.disruption_offset_ns()},
      .seed = c.seed()};
  air.nodes.resize(static_cast<std::size_t>(c.nodes_size()));
  for (int i = 0; i < c.nodes_size(); ++i) {
    const proto::RadioNode& node = c.nodes(i);
    if (node.node() != static_cast<std::uint32_t>(i)) {
      throw std::invalid_argument{"radio: nodes must be numbered 0, 1, 2, ... in order; '" +
                                  node.name() + "' is " + std::to_string(node.node())};
    }
    if (node.mac().size() != 6) {
      throw std::invalid_argument{"radio: the address of '" + node.name() + "' must have 6 octets"};
    }
    air.nodes[static_cast<std::size_t>(i)] = {.tx_power = {node.tx_power_dbm()},
                                              .antenna_gain = {node.antenna_gain_db()}};
  }
  return air;
}

}  // namespace cuscus::netsim
