#include "common/scenario/json_document.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "common/scenario/scenario_error.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

/// Follows the parser to find what json itself lets pass: repeated keys and deep nesting.
class Watcher {
 public:
  explicit Watcher(const std::string& source) : source_{source} {}

  bool operator()(int /*depth*/, json::parse_event_t event, const json& parsed) {
    switch (event) {
      case json::parse_event_t::object_start:
        enter(false);
        break;
      case json::parse_event_t::array_start:
        enter(true);
        break;
      case json::parse_event_t::key:
        key(parsed.get_ref<const std::string&>());
        break;
      case json::parse_event_t::value:
        count();
        break;
      case json::parse_event_t::object_end:
      case json::parse_event_t::array_end:
        open_.pop_back();
        break;
    }
    return true;
  }

 private:
  struct Level {
    bool is_array;
    std::size_t elements;
    std::set<std::string> keys;
    std::string key;  ///< The one whose value is being read.
  };

  void count() {
    if (!open_.empty() && open_.back().is_array) {
      ++open_.back().elements;
    }
  }

  void enter(bool is_array) {
    count();
    open_.push_back({is_array, 0, {}, {}});
    if (open_.size() > static_cast<std::size_t>(kMaxDocumentDepth)) {
      fail("is nested more than " + std::to_string(kMaxDocumentDepth) + " levels deep");
    }
  }

  void key(const std::string& key) {
    open_.back().key = key;
    if (!open_.back().keys.insert(key).second) {
      fail("is given twice; a key may be given once");
    }
  }

  [[noreturn]] void fail(const std::string& message) const {
    std::string path;
    for (const Level& level : open_) {
      if (level.is_array && level.elements > 0) {
        path += '/' + std::to_string(level.elements - 1);
      } else if (!level.key.empty()) {
        path += '/' + pointer_token(level.key);
      }
    }
    throw ScenarioError{{{source_, path, message}}};
  }

  const std::string& source_;
  std::vector<Level> open_;
};

/// "[json.exception.parse_error.101] parse error at line 3, column 5: ..." without the bracket.
std::string readable(const std::string& what) {
  const std::size_t end = what.starts_with('[') ? what.find("] ") : std::string::npos;
  return end == std::string::npos ? what : what.substr(end + 2);
}

}  // namespace

std::string pointer_token(const std::string& token) {
  std::string escaped;
  for (const char c : token) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    }
  }
  return escaped;
}

json parse_document(std::string_view text, const std::string& source) {
  if (text.size() > kMaxDocumentBytes) {
    throw ScenarioError{{{source, "",
                          "is " + std::to_string(text.size()) + " B long; allowed: up to " +
                              std::to_string(kMaxDocumentBytes) + " B"}}};
  }
  try {
    return json::parse(text, Watcher{source});
  } catch (const json::exception& error) {
    throw ScenarioError{{{source, "", "is not JSON: " + readable(error.what())}}};
  }
}

}  // namespace cuscus::scenario
