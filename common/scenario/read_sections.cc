#include "common/scenario/section_readers.h"
#include "common/scenario/utc.h"

namespace cuscus::scenario {

using nlohmann::json;

Network read_network(const json* value, Problems& problems) {
  Network network;
  ObjectReader reader{value, "/network", problems};
  const std::string subnet = reader.text("subnet", subnet_text(network.subnet), 256);
  if (const auto parsed = parse_subnet(subnet)) {
    const std::uint32_t first_octet = parsed->network >> 24U;
    constexpr std::uint32_t kLoopback = 127;
    constexpr std::uint32_t kMulticast = 224;
    network.subnet = *parsed;
    if ((parsed->network & ~parsed->mask()) != 0) {
      const Subnet aligned{parsed->network & parsed->mask(), parsed->prefix_length};
      reader.problem("subnet", shown(subnet) + " has host bits set; allowed: the network itself, " +
                                   "here \"" + subnet_text(aligned) + "\"");
    } else if (parsed->prefix_length < 8 || parsed->prefix_length > 30) {
      reader.problem("subnet", shown(subnet) + " is too large or too small; allowed: /8 ... /30");
    } else if (first_octet == 0 || first_octet == kLoopback || first_octet >= kMulticast) {
      reader.problem("subnet", shown(subnet) + " is no network for hosts; allowed: such as " +
                                   "\"10.42.0.0/16\"");
    }
  } else {
    reader.problem("subnet",
                   shown(subnet) + " is not an IPv4 network; allowed: such as \"10.42.0.0/16\"");
  }
  network.attach = reader.choice("attach", network.attach, kAttachNames);
  network.neighbours = reader.choice("neighbours", network.neighbours, kAddressResolutionNames);
  network.ipv6 = reader.boolean("ipv6", network.ipv6);
  // Least: what every IPv4 host must take (RFC 791), every IPv6 link (RFC 8200).
  const std::uint32_t least_mtu = network.ipv6 ? 1280 : 576;
  network.mtu_bytes = reader.integer<std::uint32_t>("mtu", network.mtu_bytes, {least_mtu, 1500});
  network.hosts = reader.boolean("hosts", network.hosts);
  network.monitor = reader.boolean("monitor", network.monitor);
  reader.finish();
  return network;
}

namespace {

void read_imu(const json* value, const std::string& path, World& world, Problems& problems) {
  ObjectReader reader{value, path, problems};
  world.imu_period = reader.period_of_rate("rate", world.imu_period, "10 Hz", "10 kHz");
  world.gyro_noise_radps = reader.quantity("gyro_noise", world.gyro_noise_radps,
                                           {kAngularRate, "0 deg/s", "1000 deg/s"});
  world.accelerometer_noise_mps2 = reader.quantity(
      "accelerometer_noise", world.accelerometer_noise_mps2, {kAcceleration, "0 m/s2", "100 m/s2"});
  reader.finish();
}

void read_motion_capture(const json* value, const std::string& path, World& world,
                         Problems& problems) {
  ObjectReader reader{value, path, problems};
  world.motion_capture_period =
      reader.period_of_rate("rate", world.motion_capture_period, "1 Hz", "1 kHz");
  world.motion_capture_noise_m =
      reader.quantity("position_noise", world.motion_capture_noise_m, {kLength, "0 m", "1 m"});
  world.motion_capture_noise_rad = reader.quantity("attitude_noise", world.motion_capture_noise_rad,
                                                   {kAngle, "0 deg", "90 deg"});
  reader.finish();
}

}  // namespace

namespace {

std::chrono::sys_seconds read_epoch(ObjectReader& reader, std::chrono::sys_seconds fallback) {
  constexpr std::size_t kLongestText_bytes = 64;
  const std::string text = reader.text("epoch", format_utc(fallback), kLongestText_bytes);
  const auto epoch = parse_utc(text);
  if (!epoch) {
    reader.problem("epoch", shown(text) +
                                " is no time of 1980 ... 2099 in UTC; allowed: such as \"" +
                                format_utc(fallback) + '"');
  }
  return epoch.value_or(fallback);
}

std::optional<city::Geodetic> read_site(const json* value, const std::string& path,
                                        Problems& problems) {
  if (value == nullptr) {
    return std::nullopt;
  }
  city::Geodetic site = kDefaultSite;
  ObjectReader reader{value, path, problems};
  site.latitude_deg = reader.number("latitude", site.latitude_deg, {-90.0, 90.0});
  site.longitude_deg = reader.number("longitude", site.longitude_deg, {-180.0, 180.0});
  site.height_m = reader.quantity("height", site.height_m, {kLength, "-500 m", "9 km"});
  reader.finish();
  return site;
}

}  // namespace

World read_world(const json* value, Problems& problems) {
  World world;
  ObjectReader reader{value, "/world", problems};
  world.step = reader.duration("step", world.step, "100 us", "10 ms");
  world.gravity_mps2 =
      reader.quantity("gravity", world.gravity_mps2, {kAcceleration, "0.1 m/s2", "30 m/s2"});
  read_imu(reader.child("imu"), reader.path_of("imu"), world, problems);
  read_motion_capture(reader.child("motion_capture"), reader.path_of("motion_capture"), world,
                      problems);
  world.epoch = read_epoch(reader, world.epoch);
  world.site = read_site(reader.child("site"), reader.path_of("site"), problems);
  reader.finish();
  if (problems.empty()) {
    const auto check_multiple = [&](const std::string& path, Duration period) {
      if (period.count() % world.step.count() != 0) {
        problems.add(path, "has a period of " +
                               format_quantity(static_cast<double>(period.count()), kTime) +
                               "; allowed: a whole number of world steps of " +
                               format_quantity(static_cast<double>(world.step.count()), kTime));
      }
    };
    check_multiple("/world/imu/rate", world.imu_period);
    check_multiple("/world/motion_capture/rate", world.motion_capture_period);
  }
  return world;
}

GroundStation read_ground_station(const json* value, Problems& problems) {
  GroundStation station;
  ObjectReader reader{value, "/ground_station", problems};
  station.enabled = reader.boolean("enabled", station.enabled);
  station.position_m = reader.lengths("position", station.position_m);
  station.telemetry_port =
      reader.integer<std::uint16_t>("telemetry_port", station.telemetry_port, {1024, 65535});
  const json* page = reader.child("page");
  if (page != nullptr && page->is_string()) {
    if (*page != "none") {
      reader.problem("page", shown(*page) + " is not known; allowed: none, or an object with port");
    }
    station.page_port.reset();
  } else {
    ObjectReader page_reader{page, reader.path_of("page"), problems};
    station.page_port = page_reader.integer<std::uint16_t>("port", *station.page_port, {1, 65535});
    page_reader.finish();
  }
  reader.finish();
  return station;
}

}  // namespace cuscus::scenario
