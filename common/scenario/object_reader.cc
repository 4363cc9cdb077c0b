#include "common/scenario/object_reader.h"

#include <algorithm>
#include <cmath>

#include "common/scenario/json_document.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

std::string kind_of(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return "an array";
    case json::value_t::string:
      return "a text";
    case json::value_t::boolean:
      return "true or false";
    default:
      return "a number";
  }
}

std::string number_text(double value) { return json(value).dump(); }

/// Farthest from the origin that anything may be.
constexpr QuantityRange kPlace{kLength, "-100 km", "100 km"};

}  // namespace

void Problems::add(const std::string& path, const std::string& message) {
  for (const auto& [pointer, option] : overrides_) {
    if (path == pointer || path.starts_with(pointer + '/')) {
      problems_.push_back({option, path, message});
      return;
    }
  }
  problems_.push_back({source_, path, message});
}

void Problems::throw_if_any() const {
  if (!problems_.empty()) {
    throw ScenarioError{problems_};
  }
}

std::string shown(const json& value) {
  constexpr std::size_t kShown = 80;
  if (value.is_structured() && !value.empty()) {
    return kind_of(value);
  }
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() <= kShown ? text : text.substr(0, kShown) + "...";
}

double read_quantity(const json& value, const std::string& path, double fallback,
                     const QuantityRange& range, Problems& problems) {
  const std::string example = ", such as \"" + std::string{range.dimension.example} +
                              "\" (units: " + unit_names(range.dimension) + ")";
  if (!value.is_string()) {
    problems.add(path, shown(value) + " is " + kind_of(value) +
                           (value.is_number() ? " without a unit" : "") + "; allowed: " +
                           std::string{range.dimension.name} + " as a text" + example);
    return fallback;
  }
  try {
    const double result = parse_quantity(value.get_ref<const std::string&>(), range.dimension);
    if (result < parse_quantity(range.least, range.dimension) ||
        result > parse_quantity(range.most, range.dimension)) {
      problems.add(path, shown(value) + " is out of range; allowed: " + std::string{range.least} +
                             " ... " + std::string{range.most});
      return fallback;
    }
    return result;
  } catch (const UnitError& error) {
    problems.add(path, error.what());
    return fallback;
  }
}

std::string read_text(const json& value, const std::string& path, const std::string& fallback,
                      std::size_t longest_bytes, Problems& problems) {
  if (!value.is_string()) {
    problems.add(path, shown(value) + " is " + kind_of(value) + "; allowed: a text");
    return fallback;
  }
  const auto& text = value.get_ref<const std::string&>();
  if (text.size() > longest_bytes) {
    problems.add(path, "is " + std::to_string(text.size()) + " B long; allowed: up to " +
                           std::to_string(longest_bytes) + " B");
    return fallback;
  }
  if (text.find('\0') != std::string::npos) {
    problems.add(path, shown(value) + " has a NUL character in it, which is not allowed");
    return fallback;
  }
  return text;
}

ObjectReader::ObjectReader(const json* value, std::string path, Problems& problems)
    : value_{value}, path_{std::move(path)}, problems_{problems} {
  if (value_ != nullptr && !value_->is_object()) {
    problems_.add(path_, shown(*value_) + " is " + kind_of(*value_) + "; allowed: an object {...}");
    value_ = nullptr;
  }
}

std::string ObjectReader::path_of(const std::string& key) const {
  return path_ + '/' + pointer_token(key);
}

bool ObjectReader::has(const std::string& key) const {
  return value_ != nullptr && value_->contains(key);
}

const json* ObjectReader::child(const std::string& key) {
  known_.push_back(key);
  return has(key) ? &value_->at(key) : nullptr;
}

void ObjectReader::problem(const std::string& key, const std::string& message) {
  problems_.add(path_of(key), message);
}

void ObjectReader::missing(const std::string& key, const std::string& allowed) {
  problems_.add(path_of(key), "is missing; allowed: " + allowed);
}

std::string ObjectReader::text(const std::string& key, const std::string& fallback,
                               std::size_t longest_bytes) {
  const json* value = child(key);
  return value == nullptr ? fallback
                          : read_text(*value, path_of(key), fallback, longest_bytes, problems_);
}

bool ObjectReader::boolean(const std::string& key, bool fallback) {
  const json* value = child(key);
  if (value == nullptr) {
    return fallback;
  }
  if (!value->is_boolean()) {
    problem(key, shown(*value) + " is " + kind_of(*value) + "; allowed: true, false");
    return fallback;
  }
  return value->get<bool>();
}

