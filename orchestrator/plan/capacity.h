#pragma once

#include <cstdint>

#include "common/scenario/scenario.h"
#include "orchestrator/plan/plan.h"

namespace cuscus::orchestrator {

/// Time on air of a frame whose IP packet has `ip_bytes`, preamble and signal extension included.
///
/// OFDM: 20 us + 4 us ceil((16 + 8 L + 6) / N_DBPS), 6 us more in 802.11g, all of it doubled in
/// 802.11p; DSSS: 192 us (96 us with a short preamble) + 8 L / R, with L the PSDU: 24 B of header,
/// 8 B of LLC/SNAP, the packet, 4 B of FCS.
/// Source: IEEE Std 802.11-2020, 18.3.2.4 and 17.3.2 (equation 17-29), 16.3.4.
[[nodiscard]] double airtime_s(const scenario::Radio& radio, std::uint32_t ip_bytes,
                               std::uint32_t rate_kbps);

/// What the beacons and the telemetry of `scenario` will cost. docs/scenario.md has the figures
/// that it multiplies and where they come from.
[[nodiscard]] CapacityEstimate estimate_capacity(const scenario::Scenario& scenario);

}  // namespace cuscus::orchestrator
