#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

void read_captured_nodes(ObjectReader& reader, Captures& captures) {
  const std::string key = "captures";
  const json* value = reader.child(key);
  if (value == nullptr) {
    return;
  }
  if (value->is_boolean()) {
    captures.everyone = value->get<bool>();
  } else if (!value->is_array() || value->empty() || value->size() > kMaxNodes) {
    reader.problem(key, shown(*value) + "; allowed: true, false, or an array of 1 ... " +
                            std::to_string(kMaxNodes) + " node names");
  } else {
    captures.nodes = reader.texts(key, kMaxNodes, 64);
  }
}

std::optional<std::uint32_t> read_snap_length(ObjectReader& reader) {
  // A radiotap header and the longest MAC header fit in the least.
  constexpr std::uint32_t kLeast = 64;
  constexpr std::uint32_t kMost = 65'535;
  const std::string key = "snap_length";
  const json* value = reader.child(key);
  if (value == nullptr || *value == "none") {
    return std::nullopt;
  }
  if (value->is_string()) {
    reader.problem(key, shown(*value) + "; allowed: none, or a whole number of bytes 64 ... 65535");
    return std::nullopt;
  }
  return reader.integer<std::uint32_t>(key, kLeast, {kLeast, kMost});
}

}  // namespace

Record read_record(const json* value, Problems& problems) {
  Record record;
  ObjectReader reader{value, "/record", problems};
  record.frames = reader.boolean("frames", record.frames);
  record.receptions = reader.boolean("receptions", record.receptions);
  read_captured_nodes(reader, record.captures);
  record.captures.failed_receptions =
      reader.boolean("failed_receptions", record.captures.failed_receptions);
  record.captures.snap_length_bytes = read_snap_length(reader);
  record.metrics_period = reader.duration("metrics_period", record.metrics_period, "10 ms", "60 s");
  reader.finish();
  return record;
}

}  // namespace cuscus::scenario
