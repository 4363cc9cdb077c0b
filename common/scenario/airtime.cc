#include <cmath>

#include "common/scenario/scenario.h"

namespace cuscus::scenario {

double psdu_airtime_s(const Radio& radio, std::uint32_t psdu_bytes, std::uint32_t rate_kbps) {
  const double rate_Mbps = rate_kbps / 1000.0;
  const bool is_dsss =
      rate_kbps == 1000 || rate_kbps == 2000 || rate_kbps == 5500 || rate_kbps == 11000;
  if (is_dsss) {
    const bool is_short = radio.dsss_preamble == DsssPreamble::kShort && rate_kbps > 1000;
    return ((is_short ? 96.0 : 192.0) + std::ceil(8.0 * psdu_bytes / rate_Mbps)) * 1e-6;
  }
  const double scale = radio.standard == RadioStandard::k80211p ? 2.0 : 1.0;
  const double extension = radio.standard == RadioStandard::k80211g ? 6.0 : 0.0;
  const double symbols = std::ceil((16.0 + 8.0 * psdu_bytes + 6.0) / (4.0 * scale * rate_Mbps));
  return (scale * (20.0 + 4.0 * symbols) + extension) * 1e-6;
}

std::uint32_t psdu_bytes(const Radio& radio, std::uint32_t ip_bytes) {
  const std::uint32_t header_bytes = std::holds_alternative<EdcaMac>(radio.mac) ? 26 : 24;
  return header_bytes + 8 + ip_bytes + 4;
}

double airtime_s(const Radio& radio, std::uint32_t ip_bytes, std::uint32_t rate_kbps) {
  return psdu_airtime_s(radio, psdu_bytes(radio, ip_bytes), rate_kbps);
}

}  // namespace cuscus::scenario
