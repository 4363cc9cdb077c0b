#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "netsim/channel/gaussian_field.h"
#include "netsim/channel/path_loss.h"

namespace cuscus::netsim {

/// Losses with and without line of sight, and how likely it is: a stand-in for a map, never to be
/// used together with one.
class AerialModel {
 public:
  virtual ~AerialModel() = default;

  [[nodiscard]] virtual double line_of_sight_probability(const LinkGeometry& link) const = 0;
  [[nodiscard]] virtual Decibel loss(const LinkGeometry& link, bool line_of_sight) const = 0;
};

/// Air to ground over a built-up area, by elevation,
///
///   P_LoS = 1 / (1 + a e^(-b (θ - a))),   L = free space + η_LoS or η_NLoS  dB,
///
/// θ the elevation of the higher antenna seen from the lower one [degrees]; a, b and η by
/// environment: "suburban", "urban", "dense-urban", "high-rise".
///
/// Sources: A. Al-Hourani, S. Kandeepan, S. Lardner, "Optimal LAP altitude for maximum coverage",
/// IEEE Wireless Commun. Lett. 3(6), 2014 (the sigmoid); A. Al-Hourani, S. Kandeepan, A.
/// Jamalipour, "Modeling air-to-ground path loss for low altitude platforms in urban environments",
/// GLOBECOM 2014 (η at 2 GHz). Meant for platforms far above the roofs.
class AlHourani final : public AerialModel {
 public:
  /// @throws std::invalid_argument naming the environments that exist.
  explicit AlHourani(std::string_view environment);

  [[nodiscard]] static std::vector<std::string> environment_names();

  [[nodiscard]] double line_of_sight_probability(const LinkGeometry& link) const override;
  [[nodiscard]] Decibel loss(const LinkGeometry& link, bool line_of_sight) const override;

 private:
  struct Environment;
  const Environment* environment_;
};

/// 3GPP's channel between a base station and an aerial vehicle at height h, "RMa-AV", "UMa-AV" or
/// "UMi-AV" (rural macro, urban macro, urban micro):
///
///   P_LoS = 1 up to d₁, then d₁/d + e^(-d/p₁) (1 - d₁/d),  d the horizontal distance [m],
///   d₁ and p₁ functions of h, L of h, distance and frequency: see the source.
///
/// Source: 3GPP TR 36.777 V15.0.0, annex B, tables B-1 and B-2. The higher antenna is taken as the
/// aerial one, the other as the base station, also between two UAVs. h is taken as at least 10 m
/// (RMa-AV) or 22.5 m (the urban ones) and at most 300 m, where the tables end, distances as at
/// least 1 m. The tables' own shadowing (LoS σ 4.2 e^(-0.0046 h), 4.64 e^(-0.0066 h), max(5
/// e^(-0.01 h), 2); NLoS 6, 6, 8 dB) is not part of this term.
class Tr36777 final : public AerialModel {
 public:
  enum class Area : std::uint8_t { kRuralMacro, kUrbanMacro, kUrbanMicro };

  /// @throws std::invalid_argument naming the scenarios that exist.
  explicit Tr36777(std::string_view area);

  [[nodiscard]] static std::vector<std::string> area_names();

  [[nodiscard]] double line_of_sight_probability(const LinkGeometry& link) const override;
  [[nodiscard]] Decibel loss(const LinkGeometry& link, bool line_of_sight) const override;

 private:
  [[nodiscard]] double height_m(const LinkGeometry& link) const;

  Area area_;
};

/// What an AerialModel makes of one link: either its mean,
///
///   L = P_LoS L_LoS + (1 - P_LoS) L_NLoS  dB,
///
/// or line of sight where Φ(G(r_L, r_H)) < P_LoS, with G a GaussianField and Φ the normal
/// distribution: seen or not as a whole, for as long as the ends stay near where they are.
class AerialLoss final : public PathLossModel {
 public:
  struct Draw {
    double decorrelation_m{50.0};
    std::uint64_t seed{1};
  };

  /// Without `draw`: the mean.
  AerialLoss(std::unique_ptr<const AerialModel> model, const std::optional<Draw>& draw);

  [[nodiscard]] Decibel loss(const LinkGeometry& link) const override;

 private:
  std::unique_ptr<const AerialModel> model_;
  std::optional<GaussianField> visibility_;
};

}  // namespace cuscus::netsim
