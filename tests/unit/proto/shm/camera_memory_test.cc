#include "proto/shm/camera_memory.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <new>
#include <thread>
#include <vector>

namespace cuscus::shm {
namespace {

constexpr PictureShape kShape{.width_px = 31, .height_px = 17, .focal_px = 25.0};  // 1581 bytes

class PageMemory {
 public:
  [[nodiscard]] std::span<std::byte> bytes() const { return {bytes_.get(), size_}; }

 private:
  struct Free {
    void operator()(std::byte* bytes) const { ::operator delete[](bytes, std::align_val_t{4096}); }
  };
  std::size_t size_{CameraMemoryWriter::byte_size(kShape)};
  std::unique_ptr<std::byte[], Free> bytes_{new (std::align_val_t{4096}) std::byte[size_]{}};
};

CameraFrame frame(std::uint64_t sequence) {
  return {.sim_time_ns = static_cast<std::int64_t>(sequence) * 10,
          .sequence = sequence,
          .p_WC_m = {1.0, 2.0, 3.0},
          .q_WC = {1.0, 0.0, 0.0, 0.0}};
}

TEST_CASE("the newest picture is read as it was written") {
  const PageMemory memory;
  CameraMemoryWriter writer{memory.bytes(), kShape};
  const CameraMemoryReader reader{memory.bytes()};
  std::vector<std::byte> seen(kShape.byte_size());

  CHECK_FALSE(reader.read(seen));
  CHECK(reader.published() == 0);

  for (std::uint64_t sequence = 1; sequence <= 5; ++sequence) {
    std::vector<std::byte> picture(kShape.byte_size());
    for (std::size_t i = 0; i < picture.size(); ++i) {
      picture[i] = static_cast<std::byte>(i * 7 + sequence);
    }
    writer.publish(frame(2 * sequence), picture);

    const auto read = reader.read(seen);

    REQUIRE(read);
    CHECK(read->sequence == 2 * sequence);
    CHECK(read->sim_time_ns == 20 * static_cast<std::int64_t>(sequence));
    CHECK(read->p_WC_m[1] == 2.0);
    CHECK(seen == picture);
    CHECK(reader.published() == sequence);
  }
  CHECK(reader.shape().width_px == 31);
  CHECK(reader.shape().height_px == 17);
  CHECK(reader.shape().focal_px == 25.0);
}

TEST_CASE("a picture that is being written is never taken for a whole one") {
  const PageMemory memory;
  CameraMemoryWriter writer{memory.bytes(), kShape};
  const CameraMemoryReader reader{memory.bytes()};
  std::vector<std::byte> seen(kShape.byte_size());
  writer.publish(frame(1), seen);
  auto* const layout = reinterpret_cast<CameraMemoryLayout*>(memory.bytes().data());

  layout->versions[1].store(3);  // as if the writer had died in the place of picture 1

  CHECK_FALSE(reader.read(seen));
  writer.publish(frame(2), seen);
  CHECK(reader.read(seen)->sequence == 2);
}

TEST_CASE("pictures are whole however fast they are written") {
  const PageMemory memory;
  CameraMemoryWriter writer{memory.bytes(), kShape};
  const CameraMemoryReader reader{memory.bytes()};
  std::atomic<bool> done{false};
  std::thread camera{[&] {
    std::vector<std::byte> picture(kShape.byte_size());
    for (std::uint64_t sequence = 1; sequence <= 20'000; ++sequence) {
      std::ranges::fill(picture, static_cast<std::byte>(sequence));
      writer.publish(frame(sequence), picture);
    }
    done = true;
  }};

  std::vector<std::byte> seen(kShape.byte_size());
  std::uint64_t torn = 0;
  bool last = false;
  std::uint64_t newest = 0;
  while (!last) {
    last = done;
    if (const auto read = reader.read(seen)) {
      const auto expected = static_cast<std::byte>(read->sequence);
      if (!std::ranges::all_of(seen, [&](std::byte byte) { return byte == expected; })) {
        ++torn;
      }
      newest = read->sequence;
    }
  }
  camera.join();

  CHECK(torn == 0);
  CHECK(newest == 20'000);
}

TEST_CASE("memory whose pictures would not fit is refused") {
  const PageMemory memory;
  const CameraMemoryWriter writer{memory.bytes(), kShape};
  auto* const layout = reinterpret_cast<CameraMemoryLayout*>(memory.bytes().data());

  SECTION("another shape") { layout->height_px = 400; }
  SECTION("no shape at all") { layout->width_px = 0; }
  SECTION("another memory") { layout->header.magic = 1; }

  CHECK_THROWS_AS(CameraMemoryReader{memory.bytes()}, LayoutError);
}

}  // namespace
}  // namespace cuscus::shm
