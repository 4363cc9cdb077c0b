#include "netsim/app/frame_record.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <span>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace cuscus::netsim {
namespace {

constexpr std::array<std::string_view, 6> kOutcomes{"sent",     "acknowledged", "queue-full",
                                                    "lifetime", "retry-limit",  "too-long"};

/// Cuts the text up to the next comma off `line`.
std::string_view next_field(std::string_view& line) {
  const std::size_t comma = line.find(',');
  const std::string_view field = line.substr(0, comma);
  line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  return field;
}

template <typename Number>
requires std::is_arithmetic_v<Number>
bool read(std::string_view field, Number& value) {
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  return error == std::errc{} && stop == end;
}

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}
std::string text_of(const std::string& value) { return value; }
std::string text_of(Duration value) { return std::to_string(value.count()); }
template <std::integral Integer>
std::string text_of(Integer value) {
  return std::to_string(value);
}

template <typename Enum>
requires std::is_enum_v<Enum> std::string text_of(Enum value) {
  return std::to_string(static_cast<int>(value));
}

template <typename Enum>
requires std::is_enum_v<Enum>
bool read(std::string_view field, Enum& value) {
  constexpr int kValues = 2;  // of every enumeration in the header
  int number = 0;
  const bool known = read(field, number) && number >= 0 && number < kValues;
  value = static_cast<Enum>(number);
  return known;
}
bool read(std::string_view field, std::string& value) {
  value = field;
  return true;
}
bool read(std::string_view field, Duration& value) {
  Duration::rep count = 0;
  const bool whole = read(field, count);
  value = Duration{count};
  return whole;
}

std::string text_of(const EdcaCategory& category) {
  return text_of(category.aifsn) + '/' + text_of(category.cw_min) + '/' + text_of(category.cw_max);
}
bool read(std::string_view field, EdcaCategory& category) {
  const std::size_t first = std::min(field.find('/'), field.size());
  const std::size_t second = std::min(field.find('/', first + 1), field.size());
  return second < field.size() && read(field.substr(0, first), category.aifsn) &&
         read(field.substr(first + 1, second - first - 1), category.cw_min) &&
         read(field.substr(second + 1), category.cw_max);
}

/// Numbers, or groups of them, with blanks between.
template <typename Number>
std::string text_of(const std::vector<Number>& values) {
  std::string text;
  for (const Number& value : values) {
    text += (text.empty() ? "" : " ") + text_of(value);
  }
  return text;
}
template <typename Number>
bool read(std::string_view field, std::vector<Number>& values) {
  values.clear();
  while (!field.empty()) {
    const std::size_t blank = std::min(field.find(' '), field.size());
    if (!read(field.substr(0, blank), values.emplace_back())) {
      return false;
    }
    field.remove_prefix(std::min(blank + 1, field.size()));
  }
  return true;
}

/// A row of numbers for each of a list of things, without breaks between them.
std::vector<double> row_of(const BoxObstacle& box) {
  const auto& [centre_m, size_m, heading_rad] = box.shape;
  return {centre_m.x(), centre_m.y(),         size_m.x(),          size_m.y(),          size_m.z(),
          heading_rad,  box.outer_wall.value, box.inner_spacing_m, box.inner_wall.value};
}
void take_row(std::span<const double> row, BoxObstacle& box) {
  box.shape = {
      .centre_m = {row[0], row[1]}, .size_m = {row[2], row[3], row[4]}, .heading_rad = row[5]};
  box.outer_wall = {row[6]};
  box.inner_spacing_m = row[7];
  box.inner_wall = {row[8]};
}

std::vector<double> row_of(const JammerParameters& jammer) {
  return {jammer.p_WJ.x(),
          jammer.p_WJ.y(),
          jammer.p_WJ.z(),
          jammer.power.value,
          jammer.band.centre_hz,
          jammer.band.width_hz,
          jammer.duty,
          to_seconds(jammer.period),
          to_seconds(jammer.start),
          jammer.stop == Duration::max() ? -1.0 : to_seconds(jammer.stop)};
}
void take_row(std::span<const double> row, JammerParameters& jammer) {
  const auto duration = [](double s) { return Duration{std::llround(s * 1e9)}; };
  jammer = {.p_WJ = {row[0], row[1], row[2]},
            .power = {row[3]},
            .band = {.centre_hz = row[4], .width_hz = row[5]},
            .duty = row[6],
            .period = duration(row[7]),
            .start = duration(row[8]),
            .stop = row[9] < 0.0 ? Duration::max() : duration(row[9])};
}

template <typename Thing>
concept HasRow = requires(const Thing& thing) {
  row_of(thing);
};

