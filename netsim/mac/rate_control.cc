#include "netsim/mac/rate_control.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/units/decibel.h"

namespace cuscus::netsim {
namespace {

std::size_t index_of(const RateSetting& setting, const Mode& mode) {
  const auto found = std::find(setting.modes.begin(), setting.modes.end(), &mode);
  return static_cast<std::size_t>(found - setting.modes.begin());
}

template <typename Peer>
Peer& grown_to(std::vector<Peer>& peers, std::uint32_t number) {
  if (peers.size() <= number) {
    peers.resize(number + std::size_t{1});
  }
  return peers[number];
}

double sinr_required(const ErrorModel& errors, const Mode& mode) {
  constexpr double kBitFailure = 1e-6;
  double low_db = -20.0;
  double high_db = 60.0;
  while (high_db - low_db > 1e-3) {
    const double middle_db = 0.5 * (low_db + high_db);
    const double sinr = Decibel{middle_db}.ratio();
    (errors.bit_failure(mode.modulation, mode.code_rate, sinr) > kBitFailure ? low_db : high_db) =
        middle_db;
  }
  return Decibel{high_db}.ratio();
}

}  // namespace

RateSetting rate_setting(const Standard& standard, const Mode& first, const ErrorModel& errors) {
  RateSetting setting;
  setting.first = &first;
  for (const Mode& mode : standard.modes) {
    if (mode.modulation_class == first.modulation_class) {
      setting.modes.push_back(&mode);
      setting.required_sinr.push_back(sinr_required(errors, mode));
    }
  }
  return setting;
}

const Mode& IdealRate::mode(SimTime /*now*/, std::uint32_t peer, std::uint32_t /*attempt*/) {
  const double sinr = grown_to(sinr_, peer);
  if (sinr == 0.0) {
    return *setting_.first;
  }
  const Mode* best = setting_.modes.front();
  for (std::size_t rate = 0; rate < setting_.modes.size(); ++rate) {
    if (sinr >= setting_.required_sinr[rate]) {
      best = setting_.modes[rate];
    }
  }
  return *best;
}

void IdealRate::heard(std::uint32_t peer, double sinr_ratio) { grown_to(sinr_, peer) = sinr_ratio; }

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
      p.attempts_needed = 2 * p.attempts_needed;
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
  constexpr double kHopeless = 0.1;
  const double probability = peer.rates[rate].probability;
  return probability < kHopeless ? 0.0 : probability / airtimes_s_[rate];
}

std::size_t MinstrelRate::tries(const Peer& peer, std::size_t rate) const {
  constexpr double kSegment_s = 6e-3;
  constexpr double kCertain = 0.95;
  constexpr double kHopeless = 0.1;
  const double probability = peer.rates[rate].probability;
  const auto fitting = static_cast<std::size_t>(kSegment_s / airtimes_s_[rate]);
  const bool settled = probability > kCertain || probability < kHopeless;
  return std::max<std::size_t>(1, settled ? std::min<std::size_t>(fitting, 2) : fitting);
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

std::unique_ptr<RateControl> make_rate_control(std::string_view name, const RateSetting& setting) {
  if (name == "constant") {
    return std::make_unique<ConstantRate>(setting);
  }
  if (name == "ideal") {
    return std::make_unique<IdealRate>(setting);
  }
  if (name == "aarf") {
    return std::make_unique<AarfRate>(setting);
  }
  if (name == "minstrel") {
    return std::make_unique<MinstrelRate>(setting);
  }
  throw std::invalid_argument{
      "rate control '" + std::string{name} +
      "' is not known; allowed are 'constant', 'ideal', 'aarf', 'minstrel'"};
}

}  // namespace cuscus::netsim
