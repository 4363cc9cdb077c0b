#include "camera/gl/surfaceless_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <stdexcept>

namespace cuscus::camera {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error{"cameras need OpenGL 4.5 without a display (EGL, surfaceless): " + what +
                           "; install the packages libegl-mesa0 and libgl1-mesa-dri"};
}

}  // namespace

SurfacelessContext::SurfacelessContext() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    refuse("EGL has no platform of that kind");
  }
  display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr /* the default one */,
                                      nullptr);
  if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE) {
    refuse("there is no driver");
  }
  constexpr std::array<EGLint, 7> kAttributes{EGL_CONTEXT_MAJOR_VERSION,
                                              4,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              5,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_NONE};
  if (eglBindAPI(EGL_OPENGL_API) == EGL_TRUE) {
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes.data());
  }
  if (context_ == EGL_NO_CONTEXT ||
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
    eglTerminate(display_);
    refuse("the driver is too old");
  }
}

SurfacelessContext::~SurfacelessContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

std::string SurfacelessContext::renderer() const {
  return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

}  // namespace cuscus::camera
