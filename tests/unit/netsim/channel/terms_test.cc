// What every term of the channel has to be: reciprocal, finite, repeatable.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "netsim/channel/channel.h"

namespace cuscus::netsim {
namespace {

ChannelParameters full_channel(const std::string& fading) {
  return {.model = "log-distance",
          .exponent = 2.7,
          .shadowing_db = 4.0,
          .shadowing_decorrelation_m = 12.0,
          .fading = fading,
          .k_factor = {5.0},
          .k_factor_overhead = {15.0},
          .nakagami_m = 1.5,
          .seed = 11};
}

FrameOnLink over(const Link& link) {
  return {.link = link, .from_low = true, .transmission = 3, .time = sim_time(1'234'567'890)};
}

TEST_CASE("every term is the same in both directions") {
  const auto* const fading = GENERATE("none", "rice", "nakagami");
  const Channel channel{full_channel(fading)};
  const Eigen::Vector3d p_WA{10.0, -20.0, 5.0};
  const Eigen::Vector3d p_WB{-150.0, 90.0, 40.0};

  const Link there = Link::between(4, p_WA, 7, p_WB);
  const Link back = Link::between(7, p_WB, 4, p_WA);

  CHECK(channel.static_loss(there) == channel.static_loss(back));
  CHECK(channel.frame_loss(over(there)) == channel.frame_loss(over(back)));
}

TEST_CASE("every loss is a number, also where two nodes are at one place") {
  const auto* const fading = GENERATE("none", "rice", "nakagami");
  const auto* const model = GENERATE("friis", "log-distance", "two-ray", "paper-eq1", "p1411",
                                     "al-hourani", "tr36777", "fixed");
  ChannelParameters parameters = full_channel(fading);
  parameters.model = model;
  parameters.chi_db2 = 9.0;
  const Channel channel{parameters};
  for (const double distance_m : {0.0, 1e-9, 0.01, 1.0, 1e3, 1e7}) {
    const Link link =
        Link::between(0, {1.0, 2.0, 3.0}, 1, Eigen::Vector3d{1.0, 2.0, 3.0 + distance_m});
    CAPTURE(fading, model, distance_m);
    CHECK(std::isfinite(channel.static_loss(link).value));
    CHECK(std::isfinite(channel.frame_loss(over(link)).value));
  }
}

TEST_CASE("a millimetre changes a link by little, a wavelength by much") {
  const RiceFading fading{{.k_at_horizon = {0.0}, .k_at_zenith = {0.0}, .seed = 5}};
  const auto loss_db = [&](double x_m) {
    return fading.loss(over(Link::between(0, {0.0, 0.0, 10.0}, 1, {100.0 + x_m, 0.0, 10.0}))).value;
  };
  double most_db = 0.0;
  for (double x_m = 0.0; x_m < 0.5; x_m += 0.001) {
    // Within fades the level falls by decades; above -10 dB it moves slowly.
    if (loss_db(x_m) < 10.0) {
      CHECK(std::abs(loss_db(x_m + 0.001) - loss_db(x_m)) < 2.0);
    }
    most_db = std::max(most_db, std::abs(loss_db(x_m) - loss_db(0.0)));
  }
  CHECK(most_db > 3.0);
}

TEST_CASE("no frame gains more than a channel says") {
  ChannelParameters parameters = full_channel("rice");
  const Channel rice{parameters};
  CHECK(rice.greatest_frame_gain().value == Approx(12.3).margin(0.01));  // 17
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const Link link = Link::between(0, {0.0, 0.0, 10.0}, 1, {50.0 + 0.013 * i, 0.0, 10.0});
    REQUIRE(-rice.frame_loss(over(link)) <= rice.greatest_frame_gain());
  }
  CHECK(Channel{full_channel("none")}.greatest_frame_gain() == Decibel{0.0});
  CHECK(std::isinf(Channel{full_channel("nakagami")}.greatest_frame_gain().value));
  parameters.model = "paper-eq1";
  parameters.chi_db2 = 1.0;
  CHECK(std::isinf(Channel{parameters}.greatest_frame_gain().value));
}

TEST_CASE("the direct wave is stronger overhead") {
  const RiceFading fading{{.k_at_horizon = {5.0}, .k_at_zenith = {15.0}}};
  constexpr double kUp_rad = 1.5707963267948966;

  CHECK(Decibel::from_ratio(fading.k_factor(0.0)).value == Approx(5.0));
  CHECK(Decibel::from_ratio(fading.k_factor(kUp_rad / 2.0)).value == Approx(10.0));
  CHECK(Decibel::from_ratio(fading.k_factor(kUp_rad)).value == Approx(15.0));
  const double none = -std::numeric_limits<double>::infinity();
  CHECK(RiceFading{{.k_at_horizon = {none}, .k_at_zenith = {none}}}.k_factor(1.0) == 0.0);
}

TEST_CASE("two nodes that stand still see a channel that moves with the residual Doppler only") {
  const auto loss_at = [](double doppler_hz, std::int64_t time_ns) {
    const RiceFading fading{
        {.k_at_horizon = {0.0}, .k_at_zenith = {0.0}, .residual_doppler_hz = doppler_hz}};
    FrameOnLink frame = over(Link::between(0, {0.0, 0.0, 10.0}, 1, {50.0, 0.0, 10.0}));
    frame.time = sim_time(time_ns);
    return fading.loss(frame).value;
  };

  CHECK(loss_at(0.0, 0) == loss_at(0.0, 60'000'000'000));
  CHECK(loss_at(2.0, 0) == Approx(loss_at(2.0, 1'000'000)).margin(0.5));
  CHECK(std::abs(loss_at(2.0, 0) - loss_at(2.0, 700'000'000)) > 0.1);
}

}  // namespace
}  // namespace cuscus::netsim