std::uint64_t ObjectReader::unsigned_integer(const std::string& key, std::uint64_t fallback,
                                             std::uint64_t least, std::uint64_t most) {
  const json* value = child(key);
  if (value == nullptr) {
    return fallback;
  }
  if (!value->is_number_unsigned() || value->get<std::uint64_t>() < least ||
      value->get<std::uint64_t>() > most) {
    problem(key,
            shown(*value) +
                (value->is_number() ? " is out of range or not whole" : " is " + kind_of(*value)) +
                "; allowed: a whole number " + std::to_string(least) + " ... " +
                std::to_string(most));
    return fallback;
  }
  return value->get<std::uint64_t>();
}

double ObjectReader::number(const std::string& key, double fallback,
                            const NumberRange<double>& range) {
  const json* value = child(key);
  if (value == nullptr) {
    return fallback;
  }
  const std::string allowed =
      "; allowed: a number " + number_text(range.least) + " ... " + number_text(range.most);
  if (!value->is_number()) {
    problem(key, shown(*value) + " is " + kind_of(*value) + allowed);
    return fallback;
  }
  const double number = value->get<double>();
  if (!(number >= range.least && number <= range.most)) {
    problem(key, shown(*value) + " is out of range" + allowed);
    return fallback;
  }
  return number + 0.0;  // -0 becomes 0
}

double ObjectReader::quantity(const std::string& key, double fallback, const QuantityRange& range) {
  const json* value = child(key);
  return value == nullptr ? fallback
                          : read_quantity(*value, path_of(key), fallback, range, problems_);
}

Duration ObjectReader::duration(const std::string& key, Duration fallback, std::string_view least,
                                std::string_view most) {
  const double fallback_ns = static_cast<double>(fallback.count());
  return Duration{std::llround(quantity(key, fallback_ns, {kTime, least, most}))};
}

Duration ObjectReader::period_of_rate(const std::string& key, Duration fallback,
                                      std::string_view least, std::string_view most) {
  const double fallback_hz = 1e9 / static_cast<double>(fallback.count());
  return Duration{std::llround(1e9 / quantity(key, fallback_hz, {kFrequency, least, most}))};
}

void ObjectReader::read_lengths(const std::string& key, std::span<double> lengths) {
  const json* value = child(key);
  if (value == nullptr) {
    return;
  }
  if (!value->is_array() || value->size() != lengths.size()) {
    problem(key, shown(*value) + (value->is_array() ? " of " + std::to_string(value->size()) : "") +
                     "; allowed: an array of " + std::to_string(lengths.size()) +
                     " lengths, such as " +
                     (lengths.size() == 3 ? R"(["0 m", "20 m", "1 m"])" : R"(["0 m", "20 m"])"));
    return;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] = read_quantity(value->at(i), path_of(key) + '/' + std::to_string(i), lengths[i],
                               kPlace, problems_);
  }
}

std::vector<std::string> ObjectReader::texts(const std::string& key, std::size_t most_elements,
                                             std::size_t longest_bytes) {
  const json* value = child(key);
  std::vector<std::string> result;
  if (value == nullptr) {
    return result;
  }
  if (!value->is_array() || value->size() > most_elements) {
    problem(key, (value->is_array() ? "has " + std::to_string(value->size()) + " elements"
                                    : shown(*value) + " is " + kind_of(*value)) +
                     "; allowed: an array of up to " + std::to_string(most_elements) + " texts");
    return result;
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    result.push_back(read_text(value->at(i), path_of(key) + '/' + std::to_string(i), {},
                               longest_bytes, problems_));
  }
  return result;
}

std::size_t ObjectReader::choice_index(const std::string& key,
                                       const std::vector<std::string>& names) {
  const json* value = child(key);
  if (value == nullptr) {
    return names.size();
  }
  if (value->is_string()) {
    const auto found = std::find(names.begin(), names.end(), value->get_ref<const std::string&>());
    if (found != names.end()) {
      return static_cast<std::size_t>(found - names.begin());
    }
  }
  const std::string near =
      value->is_string() ? nearest(value->get_ref<const std::string&>(), names) : std::string{};
  problem(key, shown(*value) + " is not known; " +
                   (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
                   "allowed: " + joined(names));
  return names.size();
}

void ObjectReader::finish() {
  if (value_ == nullptr) {
    return;
  }
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
      const std::string near = nearest(key, known_);
      problem(key, "is not a known key; " +
                       (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
                       "allowed: " + joined(known_));
    }
  }
}

bool is_none(const nlohmann::json* value, const std::string& path, const std::string& otherwise,
             Problems& problems) {
  if (value == nullptr || !value->is_string()) {
    return false;
  }
  if (*value != "none") {
    problems.add(path,
                 shown(*value) + " is not known; allowed: none, or an object with " + otherwise);
  }
  return true;
}

}  // namespace cuscus::scenario
