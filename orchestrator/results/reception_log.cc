#include "orchestrator/results/reception_log.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <stdexcept>

namespace cuscus::orchestrator {
namespace {

using logs::ReceptionLogHeader;
using logs::ReceptionLogRecord;

constexpr std::size_t kRecordsAtOnce = 4096;
constexpr std::uint32_t kMostNodes = 65'536;
constexpr std::uint32_t kMostNameBytes = kMostNodes * 128;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error{file.string() + ": " + why};
}

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < text.size();) {
    names.emplace_back(text.c_str() + at);
    at += names.back().size() + 1;
  }
  return names;
}

bool is_possible(const ReceptionLogRecord& record, std::size_t nodes) {
  return record.sender < nodes && record.receiver < nodes &&
         record.destination < static_cast<std::int64_t>(nodes) &&
         (record.interferer < nodes || record.interferer == logs::kNoInterferer);
}

}  // namespace

ReceptionLogReader::ReceptionLogReader(const std::filesystem::path& file)
    : file_{file, std::ios::binary} {
  ReceptionLogHeader header{};
  if (!file_.read(reinterpret_cast<char*>(&header), sizeof header) ||
      header.magic != ReceptionLogHeader::kMagic) {
    refuse(file, "is no reception log");
  }
  if (header.version != ReceptionLogHeader::kVersion ||
      header.record_bytes != sizeof(ReceptionLogRecord)) {
    refuse(file, fmt::format("is a reception log of version {}; this cuscus reads version {}",
                             header.version, ReceptionLogHeader::kVersion));
  }
  if (header.node_count > kMostNodes || header.name_bytes > kMostNameBytes) {
    refuse(file, "is damaged: it says that there are too many nodes");
  }
  std::string text(header.name_bytes, '\0');
  file_.read(text.data(), header.name_bytes);
  names_ = split_names(text);
  if (!file_ || names_.size() != header.node_count || (!text.empty() && text.back() != '\0')) {
    refuse(file, "is damaged: the names of the nodes are not all there");
  }
}

bool ReceptionLogReader::fill() {
  buffer_.resize(kRecordsAtOnce);
  file_.read(reinterpret_cast<char*>(buffer_.data()),
             static_cast<std::streamsize>(kRecordsAtOnce * sizeof(ReceptionLogRecord)));
  buffer_.resize(static_cast<std::size_t>(file_.gcount()) / sizeof(ReceptionLogRecord));
  next_ = 0;
  return !buffer_.empty();
}

std::optional<ReceptionLogRecord> ReceptionLogReader::next() {
  while (next_ < buffer_.size() || fill()) {
    const ReceptionLogRecord& record = buffer_[next_++];
    if (is_possible(record, names_.size())) {
      return record;
    }
  }
  return std::nullopt;
}

}  // namespace cuscus::orchestrator
