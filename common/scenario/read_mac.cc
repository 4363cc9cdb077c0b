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

}  // namespace

Mac read_mac(const json* value, const std::string& path, Problems& problems) {
  ObjectReader reader{value, path, problems};
  switch (reader.choice_index("model", {"dcf", "tdma"})) {
    case 1: {
      TdmaMac tdma;
      tdma.slot = reader.duration("slot", tdma.slot, "100 us", "1 s");
      tdma.guard = reader.duration("guard", tdma.guard, "0 us", "10 ms");
      tdma.frame = read_frame(reader);
      if (tdma.guard >= tdma.slot) {
        reader.problem("guard", "is no shorter than the slot; allowed: less than " +
                                    format_quantity(static_cast<double>(tdma.slot.count()), kTime));
      }
      reader.finish();
      return tdma;
    }
    default:
      if (value != nullptr && value->is_object() && !reader.has("model")) {
        reader.missing("model", "dcf, tdma");
      } else {
        reader.finish();
      }
      return DcfMac{};
  }
}

}  // namespace cuscus::scenario
