#include "netsim/app/synthetic_table.h"

#include <spdlog/fmt/fmt.h>

#include <span>
#include <stdexcept>

#include "netsim/app/city_of_message.h"
#include "netsim/app/synthetic_configuration.h"

namespace cuscus::netsim {

std::string_view result_columns() {
  return "goodput_mbps,delivery_ratio,attempt_success,attempts_per_frame,drops_per_s,jain,"
         "delay_mean_us,delay_p50_us,delay_p99_us,delay_max_us,round_trip_us,"
         "lost_below_floor,lost_below_detection,lost_noise,lost_collision,lost_interference,"
         "lost_half_duplex,lost_jammed,"
         "dropped_queue_full,dropped_lifetime,dropped_retry_limit,dropped_too_long,receptions";
}

std::string result_fields(const SyntheticResult& r) {
  Tally sum;
  for (const Tally& t : r.tallies) {
    sum.lost_below_floor += t.lost_below_floor;
    sum.lost_below_detection += t.lost_below_detection;
    sum.lost_noise += t.lost_noise;
    sum.lost_collision += t.lost_collision;
    sum.lost_interference += t.lost_interference;
    sum.lost_half_duplex += t.lost_half_duplex;
    sum.lost_jammed += t.lost_jammed;
    sum.dropped_queue_full += t.dropped_queue_full;
    sum.dropped_lifetime += t.dropped_lifetime;
    sum.dropped_retry_limit += t.dropped_retry_limit;
    sum.dropped_too_long += t.dropped_too_long;
  }
  return fmt::format(
      "{:.4f},{:.5f},{:.4f},{:.4f},{:.2f},{:.4f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{},{},{},{},{},"
      "{},{},{},{},{},{},{}",
      r.goodput_mbps, r.delivery_ratio, r.attempt_success, r.attempts_per_frame, r.drops_per_s,
      r.jain, r.delay_mean_us, r.delay_p50_us, r.delay_p99_us, r.delay_max_us, r.round_trip_mean_us,
      sum.lost_below_floor, sum.lost_below_detection, sum.lost_noise, sum.lost_collision,
      sum.lost_interference, sum.lost_half_duplex, sum.lost_jammed, sum.dropped_queue_full,
      sum.dropped_lifetime, sum.dropped_retry_limit, sum.dropped_too_long, r.receptions);
}

void print_runs(const proto::SyntheticRuns& runs, const std::function<std::ostream&()>& output) {
  std::ostream* out = nullptr;
  for (const proto::SyntheticRun& run : runs.runs()) {
    SyntheticParameters p = synthetic_parameters(run);
    if (!runs.city().empty()) {
      const auto city = put_city(std::as_bytes(std::span{runs.city()}), p.air.channel);
      for (Eigen::Vector3d& p_WN_m : p.layout.p_WN_m) {
        p_WN_m.z() += city->ground_m(p_WN_m.head<2>());
      }
    }
    const std::string fields = result_fields(run_synthetic(p));
    if (out == nullptr) {
      out = &output();
      *out << "scenario,traffic,cast,nodes,payload_B,seed,measure_s," << result_columns() << '\n';
    }
    *out << fmt::format("{},{},{},{},{},{},{:.3f},{}\n", runs.scenario_name(), run.traffic().kind(),
                        p.traffic.group ? "bcast" : "ucast", p.senders, p.traffic.udp_payload_bytes,
                        p.air.seed, to_seconds(p.duration), fields);
    if (!out->flush()) {
      throw std::runtime_error{"the table cannot be written"};
    }
  }
}

}  // namespace cuscus::netsim
