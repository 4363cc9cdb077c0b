#pragma once

#include <string>

namespace cuscus::camera {

/// OpenGL without a window or a display server, current in the thread that made it: by a graphics
/// card where this process may use one, else by Mesa's software. One per process.
class SurfacelessContext {
 public:
  /// @throws std::runtime_error naming the Debian package that is missing when there is none.
  SurfacelessContext();
  ~SurfacelessContext();
  SurfacelessContext(const SurfacelessContext&) = delete;
  SurfacelessContext& operator=(const SurfacelessContext&) = delete;

  /// Who draws, such as "llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] std::string renderer() const;

 private:
  void* display_{nullptr};
  void* context_{nullptr};
};

}  // namespace cuscus::camera
