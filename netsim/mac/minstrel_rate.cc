#include "netsim/mac/minstrel_rate.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace cuscus::netsim {
namespace {

/// A rate of this probability or less counts for nothing.
constexpr double kHopeless = 0.1;

}  // namespace

MinstrelRate::MinstrelRate(RateSetting setting) : setting_{std::move(setting)} {
  constexpr std::uint32_t kFrameBytes = 1'200;
  for (const Mode* mode : setting_.modes) {
    airtimes_s_.push_back(to_seconds(airtime(*mode, kFrameBytes)));
  }
}

MinstrelRate::Peer& MinstrelRate::peer(SimTime now, std::uint32_t number) {
  Peer& peer = grown_to(peers_, number);
  if (peer.rates.empty()) {
    peer.rates.resize(setting_.modes.size());
    peer.updated = now;
    peer.best = index_of(setting_, *setting_.first);
    peer.second = peer.best;
    peer.reliable = peer.best;
  }
  return peer;
}

void MinstrelRate::update(SimTime now, Peer& peer) {
  constexpr auto kPeriod = std::chrono::milliseconds{100};
  constexpr double kWeight = 0.25;
  if (now - peer.updated < kPeriod) {
    return;
  }
  peer.updated = now;
  for (Rate& rate : peer.rates) {
    if (rate.attempts > 0) {
      const double share = static_cast<double>(rate.successes) / rate.attempts;
      rate.probability = rate.tried ? (1.0 - kWeight) * rate.probability + kWeight * share : share;
      rate.tried = true;
      rate.attempts = 0;
      rate.successes = 0;
    }
  }
  // From the lowest upwards, so that equals are decided for the lower.
  std::size_t best = 0;
  std::size_t second = 0;
  std::size_t reliable = 0;
  for (std::size_t rate = 1; rate < peer.rates.size(); ++rate) {
    if (throughput(peer, rate) > throughput(peer, best)) {
      second = best;
      best = rate;
    } else if (second == best || throughput(peer, rate) > throughput(peer, second)) {
      second = rate;
    }
    if (peer.rates[rate].probability > peer.rates[reliable].probability) {
      reliable = rate;
    }
  }
  peer.best = best;
  peer.second = second;
  peer.reliable = reliable;
}

double MinstrelRate::throughput(const Peer& peer, std::size_t rate) const {
  const double probability = peer.rates[rate].probability;
  return probability < kHopeless ? 0.0 : probability / airtimes_s_[rate];
}

std::size_t MinstrelRate::tries(const Peer& peer, std::size_t rate) const {
  constexpr double kSegment_s = 6e-3;
  constexpr double kCertain = 0.95;
  const double probability = peer.rates[rate].probability;
  const auto fitting = static_cast<std::size_t>(kSegment_s / airtimes_s_[rate]);
  const bool settled = probability > kCertain || probability < kHopeless;
  // Best, second and most reliable; the lowest rate has the last attempt.
  const std::size_t share = (setting_.attempts - 1) / 3;
  const std::size_t most = settled ? std::min<std::size_t>(share, 2) : share;
  return std::max<std::size_t>(1, std::min(fitting, most));
}

void MinstrelRate::plan_frame(Peer& peer) {
  constexpr std::uint64_t kFramesPerSample = 10;
  peer.chain.clear();
  const auto add = [&](std::size_t rate, std::size_t count) {
    peer.chain.insert(peer.chain.end(), count, rate);
  };
  ++peer.frames;
  if (peer.samples * kFramesPerSample < peer.frames && peer.rates.size() > 1) {
    ++peer.samples;
    const std::size_t sample =
        setting_.draws.below(draw_++, static_cast<std::uint32_t>(peer.rates.size()));
    if (airtimes_s_[sample] < airtimes_s_[peer.best]) {
      add(sample, 1);
      add(peer.best, tries(peer, peer.best));
    } else {
      add(peer.best, tries(peer, peer.best));
      add(sample, 1);
    }
  } else {
    add(peer.best, tries(peer, peer.best));
    add(peer.second, tries(peer, peer.second));
  }
  add(peer.reliable, tries(peer, peer.reliable));
  add(0, 1);
}

const Mode& MinstrelRate::mode(SimTime now, std::uint32_t peer_number, std::uint32_t attempt) {
  Peer& p = peer(now, peer_number);
  if (attempt == 0 || p.chain.empty()) {
    update(now, p);
    plan_frame(p);
  }
  return *setting_.modes[p.chain[std::min<std::size_t>(attempt, p.chain.size() - 1)]];
}

void MinstrelRate::report(SimTime now, std::uint32_t peer_number, const Mode& mode,
                          bool acknowledged) {
  Rate& rate = peer(now, peer_number).rates[index_of(setting_, mode)];
  ++rate.attempts;
  rate.successes += acknowledged ? 1 : 0;
}

}  // namespace cuscus::netsim
