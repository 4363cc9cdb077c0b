#include "netsim/channel/channel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "common/random/counter_stream.h"

namespace cuscus::netsim {
namespace {

/// Purpose number of the streams of Ψ (see random::stream_id).
constexpr std::uint16_t kFrameVariationStream = 0x1001;

using Factory = std::unique_ptr<const PathLossModel> (*)(const ChannelParameters&);

struct Entry {
  std::string_view name;
  Factory make;
};

void require(bool holds, const std::string& model, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"propagation model '" + model + "': " + rule};
  }
}

std::unique_ptr<const PathLossModel> make_friis(const ChannelParameters& /*parameters*/) {
  return std::make_unique<FreeSpace>();
}

std::unique_ptr<const PathLossModel> make_log_distance(const ChannelParameters& p) {
  require(p.exponent > 0.0 && std::isfinite(p.exponent), p.model, "exponent must be above 0");
  require(p.reference_loss.value >= 0.0 && std::isfinite(p.reference_loss.value), p.model,
          "reference loss must be at least 0 dB (0: free space at 1 m)");
  return std::make_unique<LogDistance>(
      LogDistance::Parameters{.exponent = p.exponent, .reference_loss = p.reference_loss});
}

std::unique_ptr<const PathLossModel> make_paper_equation_1(const ChannelParameters& p) {
  require(p.alpha > 0.0 && std::isfinite(p.alpha), p.model, "alpha must be above 0");
  require(p.chi_db2 >= 0.0 && std::isfinite(p.chi_db2), p.model,
          "chi is a variance and must be at least 0 dB^2");
  return std::make_unique<PaperEquation1>(p.alpha);
}

std::unique_ptr<const PathLossModel> make_fixed(const ChannelParameters& p) {
  require(p.reference_loss.value >= 0.0, p.model, "the loss must be at least 0 dB");
  return std::make_unique<FixedLoss>(p.reference_loss);
}

/// Every model by name: a new one is a class, a function above and a row here.
constexpr std::array<Entry, 4> kModels{{{"friis", make_friis},
                                        {"log-distance", make_log_distance},
                                        {"paper-eq1", make_paper_equation_1},
                                        {"fixed", make_fixed}}};

std::unique_ptr<const PathLossModel> make_path_loss(const ChannelParameters& parameters) {
  std::string allowed;
  for (const Entry& entry : kModels) {
    if (entry.name == parameters.model) {
      return entry.make(parameters);
    }
    allowed += (allowed.empty() ? "'" : ", '") + std::string{entry.name} + "'";
  }
  throw std::invalid_argument{"propagation model '" + parameters.model +
                              "' is not known; allowed are " + allowed};
}

}  // namespace

FrameVariation::FrameVariation(std::uint64_t seed, double variance_db2)
    : seed_{seed}, deviation_db_{std::sqrt(variance_db2)} {}

Decibel FrameVariation::loss(const FrameOnLink& frame) const {
  const auto [low, high] = std::minmax(frame.sender, frame.receiver);
  const random::CounterStream stream{
      seed_, random::stream_id(kFrameVariationStream, high, static_cast<std::uint16_t>(low))};
  const std::uint64_t index = 2 * frame.transmission + (frame.sender == low ? 0 : 1);
  return {deviation_db_ * stream.normal(index)};
}

Channel::Channel(const ChannelParameters& parameters)
    : carrier_hz_{parameters.carrier_hz}, path_loss_{make_path_loss(parameters)} {
  if (!(carrier_hz_ > 0.0) || !std::isfinite(carrier_hz_)) {
    throw std::invalid_argument{"carrier frequency must be above 0 Hz"};
  }
  if (parameters.model == "paper-eq1" && parameters.chi_db2 > 0.0) {
    variation_ = std::make_unique<FrameVariation>(parameters.seed, parameters.chi_db2);
  }
}

std::vector<std::string> Channel::model_names() {
  std::vector<std::string> names;
  names.reserve(kModels.size());
  for (const Entry& entry : kModels) {
    names.emplace_back(entry.name);
  }
  return names;
}

Decibel Channel::basic_loss(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p_WR) const {
  return path_loss_->loss({.p_WT = p_WT, .p_WR = p_WR, .carrier_hz = carrier_hz_});
}

Decibel Channel::frame_loss(const FrameOnLink& frame) const {
  return variation_ ? variation_->loss(frame) : Decibel{0.0};
}

}  // namespace cuscus::netsim
