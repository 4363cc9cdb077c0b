#include <nlohmann/json.hpp>

#include "common/scenario/names.h"
#include "common/scenario/scenario.h"
#include "common/scenario/units.h"
#include "common/scenario/utc.h"

namespace cuscus::scenario {
namespace {

using Json = nlohmann::ordered_json;

std::string text(Duration duration) {
  return format_quantity(static_cast<double>(duration.count()), kTime);
}

std::string rate_text(Duration period) {
  return format_quantity(1e9 / static_cast<double>(period.count()), kFrequency);
}

std::string bit_rate_text(std::uint32_t rate_kbps) { return format_quantity(rate_kbps, kBitRate); }

template <std::size_t n>
Json lengths(const std::array<double, n>& values_m) {
  Json array = Json::array();
  for (const double value_m : values_m) {
    array.push_back(format_quantity(value_m, kLength));
  }
  return array;
}

Json json_of(const FriisPropagation& /*model*/) { return {{"model", "friis"}}; }

Json json_of(const LogDistancePropagation& model) {
  return {{"model", "log-distance"},
          {"exponent", model.exponent},
          {"reference_loss", model.reference_loss
                                 ? format_quantity(model.reference_loss->value, kPowerRatio)
                                 : "free-space"}};
}

Json json_of(const PaperPropagation& model) {
  return {{"model", "paper-eq1"},
          {"alpha", model.alpha},
          {"chi", format_quantity(model.chi_dB2, kVariance)},
          {"outer_wall", format_quantity(model.outer_wall.value, kPowerRatio)},
          {"inner_wall", format_quantity(model.inner_wall.value, kPowerRatio)}};
}

Json json_of(const TwoRayPropagation& model) {
  return {{"model", "two-ray"},
          {"ground", name_of(kGroundNames, model.ground)},
          {"polarisation", name_of(kPolarisationNames, model.polarisation)},
          {"roughness", format_quantity(model.roughness_m, kLength)}};
}

Json json_of(const StreetCanyonPropagation& model) {
  return {{"model", "p1411"}, {"bound", name_of(kCanyonBoundNames, model.bound)}};
}

Json with_line_of_sight(Json model, const LineOfSight& line_of_sight) {
  model["line_of_sight"] = line_of_sight.mean ? "mean" : "drawn";
  if (!line_of_sight.mean) {
    model["decorrelation"] = format_quantity(line_of_sight.decorrelation_m, kLength);
  }
  return model;
}

Json json_of(const AlHouraniPropagation& model) {
  return with_line_of_sight(
      {{"model", "al-hourani"}, {"environment", name_of(kBuiltUpAreaNames, model.environment)}},
      model.line_of_sight);
}

Json json_of(const Tr36777Propagation& model) {
  return with_line_of_sight(
      {{"model", "tr36777"}, {"scenario", name_of(kAerialAreaNames, model.area)}},
      model.line_of_sight);
}

Json json_of(const NoFading& /*fading*/) { return "none"; }

Json json_of(const RiceFading& rice) {
  Json fading{{"model", rice.k_factor ? "rice" : "rayleigh"},
              {"residual_doppler", format_quantity(rice.residual_doppler_Hz, kFrequency)}};
  if (rice.k_factor) {
    fading["k_factor"] = format_quantity(rice.k_factor->value, kPowerRatio);
    fading["k_factor_overhead"] = format_quantity(rice.k_factor_overhead.value, kPowerRatio);
  }
  return fading;
}

Json json_of(const NakagamiFading& nakagami) { return {{"model", "nakagami"}, {"m", nakagami.m}}; }

Json json_of(const std::optional<Shadowing>& shadowing) {
  if (!shadowing) {
    return "none";
  }
  return {{"deviation", format_quantity(shadowing->deviation_dB, kPowerRatio)},
          {"decorrelation", format_quantity(shadowing->decorrelation_m, kLength)}};
}

Json json_of(const DcfMac& /*mac*/) { return {{"model", "dcf"}}; }

Json json_of(const EdcaCategory& category) {
  return {{"aifsn", category.aifsn}, {"cw_min", category.cw_min}, {"cw_max", category.cw_max}};
}

Json json_of(const EdcaMac& edca) {
  return {{"model", "edca"},
          {"background", json_of(edca.background)},
          {"best_effort", json_of(edca.best_effort)},
          {"video", json_of(edca.video)},
          {"voice", json_of(edca.voice)}};
}

Json json_of(const TdmaMac& tdma) {
  return {{"model", "tdma"},
          {"slot", text(tdma.slot)},
          {"guard", text(tdma.guard)},
          {"frame", tdma.frame.empty() ? Json("nodes") : Json(tdma.frame)}};
}

Json json_of(const IdealMac& ideal) {
  return {{"model", "ideal"},
          {"delay", text(ideal.delay)},
          {"jitter", text(ideal.jitter)},
          {"loss", ideal.loss},
          {"range", ideal.range_m ? format_quantity(*ideal.range_m, kLength) : "none"}};
}

Json json_of(const IsotropicAntenna& /*antenna*/) { return "isotropic"; }
Json json_of(const DipoleAntenna& /*antenna*/) { return "dipole"; }
Json json_of(const PatternAntenna& antenna) { return {{"gains", antenna.gains_dBi}}; }

Json json_of(const std::optional<Disruption>& disruption) {
  if (!disruption) {
    return "none";
  }
  return {{"fraction", disruption->fraction},
          {"interval", text(disruption->interval)},
          {"phase", disruption->phase ? text(*disruption->phase) : "random"}};
}

Json json_of(const BoxObstacle& box) {
  Json inner_walls = "none";
  if (box.inner_walls) {
    inner_walls = {{"spacing", format_quantity(box.inner_walls->spacing_m, kLength)},
                   {"loss", format_quantity(box.inner_walls->loss.value, kPowerRatio)}};
  }
  return {{"name", box.name},
          {"centre", lengths(box.centre_m)},
          {"size", lengths(box.size_m)},
          {"heading", format_quantity(box.heading_rad, kAngle)},
          {"outer_wall", format_quantity(box.outer_wall.value, kPowerRatio)},
          {"inner_walls", inner_walls}};
}

Json json_of(const Jammer& jammer) {
  return {{"name", jammer.name},
          {"position", lengths(jammer.position_m)},
          {"power", format_quantity(jammer.power.value, kPower)},
          {"frequency",
           jammer.frequency_hz ? format_quantity(*jammer.frequency_hz, kFrequency) : "channel"},
          {"bandwidth", format_quantity(jammer.bandwidth_hz, kFrequency)},
          {"duty", jammer.duty},
          {"period", text(jammer.period)},
          {"start", text(jammer.start)},
          {"stop", jammer.stop ? text(*jammer.stop) : "none"}};
}

template <typename Element>
Json array_of(const std::vector<Element>& elements) {
  Json array = Json::array();
  for (const Element& element : elements) {
    array.push_back(json_of(element));
  }
  return array;
}

Json json_of(const Radio& radio) {
  Json basic_rates = Json::array();
  for (const std::uint32_t rate_kbps : radio.basic_rates_kbps) {
    basic_rates.push_back(bit_rate_text(rate_kbps));
  }
  Json detection = "none";
  if (radio.preamble_detection) {
    const auto& [power, sinr] = *radio.preamble_detection;
    detection = {{"minimum_power", format_quantity(power.value, kPower)},
                 {"minimum_sinr", format_quantity(sinr.value, kPowerRatio)}};
  }
  Json capture = "none";
  if (radio.capture) {
    const auto& [preamble, frame] = *radio.capture;
    capture = {{"preamble", format_quantity(preamble.value, kPowerRatio)},
               {"frame", frame ? Json(format_quantity(frame->value, kPowerRatio)) : Json("none")}};
  }
  return {
      {"standard", name_of(kRadioStandardNames, radio.standard)},
      {"data_rate", bit_rate_text(radio.data_rate_kbps)},
      {"group_rate", bit_rate_text(radio.group_rate_kbps)},
      {"rate_control", name_of(kRateControlNames, radio.rate_control)},
      {"basic_rates", basic_rates},
      {"control_answer", name_of(kControlAnswerNames, radio.control_answer)},
      {"preamble", name_of(kDsssPreambleNames, radio.dsss_preamble)},
      {"channel_frequency", format_quantity(radio.channel_frequency_hz, kFrequency)},
      {"tx_power", format_quantity(radio.tx_power.value, kPower)},
      {"antenna_gain", format_quantity(radio.antenna_gain.value, kPowerRatio)},
      {"antenna", std::visit([](const auto& antenna) { return json_of(antenna); }, radio.antenna)},
      {"noise_figure", format_quantity(radio.noise_figure.value, kPowerRatio)},
      {"slot", text(radio.slot)},
      {"retry_limit", radio.retry_limit},
      {"long_retry_limit", radio.long_retry_limit},
      {"rts_threshold",
       radio.rts_threshold_bytes ? Json(*radio.rts_threshold_bytes) : Json("none")},
      {"mac", std::visit([](const auto& mac) { return json_of(mac); }, radio.mac)},
      {"queue", {{"frames", radio.queue_frames}, {"lifetime", text(radio.queue_lifetime)}}},
      {"error_model", name_of(kErrorModelNames, radio.error_model)},
      {"cca",
       {{"preamble", format_quantity(radio.cca_preamble.value, kPower)},
        {"energy", format_quantity(radio.cca_energy.value, kPower)}}},
      {"preamble_detection", detection},
      {"capture", capture},
      {"propagation",
       std::visit([](const auto& model) { return json_of(model); }, radio.propagation)},
      {"shadowing", json_of(radio.shadowing)},
      {"fading", std::visit([](const auto& model) { return json_of(model); }, radio.fading)},
      {"disruption", json_of(radio.disruption)},
      {"obstacles", array_of(radio.obstacles)},
      {"walls", name_of(kWallModelNames, radio.walls)},
      {"jammers", array_of(radio.jammers)}};
}

Json json_of(const std::optional<CitySection>& city) {
  if (!city) {
    return "none";
  }
  Json object;
  if (city->file) {
    object["file"] = city->file->file.string();
    if (const auto& bounds = city->file->bounds_deg) {
      object["bounds"] = {{"west", (*bounds)[0]},
                          {"south", (*bounds)[1]},
                          {"east", (*bounds)[2]},
                          {"north", (*bounds)[3]}};
    }
  } else {
    object["generate"] = name_of(kCityStyleNames, city->generated->style);
    if (city->generated->seed) {
      object["seed"] = *city->generated->seed;
    }
    object["size"] = format_quantity(city->generated->size_m, kLength);
  }
  object["heights"] = lengths(city->heights_m);
  object["level"] = format_quantity(city->level_m, kLength);
  object["walls"] = name_of(kMaterialNames, city->walls);
  object["room"] = format_quantity(city->room_m, kLength);
  if (!city->terrain.empty()) {
    object["terrain"] = city->terrain.string();
  }
  return object;
}

Json json_of(const World& world) {
  Json object{
      {"step", text(world.step)},
      {"gravity", format_quantity(world.gravity_mps2, kAcceleration)},
      {"imu",
       {{"rate", rate_text(world.imu_period)},
        {"gyro_noise", format_quantity(world.gyro_noise_radps, kAngularRate)},
        {"accelerometer_noise", format_quantity(world.accelerometer_noise_mps2, kAcceleration)}}},
      {"motion_capture",
       {{"rate", rate_text(world.motion_capture_period)},
        {"position_noise", format_quantity(world.motion_capture_noise_m, kLength)},
        {"attitude_noise", format_quantity(world.motion_capture_noise_rad, kAngle)}}},
      {"epoch", format_utc(world.epoch)}};
  if (world.site) {
    object["site"] = {{"latitude", world.site->latitude_deg},
                      {"longitude", world.site->longitude_deg},
                      {"height", format_quantity(world.site->height_m, kLength)}};
  }
  return object;
}

Json json_of(const FixedVehicle& /*vehicle*/) { return {{"model", "fixed"}}; }

Json json_of(const std::optional<UltrasonicSensor>& sensor) {
  if (!sensor) {
    return "none";
  }
  return {{"rate", rate_text(sensor->period)},
          {"range", format_quantity(sensor->range_m, kLength)},
          {"beam", format_quantity(sensor->beam_rad, kAngle)},
          {"noise", format_quantity(sensor->noise_m, kLength)},
          {"direction", name_of(kSensorDirectionNames, sensor->direction)}};
}

Json json_of(const std::optional<LidarSensor>& lidar) {
  if (!lidar) {
    return "none";
  }
  Json elevations = Json::array();
  for (const double elevation_rad : lidar->elevations_rad) {
    elevations.push_back(format_quantity(elevation_rad, kAngle));
  }
  return {{"rate", rate_text(lidar->period)},
          {"range", format_quantity(lidar->range_m, kLength)},
          {"field", format_quantity(lidar->field_rad, kAngle)},
          {"rays", lidar->rays},
          {"elevations", elevations},
          {"noise", format_quantity(lidar->noise_m, kLength)}};
}

Json json_of(const std::optional<GnssSensor>& gnss) {
  if (!gnss) {
    return "none";
  }
  return {{"rate", rate_text(gnss->period)},
          {"mask", format_quantity(gnss->mask_rad, kAngle)},
          {"drift", format_quantity(gnss->drift_m, kLength)},
          {"correlation_time", text(gnss->correlation_time)},
          {"noise", format_quantity(gnss->noise_m, kLength)},
          {"rate_noise", format_quantity(gnss->rate_noise_mps, kSpeed)}};
}

Json json_of(const std::optional<CameraSensor>& camera) {
  if (!camera) {
    return "none";
  }
  return {{"width", camera->width_px},
          {"height", camera->height_px},
          {"rate", rate_text(camera->period)},
          {"field", format_quantity(camera->field_rad, kAngle)},
          {"direction",
           {{"roll", format_quantity(camera->direction.roll_rad, kAngle)},
            {"pitch", format_quantity(camera->direction.pitch_rad, kAngle)},
            {"yaw", format_quantity(camera->direction.yaw_rad, kAngle)}}},
          {"offset", lengths(camera->offset_m)}};
}

Json json_of(const X4Vehicle& x4) {
  return {{"model", "x4"},
          {"mass", format_quantity(x4.mass_kg, kMass)},
          {"arm", format_quantity(x4.arm_m, kLength)},
          {"inertia",
           {{"roll", format_quantity(x4.inertia_roll_kgm2, kMomentOfInertia)},
            {"pitch", format_quantity(x4.inertia_pitch_kgm2, kMomentOfInertia)},
            {"yaw", format_quantity(x4.inertia_yaw_kgm2, kMomentOfInertia)}}},
          {"drag",
           {{"vertical", format_quantity(x4.drag_vertical_Nspm, kDrag)},
            {"lateral", format_quantity(x4.drag_lateral_Nspm, kDrag)}}},
          {"motor_timeout", text(x4.motor_timeout)},
          {"faithful", x4.faithful},
          {"collision",
           {{"behaviour", name_of(kCollisionBehaviourNames, x4.collision.behaviour)},
            {"restitution", x4.collision.restitution},
            {"radius", format_quantity(x4.collision.radius_m, kLength)}}},
          {"sensors",
           {{"ultrasonic", json_of(x4.sensors.ultrasonic)},
            {"lidar", json_of(x4.sensors.lidar)},
            {"gnss", json_of(x4.sensors.gnss)},
            {"camera", json_of(x4.sensors.camera)}}}};
}

Json json_of(const CircleLayout& circle) {
  return {{"layout", "circle"},
          {"radius", format_quantity(circle.radius_m, kLength)},
          {"centre", lengths(circle.centre_m)}};
}

Json json_of(const GridLayout& grid) {
  return {{"layout", "grid"},
          {"spacing", format_quantity(grid.spacing_m, kLength)},
          {"centre", lengths(grid.centre_m)}};
}

Json json_of(const LineLayout& line) {
  return {{"layout", "line"},
          {"spacing", format_quantity(line.spacing_m, kLength)},
          {"centre", lengths(line.centre_m)},
          {"direction", format_quantity(line.direction_rad, kAngle)}};
}

Json json_of(const ListLayout& list) {
  Json positions = Json::array();
  for (const Position_m& position_m : list.positions_m) {
    positions.push_back(lengths(position_m));
  }
  return {{"layout", "list"}, {"positions", positions}};
}

Json json_of(const std::optional<CircleMission>& mission) {
  if (!mission) {
    return "none";
  }
  return {{"type", "circle"},
          {"centre", lengths(mission->centre_m)},
          {"radius", format_quantity(mission->radius_m, kLength)},
          {"altitude", format_quantity(mission->altitude_m, kLength)},
          {"speed", format_quantity(mission->speed_mps, kSpeed)},
          {"spacing_gain", mission->spacing_gain}};
}

Json json_of(const Group& group) {
  Json start = std::visit([](const auto& layout) { return json_of(layout); }, group.start.layout);
  start["heading"] = format_quantity(group.start.heading_rad, kAngle);
  return {
      {"name", group.name},
      {"count", group.count},
      {"vehicle", std::visit([](const auto& vehicle) { return json_of(vehicle); }, group.vehicle)},
      {"start", start},
      {"autopilot", group.autopilot},
      {"mission", json_of(group.mission)},
      {"neighbours",
       {{"source", name_of(kNeighbourSourceNames, group.neighbours.source)},
        {"beacon_period", text(group.neighbours.beacon_period)},
        {"timeout", text(group.neighbours.timeout)},
        {"port", group.neighbours.port}}},
      {"control_period", text(group.control_period)},
      {"telemetry_period", text(group.telemetry_period)},
      {"agent", group.agent.empty() ? Json("cuscus-agent") : Json(group.agent)},
      {"command", group.command.empty() ? Json("none") : Json(group.command)},
      {"environment", Json(group.environment)},
      {"capabilities", Json(group.capabilities)},
      {"on_exit", name_of(kOnExitNames, group.on_exit)}};
}

}  // namespace

Json to_json(const Scenario& scenario) {
  Json fleet = Json::array();
  for (const Group& group : scenario.fleet) {
    fleet.push_back(json_of(group));
  }
  const Network& network = scenario.network;
  const GroundStation& station = scenario.ground_station;
  const Captures& captures = scenario.record.captures;
  return {{"name", scenario.name},
          {"description", scenario.description},
          {"seed", scenario.seed},
          {"duration", text(scenario.duration)},
          {"clock", name_of(kClockNames, scenario.clock)},
          {"realtime", scenario.realtime},
          {"on_late", name_of(kOnLateNames, scenario.on_late)},
          {"city", json_of(scenario.city)},
          {"radio", json_of(scenario.radio)},
          {"network",
           {{"subnet", subnet_text(network.subnet)},
            {"attach", name_of(kAttachNames, network.attach)},
            {"neighbours", name_of(kAddressResolutionNames, network.neighbours)},
            {"ipv6", network.ipv6},
            {"mtu", network.mtu_bytes},
            {"hosts", network.hosts},
            {"monitor", network.monitor}}},
          {"world", json_of(scenario.world)},
          {"fleet", fleet},
          {"ground_station",
           {{"enabled", station.enabled},
            {"position", lengths(station.position_m)},
            {"telemetry_port", station.telemetry_port},
            {"page", station.page_port ? Json{{"port", *station.page_port}} : Json("none")}}},
          {"record",
           {{"frames", scenario.record.frames},
            {"receptions", scenario.record.receptions},
            {"captures", captures.nodes.empty() ? Json(captures.everyone) : Json(captures.nodes)},
            {"failed_receptions", captures.failed_receptions},
            {"snap_length",
             captures.snap_length_bytes ? Json(*captures.snap_length_bytes) : Json("none")},
            {"metrics_period", text(scenario.record.metrics_period)}}}};
}

}  // namespace cuscus::scenario
