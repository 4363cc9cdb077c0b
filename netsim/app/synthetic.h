#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "netsim/air/air.h"

namespace cuscus::netsim {

/// Where synthetic nodes stand.
struct Layout {
  /// kHidden: senders hear the sink and nobody else. kGiven: AirParameters has the nodes, and
  /// p_WN_m where they are.
  enum class Kind : std::uint8_t { kEqualPower, kCircle, kLine, kHidden, kGiven };
  Kind kind{Kind::kEqualPower};
  DecibelMilliwatt equal_power{-50.0};  ///< Every link that there is.
  double circle_radius_m{10.0};
  double line_spacing_m{100.0};
  std::vector<Eigen::Vector3d> p_WN_m{};
  std::vector<Eigen::Quaterniond> q_WN{};  ///< Empty: all level, facing east.
};

/// What synthetic nodes send.
struct Traffic {
  enum class Kind : std::uint8_t {
    kBeacons,    ///< Every node broadcasts with a period, at a random phase.
    kSaturated,  ///< Every sender always has a frame waiting.
    kFlow,       ///< `from` sends to `to` with a period; 0: the next as soon as one is over.
    kPing        ///< `from` sends to `to`, which answers at once; the next follows a period on.
  };
  Kind kind{Kind::kBeacons};
  bool group{true};
  bool to_sink{false};  ///< All to one further node that sends nothing, not to a neighbour each.
  std::uint32_t from{0};
  std::uint32_t to{1};
  std::uint32_t udp_payload_bytes{64};
  Duration period{std::chrono::milliseconds{50}};
  Duration jitter{0};                       ///< Per beacon, uniform.
  std::vector<std::uint8_t> priorities{0};  ///< User priorities of the senders, in turn.
};

struct SyntheticParameters {
  AirParameters air;  ///< `nodes`, unless given, and for equal power `channel` are filled in.
  std::uint32_t senders{2};  ///< There is a second node where this is 1.
  Layout layout;
  Traffic traffic;
  Duration warm_up{std::chrono::milliseconds{500}};
  Duration duration{std::chrono::seconds{5}};  ///< Measured, after the warm-up.
};

struct SyntheticResult {
  double goodput_mbps{};     ///< UDP payload, of all senders; of group frames per receiver.
  double delivery_ratio{};   ///< Group: per receiver. Individually addressed: of finished frames.
  double attempt_success{};  ///< Acknowledged of all attempts, those of unfinished frames too.
  double attempts_per_frame{};
  double drops_per_s{};  ///< By the retry limit.
  double jain{};         ///< Fairness of the senders' goodputs.
  std::vector<double> sender_goodputs_mbps;
  double delay_mean_us{};
  double delay_p50_us{};
  double delay_p99_us{};
  double delay_max_us{};
  double round_trip_mean_us{};  ///< Ping only.
  std::uint64_t receptions{};
  std::uint64_t events{};
  std::vector<Tally> tallies;  ///< Of the whole run, warm-up included.
};

/// PSDU of a UDP datagram over IPv4.
[[nodiscard]] constexpr std::uint32_t psdu_bytes_of_udp(std::uint32_t payload_bytes) {
  constexpr std::uint32_t kIpAndUdpBytes = 28;
  return payload_bytes + kIpAndUdpBytes + kLlcSnapBytes + kDataHeaderBytes + kFcsBytes;
}

/// Simulates, as fast as it goes.
/// @throws std::invalid_argument as Air does.
[[nodiscard]] SyntheticResult run_synthetic(const SyntheticParameters& parameters);

}  // namespace cuscus::netsim
