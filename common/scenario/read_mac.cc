#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

constexpr std::size_t kMostSlots = 10'000;
constexpr const char* kFrameAllowed =
    "nodes, or an array of 1 ... 10000 node names, \"-\" where a slot has no owner";

std::vector<std::string> read_frame(ObjectReader& reader) {
  const std::string key = "frame";
  const json* value = reader.child(key);
  if (value == nullptr || *value == "nodes") {
    return {};
  }
  if (!value->is_array() || value->empty() || value->size() > kMostSlots) {
    reader.problem(key, shown(*value) + "; allowed: " + kFrameAllowed);
    return {};
  }
  return reader.texts(key, kMostSlots, 64);
}

TdmaMac read_tdma(ObjectReader& reader) {
  TdmaMac tdma;
  tdma.slot = reader.duration("slot", tdma.slot, "100 us", "1 s");
  tdma.guard = reader.duration("guard", tdma.guard, "0 us", "10 ms");
  tdma.frame = read_frame(reader);
  if (tdma.guard >= tdma.slot) {
    reader.problem("guard", "is no shorter than the slot; allowed: less than " +
                                format_quantity(static_cast<double>(tdma.slot.count()), kTime));
  }
  return tdma;
}

std::uint32_t read_window(ObjectReader& reader, const std::string& key, std::uint32_t fallback) {
  constexpr std::uint32_t kWidest = 32'767;  // 2^15 - 1: the exponent has four bits
  const auto window = reader.integer<std::uint32_t>(key, fallback, {0, kWidest});
  if ((window & (window + 1)) != 0) {
    reader.problem(key, std::to_string(window) +
                            " is no contention window; allowed: 0, 1, 3, 7, 15, ... 32767");
  }
  return window;
}

EdcaCategory read_category(ObjectReader& parent, const std::string& key,
                           const EdcaCategory& fallback) {
  ObjectReader reader{parent.child(key), parent.path_of(key), parent.problems()};
  EdcaCategory category;
  category.aifsn = reader.integer<std::uint32_t>("aifsn", fallback.aifsn, {2, 15});
  category.cw_min = read_window(reader, "cw_min", fallback.cw_min);
  category.cw_max = read_window(reader, "cw_max", fallback.cw_max);
  if (category.cw_min > category.cw_max) {
    reader.problem("cw_min", std::to_string(category.cw_min) + " is above cw_max; allowed: up to " +
                                 std::to_string(category.cw_max));
  }
  reader.finish();
  return category;
}

EdcaMac read_edca(ObjectReader& reader, RadioStandard standard) {
  EdcaMac edca = default_edca(standard);
  edca.background = read_category(reader, "background", edca.background);
  edca.best_effort = read_category(reader, "best_effort", edca.best_effort);
  edca.video = read_category(reader, "video", edca.video);
  edca.voice = read_category(reader, "voice", edca.voice);
  return edca;
}

IdealMac read_ideal(ObjectReader& reader) {
  IdealMac ideal;
  ideal.delay = reader.duration("delay", ideal.delay, "0 s", "10 s");
  ideal.jitter = reader.duration("jitter", ideal.jitter, "0 s", "10 s");
  if (ideal.jitter > ideal.delay) {
    reader.problem("jitter", "is longer than the delay, which varies by it; allowed: up to " +
                                 format_quantity(static_cast<double>(ideal.delay.count()), kTime));
  }
  ideal.loss = reader.number("loss", ideal.loss, {0.0, 1.0});
  const json* range = reader.child("range");
  if (range != nullptr && *range != "none") {
    ideal.range_m = read_quantity(*range, reader.path_of("range"), 1.0,
                                  {kLength, "1 cm", "1000 km"}, reader.problems());
  }
  return ideal;
}

}  // namespace

EdcaMac default_edca(RadioStandard standard) {
  const std::uint32_t low = standard == RadioStandard::k80211b ? 31 : 15;  // aCWmin
  const std::uint32_t half = (low + 1) / 2 - 1;
  const std::uint32_t quarter = (low + 1) / 4 - 1;
  constexpr std::uint32_t kMost = 1023;  // aCWmax
  const bool outside_bss = standard == RadioStandard::k80211p;
  return {.background = {.aifsn = outside_bss ? 9U : 7U, .cw_min = low, .cw_max = kMost},
          .best_effort = {.aifsn = outside_bss ? 6U : 3U, .cw_min = low, .cw_max = kMost},
          .video = {.aifsn = outside_bss ? 3U : 2U, .cw_min = half, .cw_max = low},
          .voice = {.aifsn = 2, .cw_min = quarter, .cw_max = half}};
}

Mac read_mac(const json* value, const std::string& path, RadioStandard standard,
             Problems& problems) {
  ObjectReader reader{value, path, problems};
  Mac mac{DcfMac{}};
  switch (reader.choice_index("model", {"dcf", "edca", "tdma", "ideal"})) {
    case 0:
      reader.finish();
      break;
    case 1:
      mac = read_edca(reader, standard);
      reader.finish();
      break;
    case 2:
      mac = read_tdma(reader);
      reader.finish();
      break;
    case 3:
      mac = read_ideal(reader);
      reader.finish();
      break;
    default:
      if (value != nullptr && value->is_object() && !reader.has("model")) {
        reader.missing("model", "dcf, edca, tdma, ideal");
      } else {
        reader.finish();
      }
  }
  return mac;
}

}  // namespace cuscus::scenario
