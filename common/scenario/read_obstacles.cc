// What stands, and what jams, in the radio's world.
#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

constexpr std::size_t kMostObstacles = 1000;
constexpr std::size_t kMostJammers = 100;
constexpr std::size_t kLongestName_bytes = 64;

/// Reads every element of an array of objects, each with a name of its own: `kind` and its number
/// where it has none.
template <typename Element>
std::vector<Element> read_named(const json* value, const std::string& path, std::size_t most,
                                const std::string& kind,
                                const std::function<Element(ObjectReader&)>& read_one,
                                Problems& problems) {
  std::vector<Element> elements;
  if (value == nullptr) {
    return elements;
  }
  if (!value->is_array() || value->size() > most) {
    problems.add(path, (value->is_array() ? "has " + std::to_string(value->size()) + " elements"
                                          : shown(*value) + " is no array") +
                           "; allowed: an array of up to " + std::to_string(most) + " objects");
    return elements;
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < value->size(); ++i) {
    ObjectReader reader{&value->at(i), path + '/' + std::to_string(i), problems};
    const std::string name = reader.text("name", kind + std::to_string(i), kLongestName_bytes);
    if (!names.insert(name).second) {
      reader.problem("name", '"' + name + "\" is given twice; allowed: each name once");
    }
    Element element = read_one(reader);
    element.name = name;
    reader.finish();
    elements.push_back(std::move(element));
  }
  return elements;
}

Decibel read_wall(ObjectReader& reader, const std::string& key, Decibel fallback) {
  const json* value = reader.child(key);
  if (value == nullptr) {
    return fallback;
  }
  const std::string text = value->is_string() ? value->get<std::string>() : std::string{};
  for (const auto& [name, loss_db] : kWallNames) {
    if (text == name) {
      return {loss_db};
    }
  }
  if (text.find_first_of("0123456789") == std::string::npos) {
    reader.problem(key, shown(*value) + " is not known; allowed: stone, concrete, or a loss of " +
                            "0.01 dB ... 300 dB");
    return fallback;
  }
  return {read_quantity(*value, reader.path_of(key), fallback.value,
                        {kPowerRatio, "0.01 dB", "300 dB"}, reader.problems())};
}

std::optional<InnerWalls> read_inner_walls(const json* value, const std::string& path,
                                           Problems& problems) {
  if (value == nullptr || is_none(value, path, "spacing and loss", problems)) {
    return std::nullopt;
  }
  InnerWalls walls;
  ObjectReader reader{value, path, problems};
  walls.spacing_m = reader.quantity("spacing", walls.spacing_m, {kLength, "0.5 m", "1 km"});
  walls.loss.value = reader.quantity("loss", walls.loss.value, {kPowerRatio, "0 dB", "100 dB"});
  reader.finish();
  return walls;
}

BoxObstacle read_obstacle(ObjectReader& reader) {
  BoxObstacle box;
  box.centre_m = reader.lengths<2>("centre", box.centre_m);
  if (!reader.has("size")) {
    reader.missing("size", R"(length, width and height, such as ["20 m", "10 m", "12 m"])");
  }
  box.size_m = reader.lengths<3>("size", {1.0, 1.0, 1.0});
  if (std::any_of(box.size_m.begin(), box.size_m.end(), [](double m) { return m < 0.01; })) {
    reader.problem("size", "is not a size; allowed: length, width and height from 1 cm");
  }
  box.heading_rad = reader.quantity("heading", box.heading_rad, {kAngle, "-360 deg", "360 deg"});
  box.outer_wall = read_wall(reader, "outer_wall", box.outer_wall);
  box.inner_walls = read_inner_walls(reader.child("inner_walls"), reader.path_of("inner_walls"),
                                     reader.problems());
  return box;
}

Jammer read_jammer(ObjectReader& reader) {
  Jammer jammer;
  if (!reader.has("position")) {
    reader.missing("position", R"(east, north and up, such as ["0 m", "20 m", "1 m"])");
  }
  jammer.position_m = reader.lengths<3>("position", jammer.position_m);
  jammer.power.value =
      reader.quantity("power", jammer.power.value, {kPower, "-100 dBm", "100 dBm"});
  if (const json* frequency = reader.child("frequency");
      frequency != nullptr && *frequency != "channel") {
    jammer.frequency_hz = read_quantity(*frequency, reader.path_of("frequency"), 2.437e9,
                                        {kFrequency, "1 MHz", "100 GHz"}, reader.problems());
  }
  jammer.bandwidth_hz =
      reader.quantity("bandwidth", jammer.bandwidth_hz, {kFrequency, "1 Hz", "10 GHz"});
  jammer.duty = reader.number("duty", jammer.duty, {0.001, 1.0});
  jammer.period = reader.duration("period", jammer.period, "100 us", "1 h");
  jammer.start = reader.duration("start", jammer.start, "0 s", "24 h");
  if (const json* stop = reader.child("stop"); stop != nullptr && *stop != "none") {
    jammer.stop = reader.duration("stop", Duration{0}, "0 s", "24 h");
    if (*jammer.stop <= jammer.start) {
      reader.problem("stop",
                     shown(*stop) + " is not after the start; allowed: none, or a later time");
    }
  }
  return jammer;
}

}  // namespace

std::vector<BoxObstacle> read_obstacles(const json* value, const std::string& path,
                                        Problems& problems) {
  return read_named<BoxObstacle>(value, path, kMostObstacles, "box", read_obstacle, problems);
}

std::vector<Jammer> read_jammers(const json* value, const std::string& path, Problems& problems) {
  return read_named<Jammer>(value, path, kMostJammers, "jammer", read_jammer, problems);
}

}  // namespace cuscus::scenario
