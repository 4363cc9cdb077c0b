#include <algorithm>
#include <array>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

// IEEE Std 802.11-2016: clause 17 (OFDM in 20 and 10 MHz), 15 and 16 (DSSS, CCK), 18 (all).
constexpr std::array<std::uint32_t, 8> kOfdm_kbps{6000,  9000,  12000, 18000,
                                                  24000, 36000, 48000, 54000};
constexpr std::array<std::uint32_t, 8> kHalfClockedOfdm_kbps{3000,  4500,  6000,  9000,
                                                             12000, 18000, 24000, 27000};
constexpr std::array<std::uint32_t, 4> kDsss_kbps{1000, 2000, 5500, 11000};
constexpr std::array<std::uint32_t, 12> kErp_kbps{1000,  2000,  5500,  6000,  9000,  11000,
                                                  12000, 18000, 24000, 36000, 48000, 54000};

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
  for (std::size_t i = 0; i < value->size() && i < 2 * kErp_kbps.size(); ++i) {
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

std::optional<PreambleDetection> read_detection(const json* value, const std::string& path,
                                                Problems& problems) {
  if (is_none(value, path, "minimum_power and minimum_sinr", problems)) {
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

std::optional<Capture> read_capture(const json* value, const std::string& path,
                                    Problems& problems) {
  if (value == nullptr || is_none(value, path, "preamble and frame", problems)) {
    return std::nullopt;
  }
  Capture capture;
  ObjectReader reader{value, path, problems};
  const QuantityRange range{kPowerRatio, "0 dB", "60 dB"};
  capture.preamble.value = reader.quantity("preamble", capture.preamble.value, range);
  const json* frame = reader.child("frame");
  if (frame != nullptr && *frame != "none") {
    capture.frame = Decibel{read_quantity(*frame, reader.path_of("frame"), 10.0, range, problems)};
  }
  reader.finish();
  return capture;
}

std::optional<std::uint32_t> read_rts_threshold(ObjectReader& reader) {
  const std::string key = "rts_threshold";
  const json* value = reader.child(key);
  if (value == nullptr || *value == "none") {
    return std::nullopt;
  }
  if (value->is_string()) {
    reader.problem(key, shown(*value) + "; allowed: none, or a whole number of bytes 0 ... 65535");
    return std::nullopt;
  }
  return reader.integer<std::uint32_t>(key, 0, {0, 65'535});
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
    case RadioStandard::k80211a:
      return kOfdm_kbps;
    case RadioStandard::k80211b:
      return kDsss_kbps;
    case RadioStandard::k80211g:
      return kErp_kbps;
    case RadioStandard::k80211p:
      return kHalfClockedOfdm_kbps;
  }
  return {};
}

Radio default_radio(RadioStandard standard) {
  Radio radio;
  radio.standard = standard;
  switch (standard) {
    case RadioStandard::k80211a:
      radio.channel_frequency_hz = 5.18e9;  // channel 36
      radio.slot = std::chrono::microseconds{9};
      break;
    case RadioStandard::k80211b:
      radio.data_rate_kbps = 1000;
      radio.group_rate_kbps = 1000;
      radio.basic_rates_kbps = {1000, 2000};
      break;
    case RadioStandard::k80211g:
      break;
    case RadioStandard::k80211p:
      radio.basic_rates_kbps = {3000, 6000, 12000};
      radio.channel_frequency_hz = 5.89e9;  // channel 178
      radio.slot = std::chrono::microseconds{13};
      break;
  }
  return radio;
}

Radio read_radio(const json* value, const std::filesystem::path& folder, Problems& problems) {
  ObjectReader reader{value, "/radio", problems};
  Radio radio =
      default_radio(reader.choice("standard", RadioStandard::k80211g, kRadioStandardNames));
  radio.data_rate_kbps = read_rate(reader, "data_rate", radio.data_rate_kbps, radio.standard);
  radio.group_rate_kbps = read_rate(reader, "group_rate", radio.group_rate_kbps, radio.standard);
  radio.rate_control = reader.choice("rate_control", radio.rate_control, kRateControlNames);
  radio.basic_rates_kbps = read_basic_rates(reader, radio.basic_rates_kbps, radio.standard);
  radio.control_answer = reader.choice("control_answer", radio.control_answer, kControlAnswerNames);
  radio.dsss_preamble = reader.choice("preamble", radio.dsss_preamble, kDsssPreambleNames);
  if (radio.dsss_preamble == DsssPreamble::kShort && rates_kbps(radio.standard).front() != 1000) {
    reader.problem("preamble", "\"short\" is of DSSS and CCK rates, which " +
                                   std::string{name_of(kRadioStandardNames, radio.standard)} +
                                   " does not have; allowed: long");
  }
  radio.channel_frequency_hz = reader.quantity("channel_frequency", radio.channel_frequency_hz,
                                               {kFrequency, "100 MHz", "10 GHz"});
  radio.tx_power.value =
      reader.quantity("tx_power", radio.tx_power.value, {kPower, "-50 dBm", "50 dBm"});
  radio.antenna_gain.value =
      reader.quantity("antenna_gain", radio.antenna_gain.value, {kPowerRatio, "-30 dB", "40 dB"});
  radio.antenna =
      read_antenna(reader.child("antenna"), reader.path_of("antenna"), folder, problems);
  radio.noise_figure.value =
      reader.quantity("noise_figure", radio.noise_figure.value, {kPowerRatio, "0 dB", "30 dB"});
  radio.slot = reader.duration("slot", radio.slot, "9 us", "1 ms");
  radio.retry_limit = reader.integer<std::uint32_t>("retry_limit", radio.retry_limit, {1, 255});
  radio.long_retry_limit =
      reader.integer<std::uint32_t>("long_retry_limit", radio.long_retry_limit, {1, 255});
  radio.rts_threshold_bytes = read_rts_threshold(reader);
  radio.mac = read_mac(reader.child("mac"), reader.path_of("mac"), radio.standard, problems);
  read_queue(reader.child("queue"), reader.path_of("queue"), radio, problems);
  radio.error_model = reader.choice("error_model", radio.error_model, kErrorModelNames);
  read_cca(reader.child("cca"), reader.path_of("cca"), radio, problems);
  radio.preamble_detection = read_detection(reader.child("preamble_detection"),
                                            reader.path_of("preamble_detection"), problems);
  radio.capture = read_capture(reader.child("capture"), reader.path_of("capture"), problems);
  radio.propagation =
      read_propagation(reader.child("propagation"), reader.path_of("propagation"), problems);
  radio.shadowing =
      read_shadowing(reader.child("shadowing"), reader.path_of("shadowing"), problems);
  radio.fading = read_fading(reader.child("fading"), reader.path_of("fading"), problems);
  radio.disruption =
      read_disruption(reader.child("disruption"), reader.path_of("disruption"), problems);
  radio.walls = reader.choice("walls", radio.walls, kWallModelNames);
  radio.obstacles =
      read_obstacles(reader.child("obstacles"), reader.path_of("obstacles"), problems);
  radio.jammers = read_jammers(reader.child("jammers"), reader.path_of("jammers"), problems);
  reader.finish();
  return radio;
}

}  // namespace cuscus::scenario
