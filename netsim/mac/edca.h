#pragma once

#include <cstdint>

#include "netsim/mac/csma.h"

namespace cuscus::netsim {

/// Access categories of enhanced distributed channel access, the one that wins last (IEEE Std
/// 802.11-2016, table 10-1).
enum class AccessCategory : std::uint8_t { kBackground, kBestEffort, kVideo, kVoice };

/// Category of an 802.1D user priority, 0 ... 7: 1 and 2 are background, 0 and 3 best effort, 4 and
/// 5 video, 6 and 7 voice (table 10-1).
[[nodiscard]] AccessCategory access_category(std::uint8_t priority);

/// What stations take that no access point has told otherwise (IEEE Std 802.11-2016, tables 9-137
/// and, of stations outside of any BSS (802.11p), 9-138; the latter also ETSI EN 302 663 V1.2.1,
/// annex C), with aCWmin and aCWmax of the standard:
///
///   category    | CWmin          | CWmax          | AIFSN | AIFSN of 802.11p
///   background  | aCWmin         | aCWmax         | 7     | 9
///   best effort | aCWmin         | aCWmax         | 3     | 6
///   video       | (aCWmin+1)/2-1 | aCWmin         | 2     | 3
///   voice       | (aCWmin+1)/4-1 | (aCWmin+1)/2-1 | 2     | 2
///
/// The TXOP limit is 0 for all: one frame per access. The tables have one of 1.5 to 6 ms for video
/// and voice inside a BSS.
[[nodiscard]] EdcaParameters default_edca(const Standard& standard);

/// Enhanced distributed channel access (10.22.2): AIFS = SIFS + AIFSN slots, a queue and a backoff
/// for every category (Csma), QoS data frames, whose header is 2 B longer.
///
/// A slot counts when it is over, as in the DCF and in ns-3. By the letter of 10.22.2.4 it counts
/// when it begins: whoever is interrupted has one slot less to go, and is ahead of a DCF station
/// although AIFSN 2 is DIFS [G. Bianchi, I. Tinnirello, L. Scalia, IEEE Network 19(4), 2005].
[[nodiscard]] AccessProfile edca_access(const MacParameters& parameters);

}  // namespace cuscus::netsim
