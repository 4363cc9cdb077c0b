#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "proto/shm/layout.h"
#include "proto/shm/seqlock.h"

namespace cuscus::shm {

/// Sides that a picture may have.
inline constexpr std::uint32_t kMinPictureSide_px = 16;
inline constexpr std::uint32_t kMaxPictureSide_px = 4096;

/// What is told of one picture besides its pixels.
struct CameraFrame {
  std::int64_t sim_time_ns;  ///< Of the pose.
  std::uint64_t sequence;    ///< From 1; a number that is left out is a picture that was not made.
  /// The camera's pose, as it truly was: what a picture is compared with. Camera frame C: x to the
  /// right of the picture, y down in it, z ahead. World frame W: ENU.
  std::array<double, 3> p_WC_m;
  std::array<double, 4> q_WC;  ///< w, x, y, z; unit.
};

/// Pictures of one camera: written by cuscus-camera, read by the vehicle's agent. RGB8, row by row
/// from the top, without gaps. The newest picture stays for at least two more before its place is
/// written again.
struct CameraMemoryLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSVIEWS");
  static constexpr std::uint32_t kVersion = 1;
  static constexpr std::uint32_t kPlaces = 3;

  Header header;
  std::uint32_t width_px;
  std::uint32_t height_px;
  double focal_px;  ///< The principal point is the picture's middle; pixels are square.
  alignas(kCacheLine) std::atomic<std::uint64_t> latest;  ///< Pictures published.
  /// Per place: odd while it is written.
  alignas(kCacheLine) std::array<std::atomic<std::uint64_t>, kPlaces> versions;
  std::array<Seqlock<CameraFrame>, kPlaces> frames;
  // Pixels of each place follow, in whole words, on cache lines of their own.
};

/// What all pictures of a camera have in common.
struct PictureShape {
  std::uint32_t width_px{};
  std::uint32_t height_px{};
  double focal_px{};

  [[nodiscard]] constexpr std::size_t byte_size() const {
    return std::size_t{width_px} * height_px * 3;
  }
};

class CameraMemoryWriter {
 public:
  [[nodiscard]] static std::size_t byte_size(const PictureShape& shape);

  /// Lays the memory out in `memory` (page-aligned, byte_size() long), which must outlive this.
  CameraMemoryWriter(std::span<std::byte> memory, const PictureShape& shape);

  /// `rgb` has the shape's byte_size().
  void publish(const CameraFrame& frame, std::span<const std::byte> rgb) noexcept;

 private:
  CameraMemoryLayout* layout_;
  std::span<std::atomic<std::uint64_t>> words_;  // of all places
  std::size_t picture_bytes_;
};

class CameraMemoryReader {
 public:
  /// @throws LayoutError when `memory` is not camera memory.
  explicit CameraMemoryReader(std::span<const std::byte> memory);

  [[nodiscard]] const PictureShape& shape() const noexcept { return shape_; }
  /// Pictures published so far: whether there is a newer one, without copying it.
  [[nodiscard]] std::uint64_t published() const noexcept;
  /// Copies the newest picture to `rgb`, which has the shape's byte_size(); nothing, and `rgb`
  /// undefined, before the first, and when pictures came faster than they could be copied.
  [[nodiscard]] std::optional<CameraFrame> read(std::span<std::byte> rgb) const noexcept;

 private:
  const CameraMemoryLayout* layout_;
  PictureShape shape_;
  std::span<const std::atomic<std::uint64_t>> words_;
};

}  // namespace cuscus::shm
