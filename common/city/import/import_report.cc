#include "common/city/import/import_report.h"

#include <algorithm>
#include <array>

namespace cuscus::city {
namespace {

struct Description {
  Problem problem;
  bool leaves_out;
  ProblemText text;
};

constexpr std::array<Description, kProblems> kDescriptions{{
    {Problem::kOpenRing, true, {"open_ring", "the outline does not close"}},
    {Problem::kTooFewPoints, true, {"too_few_points", "the outline has less than three corners"}},
    {Problem::kCrossesItself, true, {"crosses_itself", "the outline crosses itself"}},
    {Problem::kMissingNodes, true, {"missing_nodes", "nodes of the outline are not in the file"}},
    {Problem::kMissingMembers, true, {"missing_members", "members are not in the file"}},
    {Problem::kNoArea, true, {"no_area", "the outline encloses no area"}},
    {Problem::kDuplicate, true, {"duplicate", "it is there already"}},
    {Problem::kUnderGround, true, {"under_ground", "it lies under the ground"}},
    {Problem::kHiddenPart, true, {"hidden_part", "the part lies within other parts"}},
    {Problem::kBadHeight, false, {"bad_height", "the height makes no sense"}},
    {Problem::kBadLevels, false, {"bad_levels", "the number of levels makes no sense"}},
    {Problem::kBadMinHeight, false, {"bad_min_height", "the minimum height makes no sense"}},
    {Problem::kBadRoof, false, {"bad_roof", "the roof's height makes no sense"}},
    {Problem::kBottomAboveTop,
     false,
     {"bottom_above_top", "the minimum height is not below the height"}},
    {Problem::kUnknownMaterial, false, {"unknown_material", "no wall of this material is known"}},
    {Problem::kBadWidth, false, {"bad_width", "the street's width makes no sense"}},
    {Problem::kBadTreeSize, false, {"bad_tree_size", "the tree's or wood's size makes no sense"}},
    {Problem::kPartAlone, false, {"part_alone", "the part has no building: taken for one itself"}},
}};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kProblems; ++i) {
    if (kDescriptions[i].problem != static_cast<Problem>(i)) {
      return false;
    }
  }
  return true;
}
static_assert(in_order());

const Description& description_of(Problem problem) {
  return kDescriptions[static_cast<std::size_t>(problem)];
}

}  // namespace

std::string text_of(const ObjectId& object) {
  static constexpr std::array<std::string_view, 3> kTypes{"node ", "way ", "relation "};
  return std::string{kTypes[static_cast<std::size_t>(object.type)]} + std::to_string(object.id);
}

bool leaves_out(Problem problem) { return description_of(problem).leaves_out; }

ProblemText text_of(Problem problem) { return description_of(problem).text; }

void FileReport::add(Problem problem, const ObjectId& object, std::string_view detail) {
  constexpr std::size_t kLongestDetail = 80;
  Finding& finding = findings_[static_cast<std::size_t>(problem)];
  ++finding.count;
  if (finding.examples.size() == Finding::kMaxExamples) {
    return;
  }
  std::string shown{detail.substr(0, kLongestDetail)};
  // Mappers' text goes to terminals.
  std::ranges::replace_if(
      shown, [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7f; }, '?');
  finding.examples.push_back({object, std::move(shown)});
}

}  // namespace cuscus::city
