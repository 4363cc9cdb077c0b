#include "netsim/app/frame_record.h"

#include <array>
#include <charconv>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace cuscus::netsim {
namespace {

constexpr std::array<std::string_view, 5> kOutcomes{"sent", "acknowledged", "queue-full",
                                                    "lifetime", "retry-limit"};

/// Cuts the text up to the next comma off `line`.
std::string_view next_field(std::string_view& line) {
  const std::size_t comma = line.find(',');
  const std::string_view field = line.substr(0, comma);
  line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  return field;
}

template <typename Integer>
bool read(std::string_view field, Integer& value) {
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

}  // namespace

std::string_view name_of(SendOutcome outcome) {
  return kOutcomes.at(static_cast<std::size_t>(outcome));
}

std::string frame_log_header(const AirParameters& p) {
  std::ostringstream text;
  text << "# cuscus frame log 1; times are nanoseconds since the run began\n"
       << "# nodes=" << p.nodes.size() << "\n# seed=" << p.seed
       << "\n# data_rate_kbps=" << p.data_rate_kbps << "\n# group_rate_kbps=" << p.group_rate_kbps
       << "\n# slot_ns=" << p.slot.count() << "\n# retry_limit=" << p.retry_limit
       << "\n# queue_frames=" << p.queue_frames
       << "\n# queue_lifetime_ns=" << p.queue_lifetime.count()
       << "\n# noise_figure_db=" << text_of(p.noise_figure.value)
       << "\n# cca_preamble_dbm=" << text_of(p.cca_preamble.value)
       << "\n# cca_energy_dbm=" << text_of(p.cca_energy.value)
       << "\n# detection_minimum_dbm=" << text_of(p.detection_minimum.value)
       << "\n# detection_minimum_sinr_db=" << text_of(p.detection_minimum_sinr.value)
       << "\nsent_ns,node,destination,bytes,attempts,outcome,delivered_count,first_delivery_ns\n";
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
  text += ',' + std::to_string(r.deliveries) + ',' + std::to_string(r.first_delivery_ns) + '\n';
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
  if (!read(next_field(line), r.deliveries) || !read(next_field(line), r.first_delivery_ns) ||
      !line.empty()) {
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
  const std::string value{line.substr(equals + 1)};
  const auto number = [&] { return std::stod(value); };
  const auto integer = [&] { return std::stoll(value); };
  if (key == "nodes") {
    p.nodes.assign(static_cast<std::size_t>(integer()), AirNode{});
  } else if (key == "seed") {
    p.seed = std::stoull(value);
  } else if (key == "data_rate_kbps") {
    p.data_rate_kbps = static_cast<std::uint32_t>(integer());
  } else if (key == "group_rate_kbps") {
    p.group_rate_kbps = static_cast<std::uint32_t>(integer());
  } else if (key == "slot_ns") {
    p.slot = Duration{integer()};
  } else if (key == "retry_limit") {
    p.retry_limit = static_cast<std::uint32_t>(integer());
  } else if (key == "queue_frames") {
    p.queue_frames = static_cast<std::uint32_t>(integer());
  } else if (key == "queue_lifetime_ns") {
    p.queue_lifetime = Duration{integer()};
  } else if (key == "noise_figure_db") {
    p.noise_figure.value = number();
  } else if (key == "cca_preamble_dbm") {
    p.cca_preamble.value = number();
  } else if (key == "cca_energy_dbm") {
    p.cca_energy.value = number();
  } else if (key == "detection_minimum_dbm") {
    p.detection_minimum.value = number();
  } else if (key == "detection_minimum_sinr_db") {
    p.detection_minimum_sinr.value = number();
  } else {
    return false;
  }
  return true;
}

}  // namespace cuscus::netsim
