#include <optional>
#include <string>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {

using nlohmann::json;

namespace {

const std::vector<std::string> kModels{"friis", "log-distance", "paper-eq1", "two-ray",
                                       "p1411", "al-hourani",   "tr36777"};

LineOfSight read_line_of_sight(ObjectReader& reader) {
  LineOfSight result;
  result.mean = reader.choice_index("line_of_sight", {"drawn", "mean"}) == 1;
  if (!result.mean) {
    result.decorrelation_m =
        reader.quantity("decorrelation", result.decorrelation_m, {kLength, "0.1 m", "10 km"});
  }
  return result;
}

StreetCanyonPropagation read_street_canyon(ObjectReader& reader) {
  StreetCanyonPropagation model;
  model.bound = reader.choice("bound", model.bound, kCanyonBoundNames);
  reader.finish();
  return model;
}

AlHouraniPropagation read_al_hourani(ObjectReader& reader) {
  AlHouraniPropagation model;
  model.environment = reader.choice("environment", model.environment, kBuiltUpAreaNames);
  model.line_of_sight = read_line_of_sight(reader);
  reader.finish();
  return model;
}

Tr36777Propagation read_tr36777(ObjectReader& reader) {
  Tr36777Propagation model;
  model.area = reader.choice("scenario", model.area, kAerialAreaNames);
  model.line_of_sight = read_line_of_sight(reader);
  reader.finish();
  return model;
}

}  // namespace

Propagation read_propagation(const json* value, const std::string& path, Problems& problems) {
  ObjectReader reader{value, path, problems};
  switch (reader.choice_index("model", kModels)) {
    case 1: {
      LogDistancePropagation model;
      model.exponent = reader.number("exponent", model.exponent, {0.0, 10.0});
      const json* reference = reader.child("reference_loss");
      if (reference != nullptr && *reference != "free-space") {
        model.reference_loss =
            Decibel{read_quantity(*reference, reader.path_of("reference_loss"), 40.0,
                                  {kPowerRatio, "0.01 dB", "200 dB"}, problems)};
      }
      reader.finish();
      return model;
    }
    case 2: {
      PaperPropagation model;
      model.alpha = reader.number("alpha", model.alpha, {0.0, 100.0});
      model.chi_dB2 = reader.quantity("chi", model.chi_dB2, {kVariance, "0 dB2", "1000 dB2"});
      const QuantityRange wall_range{kPowerRatio, "0 dB", "300 dB"};
      model.outer_wall.value = reader.quantity("outer_wall", model.outer_wall.value, wall_range);
      model.inner_wall.value = reader.quantity("inner_wall", model.inner_wall.value, wall_range);
      reader.finish();
      return model;
    }
    case 3: {
      TwoRayPropagation model;
      model.ground = reader.choice("ground", model.ground, kGroundNames);
      model.polarisation = reader.choice("polarisation", model.polarisation, kPolarisationNames);
      model.roughness_m = reader.quantity("roughness", model.roughness_m, {kLength, "0 m", "10 m"});
      reader.finish();
      return model;
    }
    case 4:
      return read_street_canyon(reader);
    case 5:
      return read_al_hourani(reader);
    case 6:
      return read_tr36777(reader);
    default:
      if (reader.has("model") || value == nullptr || !value->is_object()) {
        reader.finish();
      } else {
        reader.missing("model", joined(kModels));
      }
      return FriisPropagation{};
  }
}

std::optional<Shadowing> read_shadowing(const json* value, const std::string& path,
                                        Problems& problems) {
  if (value == nullptr || is_none(value, path, "deviation and decorrelation", problems)) {
    return std::nullopt;
  }
  Shadowing shadowing;
  ObjectReader reader{value, path, problems};
  shadowing.deviation_dB =
      reader.quantity("deviation", shadowing.deviation_dB, {kPowerRatio, "0.01 dB", "30 dB"});
  shadowing.decorrelation_m =
      reader.quantity("decorrelation", shadowing.decorrelation_m, {kLength, "0.1 m", "10 km"});
  reader.finish();
  return shadowing;
}

Fading read_fading(const json* value, const std::string& path, Problems& problems) {
  if (value == nullptr || is_none(value, path, "model", problems)) {
    return NoFading{};
  }
  ObjectReader reader{value, path, problems};
  const QuantityRange k_range{kPowerRatio, "-30 dB", "50 dB"};
  const QuantityRange doppler_range{kFrequency, "0 Hz", "1 kHz"};
  RiceFading rice;
  switch (reader.choice_index("model", {"rice", "rayleigh", "nakagami"})) {
    case 0:
      rice.k_factor = Decibel{reader.quantity("k_factor", rice.k_factor->value, k_range)};
      rice.k_factor_overhead.value =
          reader.quantity("k_factor_overhead", rice.k_factor_overhead.value, k_range);
      rice.residual_doppler_Hz =
          reader.quantity("residual_doppler", rice.residual_doppler_Hz, doppler_range);
      reader.finish();
      return rice;
    case 1:
      rice.k_factor.reset();
      rice.residual_doppler_Hz =
          reader.quantity("residual_doppler", rice.residual_doppler_Hz, doppler_range);
      reader.finish();
      return rice;
    case 2: {
      NakagamiFading nakagami;
      nakagami.m = reader.number("m", nakagami.m, {0.5, 1000.0});
      reader.finish();
      return nakagami;
    }
    default:
      if (!reader.has("model") && value->is_object()) {
        reader.missing("model", "rice, rayleigh, nakagami");
      } else {
        reader.finish();
      }
      return NoFading{};
  }
}

std::optional<Disruption> read_disruption(const json* value, const std::string& path,
                                          Problems& problems) {
  if (value == nullptr || is_none(value, path, "fraction, interval and phase", problems)) {
    return std::nullopt;
  }
  Disruption disruption;
  ObjectReader reader{value, path, problems};
  disruption.fraction = reader.number("fraction", disruption.fraction, {0.0, 1.0});
  disruption.interval = reader.duration("interval", disruption.interval, "10 ms", "1 h");
  const json* phase = reader.child("phase");
  if (phase != nullptr && *phase == "random") {
    disruption.phase.reset();
  } else if (phase != nullptr) {
    disruption.phase = reader.duration("phase", Duration{0}, "0 s", "1 h");
    if (*disruption.phase > disruption.interval) {
      reader.problem("phase", shown(*phase) +
                                  " is beyond the interval; allowed: random, or a time " +
                                  "of at most the interval");
    }
  }
  reader.finish();
  return disruption;
}

}  // namespace cuscus::scenario
