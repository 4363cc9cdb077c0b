#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cuscus {

/// An OpenStreetMap file in the making, as XML.
class OsmText {
 public:
  using TagList = std::vector<std::pair<std::string, std::string>>;

  OsmText& node(std::int64_t id, double longitude_deg, double latitude_deg,
                const TagList& tags = {}) {
    body_ += "<node id=\"" + std::to_string(id) + "\" lon=\"" + std::to_string(longitude_deg) +
             "\" lat=\"" + std::to_string(latitude_deg) + "\">" + tag_text(tags) + "</node>\n";
    return *this;
  }

  OsmText& way(std::int64_t id, const std::vector<std::int64_t>& nodes, const TagList& tags) {
    body_ += "<way id=\"" + std::to_string(id) + "\">";
    for (const std::int64_t node : nodes) {
      body_ += "<nd ref=\"" + std::to_string(node) + "\"/>";
    }
    body_ += tag_text(tags) + "</way>\n";
    return *this;
  }

  struct Member {
    std::int64_t way;
    std::string role;
  };
  OsmText& relation(std::int64_t id, const std::vector<Member>& members, const TagList& tags) {
    body_ += "<relation id=\"" + std::to_string(id) + "\">";
    for (const Member& member : members) {
      body_ += "<member type=\"way\" ref=\"" + std::to_string(member.way) + "\" role=\"" +
               member.role + "\"/>";
    }
    body_ += tag_text(tags) + "</relation>\n";
    return *this;
  }

  /// A closed way around a box whose sides are given in units of 0.0001 degrees, and its nodes,
  /// whose ids are 10 times the way's and those after.
  OsmText& box(std::int64_t id, int west, int south, int east, int north, const TagList& tags) {
    constexpr double kUnit_deg = 1e-4;
    const std::int64_t first = 10 * id;
    node(first, west * kUnit_deg, south * kUnit_deg);
    node(first + 1, east * kUnit_deg, south * kUnit_deg);
    node(first + 2, east * kUnit_deg, north * kUnit_deg);
    node(first + 3, west * kUnit_deg, north * kUnit_deg);
    return way(id, {first, first + 1, first + 2, first + 3, first}, tags);
  }

  [[nodiscard]] std::string text() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\">\n" + body_ +
           "</osm>\n";
  }

 private:
  static std::string tag_text(const TagList& tags) {
    std::string text;
    for (const auto& [key, value] : tags) {
      text += "<tag k=\"" + key + "\" v=\"" + escaped(value) + "\"/>";
    }
    return text;
  }
  static std::string escaped(const std::string& value) {
    std::string text;
    for (const char c : value) {
      c == '"'   ? text += "&quot;"
      : c == '<' ? text += "&lt;"
      : c == '&' ? text += "&amp;"
                 : text += c;
    }
    return text;
  }

  std::string body_;
};

}  // namespace cuscus
