#include "netsim/channel/aerial_loss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace cuscus::netsim {
namespace {

/// Purpose number of the stream of the field (see random::stream_id).
constexpr std::uint16_t kVisibilityStream = 0x1010;

constexpr std::array<std::string_view, 3> kAreas{"RMa-AV", "UMa-AV", "UMi-AV"};

double horizontal_m(const LinkGeometry& link) { return (link.p_WR - link.p_WT).head<2>().norm(); }

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "'" : ", '") + name + "'";
  }
  return text;
}

/// 20 log₁₀ of a constant times the carrier in gigahertz [dB].
double frequency_db(const LinkGeometry& link, double factor = 1.0) {
  return 20.0 * std::log10(factor * link.carrier_hz * 1e-9);
}

constexpr double kRuralFactor = 40.0 * std::numbers::pi / 3.0;

}  // namespace

struct AlHourani::Environment {
  std::string_view name;
  double a;
  double b;
  double line_of_sight_db;
  double obstructed_db;

  static const std::array<Environment, 4> kAll;
};

const std::array<AlHourani::Environment, 4> AlHourani::Environment::kAll{
    {{"suburban", 4.88, 0.43, 0.1, 21.0},
     {"urban", 9.61, 0.16, 1.0, 20.0},
     {"dense-urban", 12.08, 0.11, 1.6, 23.0},
     {"high-rise", 27.23, 0.08, 2.3, 34.0}}};

AlHourani::AlHourani(std::string_view environment)
    : environment_{std::find_if(Environment::kAll.begin(), Environment::kAll.end(),
                                [&](const Environment& e) { return e.name == environment; })} {
  if (environment_ == Environment::kAll.end()) {
    throw std::invalid_argument{"propagation model 'al-hourani': environment '" +
                                std::string{environment} + "' is not known; allowed are " +
                                listed(environment_names())};
  }
}

std::vector<std::string> AlHourani::environment_names() {
  std::vector<std::string> names;
  names.reserve(Environment::kAll.size());
  for (const Environment& environment : Environment::kAll) {
    names.emplace_back(environment.name);
  }
  return names;
}

double AlHourani::line_of_sight_probability(const LinkGeometry& link) const {
  const double rise_m = std::abs(link.p_WR.z() - link.p_WT.z());
  const double elevation_deg = std::atan2(rise_m, horizontal_m(link)) * 180.0 / std::numbers::pi;
  return 1.0 /
         (1.0 + environment_->a * std::exp(-environment_->b * (elevation_deg - environment_->a)));
}

Decibel AlHourani::loss(const LinkGeometry& link, bool line_of_sight) const {
  return FreeSpace{}.loss(link) +
         Decibel{line_of_sight ? environment_->line_of_sight_db : environment_->obstructed_db};
}

Tr36777::Tr36777(std::string_view area) {
  const auto* const found = std::find(kAreas.begin(), kAreas.end(), area);
  if (found == kAreas.end()) {
    throw std::invalid_argument{"propagation model 'tr36777': scenario '" + std::string{area} +
                                "' is not known; allowed are " + listed(area_names())};
  }
  area_ = static_cast<Area>(found - kAreas.begin());
}

std::vector<std::string> Tr36777::area_names() { return {kAreas.begin(), kAreas.end()}; }

double Tr36777::height_m(const LinkGeometry& link) const {
  constexpr double kHighest_m = 300.0;
  const double lowest_m = area_ == Area::kRuralMacro ? 10.0 : 22.5;
  return std::clamp(std::max(link.p_WT.z(), link.p_WR.z()), lowest_m, kHighest_m);
}

double Tr36777::line_of_sight_probability(const LinkGeometry& link) const {
  const double h_m = height_m(link);
  const double decades = std::log10(h_m);
  double p1_m = 0.0;
  double d1_m = 0.0;
  switch (area_) {
    case Area::kRuralMacro:
      if (h_m > 40.0) {
        return 1.0;
      }
      p1_m = std::max(15'021.0 * decades - 16'053.0, 1'000.0);
      d1_m = std::max(1'350.8 * decades - 1'602.0, 18.0);
      break;
    case Area::kUrbanMacro:
      if (h_m > 100.0) {
        return 1.0;
      }
      p1_m = 4'300.0 * decades - 3'800.0;
      d1_m = std::max(460.0 * decades - 700.0, 18.0);
      break;
    case Area::kUrbanMicro:
      p1_m = 233.98 * decades - 0.95;
      d1_m = std::max(294.05 * decades - 432.94, 18.0);
      break;
  }
  const double d_m = horizontal_m(link);
  return d_m <= d1_m ? 1.0 : d1_m / d_m + std::exp(-d_m / p1_m) * (1.0 - d1_m / d_m);
}

Decibel Tr36777::loss(const LinkGeometry& link, bool line_of_sight) const {
  constexpr double kNearest_m = 1.0;
  const double height_decades = std::log10(height_m(link));
  const double decades = std::log10(std::max((link.p_WR - link.p_WT).norm(), kNearest_m));
  double seen_db = 0.0;
  double obstructed_db = 0.0;
  switch (area_) {
    case Area::kRuralMacro:
      seen_db =
          std::max(23.9 - 1.8 * height_decades, 20.0) * decades + frequency_db(link, kRuralFactor);
      obstructed_db = std::max(seen_db, -12.0 + (35.0 - 5.3 * height_decades) * decades +
                                            frequency_db(link, kRuralFactor));
      break;
    case Area::kUrbanMacro:
      seen_db = 28.0 + 22.0 * decades + frequency_db(link);
      obstructed_db =
          -17.5 + (46.0 - 7.0 * height_decades) * decades + frequency_db(link, kRuralFactor);
      break;
    case Area::kUrbanMicro:
      seen_db = std::max(FreeSpace{}.loss(link).value,
                         30.9 + (22.25 - 0.5 * height_decades) * decades + frequency_db(link));
      obstructed_db =
          std::max(seen_db, 32.4 + (43.2 - 7.6 * height_decades) * decades + frequency_db(link));
      break;
  }
  return {std::max(0.0, line_of_sight ? seen_db : obstructed_db)};
}

AerialLoss::AerialLoss(std::unique_ptr<const AerialModel> model, const std::optional<Draw>& draw)
    : model_{std::move(model)} {
  if (draw) {
    visibility_.emplace(GaussianField::Parameters{.purpose = kVisibilityStream,
                                                  .decorrelation_m = draw->decorrelation_m,
                                                  .seed = draw->seed});
  }
}

Decibel AerialLoss::loss(const LinkGeometry& link) const {
  const double probability = model_->line_of_sight_probability(link);
  if (visibility_) {
    const double normal = visibility_->value(link.p_WT, link.p_WR);
    const double uniform = 0.5 * std::erfc(-normal / std::numbers::sqrt2);
    return model_->loss(link, uniform < probability);
  }
  return {probability * model_->loss(link, true).value +
          (1.0 - probability) * model_->loss(link, false).value};
}

}  // namespace cuscus::netsim
