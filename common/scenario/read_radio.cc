#include <algorithm>
#include <array>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

// IEEE Std 802.11-2020, clause 18 (ERP-OFDM); netsim has no DSSS rates yet.
constexpr std::array<std::uint32_t, 8> kRates80211g_kbps{6000,  9000,  12000, 18000,
                                                         24000, 36000, 48000, 54000};

std::string rate_list(RadioStandard standard) {
  std::vector<std::string> names;
  for (const std::uint32_t rate : rates_kbps(standard)) {
    names.push_back(json(rate / 1000.0).dump());
  }
  for (std::string& name : names) {
    name = name.ends_with(".0") ? name.substr(0, name.size() - 2) : name;
  }
  return joined(names) + " Mb/s";
}

std::uint32_t read_rate(const json& value, const std::string& path, std::uint32_t fallback,
                        RadioStandard standard, Problems& problems) {
  const double rate =
      read_quantity(value, path, fallback, {kBitRate, "1 kb/s", "10000 Mb/s"}, problems);
  for (const std::uint32_t allowed : rates_kbps(standard)) {
    if (rate == allowed) {
      return allowed;
    }
  }
  problems.add(path, shown(value) + " is not a rate of " + name_of(kRadioStandardNames, standard) +
                         "; allowed: " + rate_list(standard));
  return fallback;
}

std::uint32_t read_rate(ObjectReader& reader, const std::string& key, std::uint32_t fallback,
                        RadioStandard standard) {
  const json* value = reader.child(key);
  return value == nullptr
             ? fallback
             : read_rate(*value, reader.path_of(key), fallback, standard, reader.problems());
}

std::vector<std::uint32_t> read_basic_rates(ObjectReader& reader,
                                            const std::vector<std::uint32_t>& fallback,
                                            RadioStandard standard) {
  const std::string key = "basic_rates";
  const json* value = reader.child(key);
  if (value == nullptr) {
    return fallback;
  }
  if (!value->is_array() || value->empty()) {
    reader.problem(key,
                   shown(*value) + "; allowed: an array of at least one of " + rate_list(standard));
    return fallback;
  }
  std::vector<std::uint32_t> rates;
  for (std::size_t i = 0; i < value->size() && i < 2 * kRates80211g_kbps.size(); ++i) {
    const std::string path = reader.path_of(key) + '/' + std::to_string(i);
    const std::size_t problem_free = rates.size();
    rates.push_back(read_rate(value->at(i), path, 0, standard, reader.problems()));
    const auto last = rates.begin() + static_cast<std::ptrdiff_t>(problem_free);
    if (rates.back() != 0 && std::find(rates.begin(), last, rates.back()) != last) {
      reader.problems().add(path, shown(value->at(i)) + " is given twice; allowed: each rate once");
    }
  }
  std::sort(rates.begin(), rates.end());
  return rates;
}

Propagation read_propagation(const json* value, const std::string& path, Problems& problems) {
  ObjectReader reader{value, path, problems};
  switch (reader.choice_index("model", {"friis", "log-distance", "paper-eq1"})) {
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
      reader.finish();
      return model;
    }
    default:
      if (reader.has("model") || value == nullptr || !value->is_object()) {
        reader.finish();
      } else {
        reader.missing("model", "friis, log-distance, paper-eq1");
      }
      return FriisPropagation{};
  }
}

std::optional<PreambleDetection> read_detection(const json* value, const std::string& path,
                                                Problems& problems) {
  if (value != nullptr && value->is_string()) {
    if (*value != "none") {
      problems.add(path, shown(*value) + " is not known; allowed: none, or an object with " +
                             "minimum_power and minimum_sinr");
    }
    return std::nullopt;
  }
  PreambleDetection detection;
  ObjectReader reader{value, path, problems};
  detection.minimum_power.value = reader.quantity("minimum_power", detection.minimum_power.value,
                                                  {kPower, "-150 dBm", "0 dBm"});
  detection.minimum_sinr.value = reader.quantity("minimum_sinr", detection.minimum_sinr.value,
                                                 {kPowerRatio, "-30 dB", "60 dB"});
  reader.finish();
  return detection;
}

void read_queue(const json* value, const std::string& path, Radio& radio, Problems& problems) {
  ObjectReader reader{value, path, problems};
  radio.queue_frames = reader.integer<std::uint32_t>("frames", radio.queue_frames, {1, 100'000});
  radio.queue_lifetime = reader.duration("lifetime", radio.queue_lifetime, "1 ms", "60 s");
  reader.finish();
}

void read_cca(const json* value, const std::string& path, Radio& radio, Problems& problems) {
  ObjectReader reader{value, path, problems};
  const QuantityRange range{kPower, "-150 dBm", "0 dBm"};
  radio.cca_preamble.value = reader.quantity("preamble", radio.cca_preamble.value, range);
  radio.cca_energy.value = reader.quantity("energy", radio.cca_energy.value, range);
  reader.finish();
}

}  // namespace

std::span<const std::uint32_t> rates_kbps(RadioStandard standard) {
  switch (standard) {
    case RadioStandard::k80211g:
      return kRates80211g_kbps;
  }
  return {};
}

Radio read_radio(const json* value, Problems& problems) {
  Radio radio;
  ObjectReader reader{value, "/radio", problems};
  radio.standard = reader.choice("standard", radio.standard, kRadioStandardNames);
  radio.data_rate_kbps = read_rate(reader, "data_rate", radio.data_rate_kbps, radio.standard);
  radio.group_rate_kbps = read_rate(reader, "group_rate", radio.group_rate_kbps, radio.standard);
  radio.basic_rates_kbps = read_basic_rates(reader, radio.basic_rates_kbps, radio.standard);
  radio.channel_frequency_hz = reader.quantity("channel_frequency", radio.channel_frequency_hz,
                                               {kFrequency, "100 MHz", "10 GHz"});
  radio.tx_power.value =
      reader.quantity("tx_power", radio.tx_power.value, {kPower, "-50 dBm", "50 dBm"});
  radio.antenna_gain.value =
      reader.quantity("antenna_gain", radio.antenna_gain.value, {kPowerRatio, "-30 dB", "40 dB"});
  radio.noise_figure.value =
      reader.quantity("noise_figure", radio.noise_figure.value, {kPowerRatio, "0 dB", "30 dB"});
  radio.slot = reader.duration("slot", radio.slot, "9 us", "1 ms");
  radio.retry_limit = reader.integer<std::uint32_t>("retry_limit", radio.retry_limit, {1, 255});
  read_queue(reader.child("queue"), reader.path_of("queue"), radio, problems);
  radio.error_model = reader.choice("error_model", radio.error_model, kErrorModelNames);
  read_cca(reader.child("cca"), reader.path_of("cca"), radio, problems);
  radio.preamble_detection = read_detection(reader.child("preamble_detection"),
                                            reader.path_of("preamble_detection"), problems);
  radio.propagation =
      read_propagation(reader.child("propagation"), reader.path_of("propagation"), problems);
  reader.finish();
  return radio;
}

}  // namespace cuscus::scenario
