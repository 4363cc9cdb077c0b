#include "orchestrator/results/metrics.h"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <iterator>
#include <system_error>
#include <utility>

#include "orchestrator/results/run_directory.h"

namespace cuscus::orchestrator {
namespace {

using shm::RadioTally;

constexpr std::array kCounters{
    std::pair{"offered", &RadioTally::offered},
    std::pair{"transmissions", &RadioTally::transmissions},
    std::pair{"retries", &RadioTally::retries},
    std::pair{"acknowledged", &RadioTally::acknowledged},
    std::pair{"received", &RadioTally::received},
    std::pair{"dropped_queue_full", &RadioTally::dropped_queue_full},
    std::pair{"dropped_lifetime", &RadioTally::dropped_lifetime},
    std::pair{"dropped_retry_limit", &RadioTally::dropped_retry_limit},
    std::pair{"dropped_malformed", &RadioTally::dropped_malformed},
    std::pair{"dropped_before_air", &RadioTally::dropped_before_air},
    std::pair{"lost_below_floor", &RadioTally::lost_below_floor},
    std::pair{"lost_below_detection", &RadioTally::lost_below_detection},
    std::pair{"lost_noise", &RadioTally::lost_noise},
    std::pair{"lost_collision", &RadioTally::lost_collision},
    std::pair{"lost_interference", &RadioTally::lost_interference},
    std::pair{"lost_half_duplex", &RadioTally::lost_half_duplex},
    std::pair{"lost_jammed", &RadioTally::lost_jammed},
    std::pair{"lost_interface", &RadioTally::lost_interface},
};

void append_number(std::string& line, double value) {
  line += ',';
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(line), "{:.4f}", value);
  }
}

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted{'"'};
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string{c};
  }
  return quoted + '"';
}

}  // namespace

std::string metrics_header() {
  std::string line =
      "sim_time_s,node,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,yaw_rad,formation_error_m,flight_state";
  for (const auto& [name, member] : kCounters) {
    line += ',';
    line += name;
  }
  return line + '\n';
}

std::string metrics_line(const MetricsRow& row) {
  std::string line =
      fmt::format("{:.6f},{}", to_seconds(row.time.time_since_epoch()), field(row.node));
  if (row.motion) {
    for (const double p_m : row.motion->p_WB_m) {
      append_number(line, p_m);
    }
    for (const double v_mps : row.motion->v_WB_W_mps) {
      append_number(line, v_mps);
    }
    const auto& [w, x, y, z] = row.motion->q_WB;
    append_number(line, std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)));
  } else {
    line += ",,,,,,,";
  }
  append_number(line, row.formation_error_m.value_or(NAN));
  line += ',' + field(row.flight_state);
  for (const auto& [name, member] : kCounters) {
    line += ',';
    if (row.radio) {
      line += std::to_string((*row.radio).*member);
    }
  }
  return line + '\n';
}

MetricsWriter::MetricsWriter(posix::UniqueFd file)
    : file_{std::move(file)}, pending_{metrics_header()} {}

void MetricsWriter::add(const MetricsRow& row) {
  constexpr std::size_t kMostPending = std::size_t{1} << 16U;
  if (failed_) {
    ++rows_dropped_;
    return;
  }
  pending_ += metrics_line(row);
  ++rows_pending_;
  if (pending_.size() > kMostPending) {
    flush();
  }
}

void MetricsWriter::flush() {
  if (failed_ || pending_.empty()) {
    return;
  }
  try {
    write_all(file_.get(), pending_);
    bytes_written_ += static_cast<std::int64_t>(pending_.size());
  } catch (const std::system_error& error) {
    failed_ = true;
    // Half a row would look like a whole one to a careless reader. A device refuses, which is well.
    static_cast<void>(::ftruncate(file_.get(), bytes_written_) == 0);
    rows_dropped_ += rows_pending_;
    error_ = std::string{"metrics.csv ends here, and the run goes on: "} + error.what();
  }
  pending_.clear();
  rows_pending_ = 0;
}

std::optional<std::string> MetricsWriter::take_error() {
  return std::exchange(error_, std::nullopt);
}

}  // namespace cuscus::orchestrator