template <HasRow Thing>
std::string text_of(const std::vector<Thing>& things) {
  std::vector<double> rows;
  for (const Thing& thing : things) {
    const std::vector<double> row = row_of(thing);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return text_of(rows);
}
template <HasRow Thing>
bool read(std::string_view field, std::vector<Thing>& things) {
  std::vector<double> rows;
  const std::size_t length = row_of(Thing{}).size();
  if (!read(field, rows) || rows.size() % length != 0) {
    return false;
  }
  things.clear();
  for (std::size_t begin = 0; begin < rows.size(); begin += length) {
    take_row(std::span<const double>{rows}.subspan(begin, length), things.emplace_back());
  }
  return true;
}

/// One value per node.
template <typename Value>
std::vector<double> of_nodes(const AirParameters& p, Value AirNode::*member) {
  std::vector<double> values;
  for (const AirNode& node : p.nodes) {
    values.push_back((node.*member).value);
  }
  return values;
}
template <typename Value>
bool read_nodes(std::string_view field, AirParameters& p, Value AirNode::*member) {
  std::vector<double> values;
  if (!read(field, values) || values.size() != p.nodes.size()) {
    return false;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    (p.nodes[i].*member).value = values[i];
  }
  return true;
}

/// Calls `field` with the key and the member of everything that is the same for all nodes and that
/// a replay has to know.
template <typename Parameters, typename Field>
void for_each_common(Parameters& p, const Field& field) {
  field("seed", p.seed);
  field("standard", p.standard);
  field("data_rate_kbps", p.data_rate_kbps);
  field("group_rate_kbps", p.group_rate_kbps);
  field("rate_control", p.rate_control);
  field("basic_rates_kbps", p.basic_rates_kbps);
  field("control_answer", p.control_answer);
  field("dsss_preamble", p.dsss_preamble);
  field("slot_ns", p.slot);
  field("retry_limit", p.retry_limit);
  field("long_retry_limit", p.long_retry_limit);
  field("rts_threshold_bytes", p.rts_threshold_bytes);
  field("mac", p.mac);
  field("tdma_slot_ns", p.tdma.slot);
  field("tdma_guard_ns", p.tdma.guard);
  field("tdma_frame", p.tdma.frame);
  field("edca", p.edca);
  field("ideal_delay_ns", p.ideal.delay);
  field("ideal_jitter_ns", p.ideal.jitter);
  field("ideal_loss", p.ideal.loss);
  field("ideal_range_m", p.ideal.range_m);
  field("queue_frames", p.queue_frames);
  field("queue_lifetime_ns", p.queue_lifetime);
  field("error_model", p.error_model);
  field("noise_figure_db", p.noise_figure.value);
  field("cca_preamble_dbm", p.cca_preamble.value);
  field("cca_energy_dbm", p.cca_energy.value);
  field("sensitivity_dbm", p.sensitivity.value);
  field("detection_minimum_dbm", p.detection_minimum.value);
  field("detection_minimum_sinr_db", p.detection_minimum_sinr.value);
  field("capture_in_preamble_db", p.capture_in_preamble.value);
  field("capture_in_frame_db", p.capture_in_frame.value);
  field("carrier_hz", p.channel.carrier_hz);
  field("propagation", p.channel.model);
  field("exponent", p.channel.exponent);
  field("reference_loss_db", p.channel.reference_loss.value);
  field("alpha", p.channel.alpha);
  field("chi_db2", p.channel.chi_db2);
  field("outer_wall_db", p.channel.outer_wall.value);
  field("inner_wall_db", p.channel.inner_wall.value);
  field("ground", p.channel.ground);
  field("polarisation", p.channel.polarisation);
  field("roughness_m", p.channel.roughness_m);
  field("canyon_bound", p.channel.canyon_bound);
  field("environment", p.channel.environment);
  field("area", p.channel.area);
  field("line_of_sight", p.channel.line_of_sight);
  field("line_of_sight_decorrelation_m", p.channel.line_of_sight_decorrelation_m);
  field("shadowing_db", p.channel.shadowing_db);
  field("shadowing_decorrelation_m", p.channel.shadowing_decorrelation_m);
  field("fading", p.channel.fading);
  field("k_factor_db", p.channel.k_factor.value);
  field("k_factor_overhead_db", p.channel.k_factor_overhead.value);
  field("residual_doppler_hz", p.channel.residual_doppler_hz);
  field("nakagami_m", p.channel.nakagami_m);
  field("obstacles", p.channel.obstacles);
  field("walls", p.channel.walls);
  field("city_file", p.channel.city_file);
  field("jammers", p.jammers);
  field("antenna", p.antenna.model);
  field("antenna_pattern_dbi", p.antenna.pattern_dbi);
  field("antenna_pattern_azimuths", p.antenna.pattern_azimuths);
  field("disruption_fraction", p.disruption.fraction);
  field("disruption_interval_ns", p.disruption.interval);
  field("disruption_phase", p.disruption.phase);
  field("disruption_offset_ns", p.disruption.offset);
  field("disruption_seed", p.disruption.seed);
}

}  // namespace

