#include "proto/shm/camera_memory.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <new>
#include <string>

namespace cuscus::shm {
namespace {

using Word = std::atomic<std::uint64_t>;

/// Of one picture, up to a cache line's end.
std::size_t picture_words(const PictureShape& shape) {
  return (shape.byte_size() + kCacheLine - 1) / kCacheLine * (kCacheLine / sizeof(Word));
}

std::size_t all_words(const PictureShape& shape) {
  return CameraMemoryLayout::kPlaces * picture_words(shape);
}

bool is_allowed(const PictureShape& shape) {
  const auto fits = [](std::uint32_t side_px) {
    return side_px >= kMinPictureSide_px && side_px <= kMaxPictureSide_px;
  };
  return fits(shape.width_px) && fits(shape.height_px);
}

}  // namespace

std::size_t CameraMemoryWriter::byte_size(const PictureShape& shape) {
  return sizeof(CameraMemoryLayout) + all_words(shape) * sizeof(Word);
}

CameraMemoryWriter::CameraMemoryWriter(std::span<std::byte> memory, const PictureShape& shape)
    : layout_{new (memory.data()) CameraMemoryLayout{}}, picture_bytes_{shape.byte_size()} {
  assert(is_allowed(shape) && memory.size() == byte_size(shape));
  layout_->width_px = shape.width_px;
  layout_->height_px = shape.height_px;
  layout_->focal_px = shape.focal_px;
  words_ = {new (memory.data() + sizeof(CameraMemoryLayout)) Word[all_words(shape)]{},
            all_words(shape)};
  write_header(memory, {.magic = CameraMemoryLayout::kMagic,
                        .version = CameraMemoryLayout::kVersion,
                        .node_count = 0,
                        .byte_size = memory.size()});
}

void CameraMemoryWriter::publish(const CameraFrame& frame,
                                 std::span<const std::byte> rgb) noexcept {
  assert(rgb.size() == picture_bytes_);
  const std::uint64_t number = layout_->latest.load(std::memory_order_relaxed) + 1;
  const std::size_t place = number % CameraMemoryLayout::kPlaces;
  Word& version = layout_->versions[place];
  const std::uint64_t before = version.load(std::memory_order_relaxed);
  version.store(before + 1, std::memory_order_relaxed);  // odd: being written
  layout_->frames[place].store(frame);
  const auto words = words_.subspan(place * (words_.size() / CameraMemoryLayout::kPlaces));
  std::size_t next = 0;
  for (std::size_t at = 0; at < rgb.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, rgb.data() + at, std::min(sizeof word, rgb.size() - at));
    words[next++].store(word, std::memory_order_release);
  }
  version.store(before + 2, std::memory_order_release);
  layout_->latest.store(number, std::memory_order_release);
}

CameraMemoryReader::CameraMemoryReader(std::span<const std::byte> memory)
    : layout_{reinterpret_cast<const CameraMemoryLayout*>(memory.data())} {
  checked_header(memory, CameraMemoryLayout::kMagic, CameraMemoryLayout::kVersion);
  if (memory.size() < sizeof(CameraMemoryLayout)) {
    throw LayoutError{"camera memory of " + std::to_string(memory.size()) + " bytes is too short"};
  }
  shape_ = {.width_px = layout_->width_px,
            .height_px = layout_->height_px,
            .focal_px = layout_->focal_px};
  if (!is_allowed(shape_) || memory.size() != CameraMemoryWriter::byte_size(shape_)) {
    throw LayoutError{"camera memory of " + std::to_string(memory.size()) +
                      " bytes cannot hold pictures of " + std::to_string(shape_.width_px) + " x " +
                      std::to_string(shape_.height_px) + " pixels"};
  }
  words_ = {reinterpret_cast<const Word*>(memory.data() + sizeof(CameraMemoryLayout)),
            all_words(shape_)};
}

std::uint64_t CameraMemoryReader::published() const noexcept {
  return layout_->latest.load(std::memory_order_acquire);
}

std::optional<CameraFrame> CameraMemoryReader::read(std::span<std::byte> rgb) const noexcept {
  assert(rgb.size() == shape_.byte_size());
  constexpr int kAttempts = 4;  // each is a copy of the whole picture
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::uint64_t number = published();
    if (number == 0) {
      return std::nullopt;
    }
    const std::size_t place = number % CameraMemoryLayout::kPlaces;
    const std::uint64_t before = layout_->versions[place].load(std::memory_order_acquire);
    const auto frame = layout_->frames[place].load();
    if (before % 2 != 0 || !frame) {
      continue;
    }
    const auto words = words_.subspan(place * (words_.size() / CameraMemoryLayout::kPlaces));
    std::size_t next = 0;
    for (std::size_t at = 0; at < rgb.size(); at += sizeof(std::uint64_t)) {
      const std::uint64_t word = words[next++].load(std::memory_order_acquire);
      std::memcpy(rgb.data() + at, &word, std::min(sizeof word, rgb.size() - at));
    }
    if (layout_->versions[place].load(std::memory_order_relaxed) == before) {
      return frame;
    }
  }
  return std::nullopt;
}

}  // namespace cuscus::shm
