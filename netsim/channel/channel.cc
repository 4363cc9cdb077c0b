#include "netsim/channel/channel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "common/random/counter_stream.h"
#include "common/units/constants.h"
#include "netsim/channel/aerial_loss.h"
#include "netsim/channel/all_obstacles.h"
#include "netsim/channel/street_canyon.h"
#include "netsim/channel/wall_loss.h"

namespace cuscus::netsim {
namespace {

/// Purpose number of the streams of Ψ (see random::stream_id).
constexpr std::uint16_t kFrameVariationStream = 0x1001;

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
  require(p.outer_wall.value >= 0.0 && std::isfinite(p.outer_wall.value) &&
              p.inner_wall.value >= 0.0 && std::isfinite(p.inner_wall.value),
          p.model, "walls must lose at least 0 dB");
  return std::make_unique<PaperEquation1>(p.alpha);
}

std::unique_ptr<const PathLossModel> make_two_ray(const ChannelParameters& p) {
  return std::make_unique<TwoRay>(TwoRay::Parameters{
      .ground = p.ground, .polarisation = p.polarisation, .roughness_m = p.roughness_m});
}

std::unique_ptr<const PathLossModel> make_street_canyon(const ChannelParameters& p) {
  return std::make_unique<StreetCanyon>(p.canyon_bound);
}

std::unique_ptr<const PathLossModel> make_aerial(std::unique_ptr<const AerialModel> model,
                                                 const ChannelParameters& p) {
  if (p.line_of_sight == "mean") {
    return std::make_unique<AerialLoss>(std::move(model), std::nullopt);
  }
  require(p.line_of_sight == "drawn", p.model, "line of sight must be 'drawn' or 'mean'");
  require(p.line_of_sight_decorrelation_m > 0.0 && std::isfinite(p.line_of_sight_decorrelation_m),
          p.model, "the decorrelation distance must be above 0 m");
  return std::make_unique<AerialLoss>(
      std::move(model),
      AerialLoss::Draw{.decorrelation_m = p.line_of_sight_decorrelation_m, .seed = p.seed});
}

std::unique_ptr<const PathLossModel> make_al_hourani(const ChannelParameters& p) {
  return make_aerial(std::make_unique<AlHourani>(p.environment), p);
}

std::unique_ptr<const PathLossModel> make_tr36777(const ChannelParameters& p) {
  return make_aerial(std::make_unique<Tr36777>(p.area), p);
}

std::unique_ptr<const PathLossModel> make_fixed(const ChannelParameters& p) {
  require(p.reference_loss.value >= 0.0, p.model, "the loss must be at least 0 dB");
  return std::make_unique<FixedLoss>(p.reference_loss);
}

/// Every model by name: a new one is a class, a function above and a row here.
constexpr std::array<PathLossMaker, 8> kModels{{{"friis", make_friis},
                                                {"log-distance", make_log_distance},
                                                {"two-ray", make_two_ray},
                                                {"paper-eq1", make_paper_equation_1},
                                                {"p1411", make_street_canyon},
                                                {"al-hourani", make_al_hourani},
                                                {"tr36777", make_tr36777},
                                                {"fixed", make_fixed}}};

std::unique_ptr<const PathLossModel> make_path_loss(const ChannelParameters& parameters) {
  return find_maker<PathLossMaker>("propagation model", parameters.model, kModels,
                                   parameters.more_models)
      .make(parameters);
}

void require_term(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{rule};
  }
}

std::shared_ptr<const Obstacles> make_obstacles(const ChannelParameters& p) {
  if (p.obstacles.empty()) {
    return p.city;
  }
  auto boxes = std::make_shared<BoxObstacles>(p.obstacles);
  if (!p.city) {
    return boxes;
  }
  return std::make_shared<AllObstacles>(
      std::vector<std::shared_ptr<const Obstacles>>{std::move(boxes), p.city});
}

std::unique_ptr<const Shadowing> make_shadowing(const ChannelParameters& p) {
  require_term(p.shadowing_db >= 0.0 && std::isfinite(p.shadowing_db),
               "shadowing: the standard deviation must be at least 0 dB");
  if (p.shadowing_db == 0.0) {
    return nullptr;
  }
  require_term(p.shadowing_decorrelation_m > 0.0 && std::isfinite(p.shadowing_decorrelation_m),
               "shadowing: the decorrelation distance must be above 0 m");
  return std::make_unique<Shadowing>(
      Shadowing::Parameters{.deviation_db = p.shadowing_db,
                            .decorrelation_m = p.shadowing_decorrelation_m,
                            .seed = p.seed});
}

std::unique_ptr<const FadingModel> make_fading(const ChannelParameters& p) {
  if (p.fading == "none") {
    return nullptr;
  }
  if (p.fading == "rice") {
    require_term(!std::isnan(p.k_factor.value) && !std::isnan(p.k_factor_overhead.value) &&
                     p.k_factor.value <= 100.0 && p.k_factor_overhead.value <= 100.0,
                 "fading: K factors must be at most 100 dB");
    require_term(p.residual_doppler_hz >= 0.0 && std::isfinite(p.residual_doppler_hz),
                 "fading: the residual Doppler must be at least 0 Hz");
    return std::make_unique<RiceFading>(
        RiceFading::Parameters{.k_at_horizon = p.k_factor,
                               .k_at_zenith = p.k_factor_overhead,
                               .residual_doppler_hz = p.residual_doppler_hz,
                               .carrier_hz = p.carrier_hz,
                               .seed = p.seed});
  }
  if (p.fading == "nakagami") {
    require_term(p.nakagami_m >= 0.5 && std::isfinite(p.nakagami_m),
                 "fading: m must be at least 0.5");
    return std::make_unique<NakagamiFading>(p.seed, p.nakagami_m);
  }
  throw std::invalid_argument{"fading model '" + p.fading +
                              "' is not known; allowed are 'none', 'rice', 'nakagami'"};
}

}  // namespace

