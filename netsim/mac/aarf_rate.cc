#include "netsim/mac/aarf_rate.h"

#include <algorithm>

namespace cuscus::netsim {

AarfRate::Peer& AarfRate::peer(std::uint32_t number) {
  Peer& peer = grown_to(peers_, number);
  if (!peer.known) {
    peer.known = true;
    peer.rate = index_of(setting_, *setting_.first);
  }
  return peer;
}

const Mode& AarfRate::mode(SimTime /*now*/, std::uint32_t peer_number, std::uint32_t /*attempt*/) {
  return *setting_.modes[peer(peer_number).rate];
}

void AarfRate::report(SimTime /*now*/, std::uint32_t peer_number, const Mode& /*mode*/,
                      bool acknowledged) {
  Peer& p = peer(peer_number);
  ++p.attempts;
  if (!acknowledged) {
    p.successes = 0;
    ++p.failures;
    if (p.just_raised) {
      p.successes_needed = std::min(2 * p.successes_needed, kMostSuccesses);
      p.attempts_needed = std::min(2 * p.attempts_needed, kMostAttempts);
      lower(p);
    } else if (p.failures == 2) {
      p.successes_needed = kLeastSuccesses;
      p.attempts_needed = kLeastAttempts;
      lower(p);
    }
    return;
  }
  p.just_raised = false;
  p.failures = 0;
  ++p.successes;
  const bool earned = p.successes >= p.successes_needed || p.attempts >= p.attempts_needed;
  if (earned && p.rate + 1 < setting_.modes.size()) {
    ++p.rate;
    p.successes = 0;
    p.attempts = 0;
    p.just_raised = true;
  }
}

void AarfRate::lower(Peer& peer) {
  peer.rate -= peer.rate > 0 ? 1 : 0;
  peer.failures = 0;
  peer.attempts = 0;
  peer.just_raised = false;
}

}  // namespace cuscus::netsim
