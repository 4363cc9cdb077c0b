#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cuscus::city {

enum class ObjectType : std::uint8_t { kNode, kWay, kRelation };

/// An object of OpenStreetMap, as its web site names it.
struct ObjectId {
  ObjectType type{ObjectType::kWay};
  std::int64_t id{0};

  bool operator==(const ObjectId&) const = default;
};

/// "way 123".
[[nodiscard]] std::string text_of(const ObjectId& object);

/// What can be wrong with an object that was meant for the city.
enum class Problem : std::uint8_t {
  // The object is left out.
  kOpenRing,
  kTooFewPoints,
  kCrossesItself,
  kMissingNodes,
  kMissingMembers,
  kNoArea,
  kDuplicate,
  kUnderGround,
  kHiddenPart,
  // One of its values is ignored, or it is taken for something else; the object stays.
  kBadHeight,
  kBadLevels,
  kBadMinHeight,
  kBadRoof,
  kBottomAboveTop,
  kUnknownMaterial,
  kBadWidth,
  kBadTreeSize,
  kPartAlone,
};
inline constexpr std::size_t kProblems = 18;

/// True when the object is not in the city, false when only a value of it was ignored.
[[nodiscard]] bool leaves_out(Problem problem);

/// A key for programs, "open_ring", and a line for people, "the outline does not close".
struct ProblemText {
  std::string_view key;
  std::string_view line;
};
[[nodiscard]] ProblemText text_of(Problem problem);

/// One object with a problem, and what its tag says where it is about one: "height=3 storeys".
struct ProblemExample {
  ObjectId object;
  std::string detail;
};

/// How often a problem was met, and where first.
struct Finding {
  static constexpr std::size_t kMaxExamples = 5;

  std::size_t count{0};
  std::vector<ProblemExample> examples;
};

/// What one file had, and what of it could not be used.
class FileReport {
 public:
  std::string file;
  std::size_t nodes{0};
  std::size_t ways{0};
  std::size_t relations{0};

  /// Counts a problem; `detail` is cut to a readable length, its control characters replaced.
  void add(Problem problem, const ObjectId& object, std::string_view detail = {});

  [[nodiscard]] const Finding& of(Problem problem) const {
    return findings_[static_cast<std::size_t>(problem)];
  }

 private:
  std::array<Finding, kProblems> findings_;
};

/// The city in a few numbers.
struct CityFigures {
  std::size_t building_areas{0};  ///< Outlines that were read: ways and relations.
  std::size_t part_areas{0};      ///< building:part likewise.
  std::size_t buildings{0};
  std::size_t prisms{0};
  double footprint_m2{0.0};  ///< Of the outlines; of parts, where they stand without one.
  std::size_t height_from_tag{0};
  std::size_t height_from_levels{0};
  std::size_t height_from_rule{0};
  double tallest_m{0.0};  ///< Above the ground at its foot.
  std::int64_t tallest_osm_id{0};
  std::string tallest_name;
  double mean_height_m{0.0};  ///< Of the buildings, each by its highest prism.
  std::size_t streets{0};
  double street_length_m{0.0};
  std::size_t trees{0};
  std::size_t woods{0};
};

/// What an import understood and what it did not.
struct ImportReport {
  std::vector<FileReport> files;
  CityFigures figures;
  std::vector<std::string> remarks;  ///< On the whole: what to know before trusting the city.
};

}  // namespace cuscus::city
