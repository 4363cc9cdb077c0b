#include "orchestrator/fetch/map_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "orchestrator/fetch/overpass_query.h"

namespace cuscus::orchestrator {
namespace {

constexpr std::size_t kHead = 2000;
constexpr std::size_t kTail = 2000;

}  // namespace

void MapCheck::take(std::string_view piece) {
  head_ += piece.substr(0, kHead - std::min(head_.size(), kHead));
  tail_ += piece.substr(piece.size() - std::min(piece.size(), kTail));
  tail_.erase(0, tail_.size() - std::min(tail_.size(), kTail));
}

std::string MapCheck::fault() const {
  if (head_.find("<osm") == std::string::npos) {
    return fmt::format("the answer is no OpenStreetMap data: {}", error_in_page(head_));
  }
  if (const std::string remark = remark_in_tail(tail_); !remark.empty()) {
    return fmt::format("the server gave up: {}", remark);
  }
  const auto end = tail_.rfind("</osm>");
  if (end == std::string::npos) {
    return "the answer ends before the data do";
  }
  return {};
}

}  // namespace cuscus::orchestrator
