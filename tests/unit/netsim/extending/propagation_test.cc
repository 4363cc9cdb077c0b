#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "netsim/channel/channel.h"

namespace cuscus::netsim {
namespace {

/// Path loss with two slopes: exponent n up to a breakpoint, steeper beyond,
///
///   L = L_0 + 10 n log10(d)                                d <= d_b,
///   L = L_0 + 10 n log10(d_b) + 10 n_far log10(d / d_b)    d > d_b,
///
/// with d in metres and L_0 the loss at 1 m.
class TwoSlopes final : public PathLossModel {
 public:
  TwoSlopes(Decibel loss_at_1_m, double exponent) : near_{loss_at_1_m}, exponent_{exponent} {}

  [[nodiscard]] Decibel loss(const LinkGeometry& link) const override {
    const double distance_m = std::max(1.0, (link.p_WT - link.p_WR).norm());
    const double within_m = std::min(distance_m, kBreakpoint_m);
    return near_ + Decibel{10.0 * exponent_ * std::log10(within_m) +
                           10.0 * kFarExponent * std::log10(distance_m / within_m)};
  }

 private:
  static constexpr double kBreakpoint_m = 100.0;
  static constexpr double kFarExponent = 4.0;

  Decibel near_;
  double exponent_;
};

/// The row that gives the model its name. A maker takes what it needs from the parameters.
constexpr PathLossMaker kTwoSlopes{
    .name = "two-slopes",
    .make = [](const ChannelParameters& p) -> std::unique_ptr<const PathLossModel> {
      return std::make_unique<TwoSlopes>(p.reference_loss, p.exponent);
    }};

TEST_CASE("a propagation model of one's own is chosen by its name") {
  const Channel channel{{.model = "two-slopes",
                         .exponent = 2.0,
                         .reference_loss = {40.0},
                         .more_models = {kTwoSlopes}}};
  const auto loss_at = [&](double distance_m) {
    return channel.static_loss(Link::between(0, {0.0, 0.0, 10.0}, 1, {distance_m, 0.0, 10.0}))
        .value;
  };

  CHECK(loss_at(1.0) == Approx(40.0));
  CHECK(loss_at(10.0) == Approx(60.0));
  CHECK(loss_at(100.0) == Approx(80.0));
  CHECK(loss_at(1'000.0) == Approx(120.0));
}

TEST_CASE("a propagation model that does not exist is refused with those that do") {
  CHECK_THROWS_WITH(Channel({.model = "two-slope", .more_models = {kTwoSlopes}}),
                    Catch::EndsWith("'fixed', 'two-slopes'"));
}

}  // namespace
}  // namespace cuscus::netsim