FrameVariation::FrameVariation(std::uint64_t seed, double variance_db2)
    : seed_{seed}, deviation_db_{std::sqrt(variance_db2)} {}

Decibel FrameVariation::loss(const FrameOnLink& frame) const {
  const auto [stream, index] = FrameDraw::of(seed_, kFrameVariationStream, frame);
  return {deviation_db_ * stream.normal(index)};
}

Channel::Channel(const ChannelParameters& parameters)
    : Channel{parameters, make_obstacles(parameters)} {}

Channel::Channel(const ChannelParameters& parameters, std::shared_ptr<const Obstacles> obstacles)
    : carrier_hz_{parameters.carrier_hz},
      counts_walls_{parameters.model == "paper-eq1"},
      outer_wall_{parameters.outer_wall},
      inner_wall_{parameters.inner_wall},
      path_loss_{make_path_loss(parameters)},
      obstacles_{std::move(obstacles)},
      shadowing_{make_shadowing(parameters)},
      fading_{make_fading(parameters)} {
  if (!(carrier_hz_ > 0.0) || !std::isfinite(carrier_hz_)) {
    throw std::invalid_argument{"carrier frequency must be above 0 Hz"};
  }
  if (obstacles_ && (parameters.model == "al-hourani" || parameters.model == "tr36777")) {
    throw std::invalid_argument{"propagation model '" + parameters.model +
                                "' stands in for a map and cannot be used with obstacles; allowed "
                                "are models without line of sight by chance, or no obstacles"};
  }
  if (parameters.model == "paper-eq1" && parameters.chi_db2 > 0.0) {
    variation_ = std::make_unique<FrameVariation>(parameters.seed, parameters.chi_db2);
  }
}

std::vector<std::string> Channel::model_names() {
  std::vector<std::string> names;
  names.reserve(kModels.size());
  for (const PathLossMaker& entry : kModels) {
    names.emplace_back(entry.name);
  }
  return names;
}

StaticTerms Channel::static_terms(const Link& link) const { return terms_of(link, nullptr); }

StaticTerms Channel::static_terms(const Link& link, const Nearby& nearby) const {
  return terms_of(link, &nearby);
}

void Channel::look_around(const Link& link, double slack_m, Nearby& nearby) const {
  obstacles_->look_around(link.p_WL, link.p_WH, clear_zone_m(kSpeedOfLight_mps / carrier_hz_),
                          slack_m, nearby);
}

StaticTerms Channel::terms_of(const Link& link, const Nearby* nearby) const {
  StaticTerms terms;
  terms.basic = path_loss_->loss({.p_WT = link.p_WL, .p_WR = link.p_WH, .carrier_hz = carrier_hz_});
  if (obstacles_) {
    terms.obstacles = obstacle_terms_of(link, nearby);
  }
  if (shadowing_) {
    terms.shadowing = shadowing_->loss(link);
  }
  return terms;
}

ObstacleTerms Channel::obstacle_terms_of(const Link& link, const Nearby* nearby) const {
  // By their coordinates, so that the bits do not depend on how the nodes are numbered either.
  const Eigen::Vector3d* a = &link.p_WL;
  const Eigen::Vector3d* b = &link.p_WH;
  if (std::lexicographical_compare(b->begin(), b->end(), a->begin(), a->end())) {
    std::swap(a, b);
  }
  const double wavelength_m = kSpeedOfLight_mps / carrier_hz_;
  const double zone_m = clear_zone_m(wavelength_m);
  std::vector<Obstruction> found;
  if (nearby != nullptr) {
    obstacles_->find(*nearby, *a, *b, zone_m, found);
  } else {
    obstacles_->find(*a, *b, zone_m, found);
  }
  ObstacleTerms terms;
  if (!counts_walls_) {
    terms = obstacle_terms(found, *a, *b, wavelength_m);
    const double foliage_m =
        nearby != nullptr ? obstacles_->foliage_m(*nearby, *a, *b) : obstacles_->foliage_m(*a, *b);
    if (foliage_m > 0.0) {
      terms.foliage = foliage_loss(foliage_m, carrier_hz_);
    }
    return terms;
  }
  for (const Obstruction& body : found) {
    terms.walls.outer += body.walls.outer;
    terms.walls.inner += body.walls.inner;
  }
  terms.outer_walls = {terms.walls.outer * outer_wall_.value};
  terms.inner_walls = {terms.walls.inner * inner_wall_.value};
  return terms;
}

Decibel Channel::greatest_frame_gain() const {
  if (variation_) {
    return {std::numeric_limits<double>::infinity()};
  }
  return fading_ ? fading_->greatest_gain() : Decibel{0.0};
}

FrameTerms Channel::frame_terms(const FrameOnLink& frame) const {
  FrameTerms terms;
  if (variation_) {
    terms.variation = variation_->loss(frame);
  }
  if (fading_) {
    terms.fading = fading_->loss(frame);
  }
  return terms;
}

}  // namespace cuscus::netsim