std::string_view name_of(SendOutcome outcome) {
  return kOutcomes.at(static_cast<std::size_t>(outcome));
}

std::string frame_log_header(const AirParameters& p) {
  std::ostringstream text;
  text << "# cuscus frame log 1; times are nanoseconds since the run began\n"
       << "# nodes=" << p.nodes.size()
       << "\n# tx_power_dbm=" << text_of(of_nodes(p, &AirNode::tx_power))
       << "\n# antenna_gain_db=" << text_of(of_nodes(p, &AirNode::antenna_gain));
  for_each_common(p, [&text](std::string_view key, const auto& value) {
    text << "\n# " << key << '=' << text_of(value);
  });
  text << "\nsent_ns,node,destination,bytes,attempts,outcome,delivered_count,first_delivery_ns,"
          "priority\n";
  return text.str();
}

void append_frame_record(std::string& text, const FrameRecord& r) {
  text += std::to_string(r.sent_ns) + ',' + std::to_string(r.node) + ',';
  if (r.destination == kGroup) {
    text += "group";
  } else if (r.destination == kNobody) {
    text += "nobody";
  } else {
    text += std::to_string(r.destination);
  }
  text += ',' + std::to_string(r.frame_bytes) + ',' + std::to_string(r.attempts) + ',';
  text += name_of(r.outcome);
  text += ',' + std::to_string(r.deliveries) + ',' + std::to_string(r.first_delivery_ns) + ',' +
          std::to_string(r.priority) + '\n';
}

std::optional<FrameRecord> parse_frame_record(std::string_view line) {
  FrameRecord r{};
  if (!read(next_field(line), r.sent_ns) || !read(next_field(line), r.node)) {
    return std::nullopt;
  }
  const std::string_view destination = next_field(line);
  if (destination == "group") {
    r.destination = kGroup;
  } else if (destination == "nobody") {
    r.destination = kNobody;
  } else if (!read(destination, r.destination) || r.destination < 0) {
    return std::nullopt;
  }
  if (!read(next_field(line), r.frame_bytes) || !read(next_field(line), r.attempts)) {
    return std::nullopt;
  }
  const std::string_view outcome = next_field(line);
  std::size_t index = 0;
  while (index < kOutcomes.size() && kOutcomes.at(index) != outcome) {
    ++index;
  }
  if (index == kOutcomes.size()) {
    return std::nullopt;
  }
  r.outcome = static_cast<SendOutcome>(index);
  if (!read(next_field(line), r.deliveries) || !read(next_field(line), r.first_delivery_ns)) {
    return std::nullopt;
  }
  if (!line.empty() &&
      (!read(next_field(line), r.priority) || r.priority >= kPriorities || !line.empty())) {
    return std::nullopt;
  }
  return r;
}

bool parse_frame_log_header(std::string_view line, AirParameters& p) {
  const std::size_t equals = line.find('=');
  if (line.substr(0, 2) != "# " || equals == std::string_view::npos) {
    return false;
  }
  const std::string_view key = line.substr(2, equals - 2);
  const std::string_view value = line.substr(equals + 1);
  bool known = true;
  bool good = true;
  if (key == "nodes") {
    std::uint32_t count = 0;
    // More than the air takes: a damaged log must not make us ask for the memory.
    constexpr std::uint32_t kMostNodes = 65'535;
    good = read(value, count) && count <= kMostNodes;
    if (good) {
      p.nodes.assign(count, AirNode{});
    }
  } else if (key == "tx_power_dbm") {
    good = read_nodes(value, p, &AirNode::tx_power);
  } else if (key == "antenna_gain_db") {
    good = read_nodes(value, p, &AirNode::antenna_gain);
  } else {
    known = false;
    for_each_common(p, [&](std::string_view name, auto& member) {
      if (name == key) {
        known = true;
        good = read(value, member);
      }
    });
  }
  if (!good) {
    throw std::invalid_argument{"'" + std::string{key} + "' cannot be '" + std::string{value} +
                                "'"};
  }
  return known;
}

}  // namespace cuscus::netsim
