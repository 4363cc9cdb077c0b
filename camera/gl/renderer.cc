#include "camera/gl/renderer.h"

#include <epoxy/gl.h>

#include <array>
#include <cassert>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "camera/gl/shaders.h"
#include "camera/scene/frustum.h"

namespace cuscus::camera {
namespace {

constexpr const char* kVersionLine = "#version 330 core\n";

GLuint compiled(GLenum kind, const char* body) {
  const GLuint shader = glCreateShader(kind);
  const std::array<const char*, 3> parts{kVersionLine, kShading, body};
  glShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  glCompileShader(shader);
  GLint done = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == GL_FALSE) {
    std::string log(1024, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error{"OpenGL does not compile a shader: " + log};
  }
  return shader;
}

GLuint linked(const char* vertex_body, const char* fragment_body) {
  const GLuint vertex = compiled(GL_VERTEX_SHADER, vertex_body);
  const GLuint fragment = compiled(GL_FRAGMENT_SHADER, fragment_body);
  const GLuint program = glCreateProgram();
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glLinkProgram(program);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint done = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done == GL_FALSE) {
    throw std::runtime_error{"OpenGL does not link a program"};
  }
  return program;
}

void set(GLuint program, const char* name, const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix4f rounded = matrix.cast<float>();
  glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, rounded.data());
}

void set(GLuint program, const char* name, const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3f rounded = matrix.cast<float>();
  glUniformMatrix3fv(glGetUniformLocation(program, name), 1, GL_FALSE, rounded.data());
}

void set(GLuint program, const char* name, double value) {
  glUniform1f(glGetUniformLocation(program, name), static_cast<float>(value));
}

void upload(const std::vector<Vertex>& vertices, GLuint& array, GLuint& buffer) {
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
               vertices.data(), GL_STATIC_DRAW);
  const auto attribute = [](GLuint number, GLint size, GLenum type, GLboolean normalized,
                            std::size_t offset) {
    glEnableVertexAttribArray(number);
    // The offset in the buffer travels as a pointer.
    glVertexAttribPointer(
        number, size, type, normalized, sizeof(Vertex),
        reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr)
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, p_W_m));
  attribute(1, 3, GL_BYTE, GL_TRUE, offsetof(Vertex, normal));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Vertex, colour));
}

Eigen::Matrix4d rigid(const Eigen::Matrix3d& R, const Eigen::Vector3d& p_m) {
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  transform.topLeftCorner<3, 3>() = R;
  transform.topRightCorner<3, 1>() = p_m;
  return transform;
}

}  // namespace

Renderer::Renderer(const Scene& scene)
    : tiles_{scene.tiles},
      has_flat_ground_{scene.has_flat_ground},
      background_program_{linked(kBackgroundVertex, kBackgroundFragment)},
      solid_program_{linked(kSolidVertex, kSolidFragment)} {
  upload(scene.vertices, scene_array_, scene_buffer_);
  const std::vector<Vertex> box = box_of(Eigen::Vector3d::Ones());
  box_vertices_ = static_cast<int>(box.size());
  upload(box, box_array_, box_buffer_);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // rows go down the picture, and up OpenGL's window
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

Renderer::~Renderer() {
  for (const auto& [size, target] : targets_) {
    glDeleteFramebuffers(1, &target.framebuffer);
    glDeleteRenderbuffers(1, &target.colour);
    glDeleteRenderbuffers(1, &target.depth);
  }
  glDeleteVertexArrays(1, &scene_array_);
  glDeleteVertexArrays(1, &box_array_);
  glDeleteBuffers(1, &scene_buffer_);
  glDeleteBuffers(1, &box_buffer_);
  glDeleteProgram(background_program_);
  glDeleteProgram(solid_program_);
}

const Renderer::Target& Renderer::target_of(const Pinhole& camera) {
  const auto [found, is_new] = targets_.try_emplace({camera.width_px, camera.height_px});
  Target& target = found->second;
  if (is_new) {
    const auto width = static_cast<GLsizei>(camera.width_px);
    const auto height = static_cast<GLsizei>(camera.height_px);
    glGenFramebuffers(1, &target.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    const auto attach = [&](GLuint& buffer, GLenum format, GLenum place) {
      glGenRenderbuffers(1, &buffer);
      glBindRenderbuffer(GL_RENDERBUFFER, buffer);
      glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
      glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
    };
    attach(target.colour, GL_RGBA8, GL_COLOR_ATTACHMENT0);
    attach(target.depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw std::runtime_error{"OpenGL cannot draw pictures of " + std::to_string(width) + " x " +
                               std::to_string(height) + " pixels"};
    }
  }
  return target;
}

void Renderer::draw(const Pinhole& camera, const CameraPose& pose, std::span<const Body> bodies,
                    std::span<std::byte> rgb) {
  assert(rgb.size() == std::size_t{3} * camera.width_px * camera.height_px);
  const auto width = static_cast<GLsizei>(camera.width_px);
  const auto height = static_cast<GLsizei>(camera.height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, target_of(camera).framebuffer);
  glViewport(0, 0, width, height);
  draw_background(camera, pose);
  const Eigen::Matrix4d clip_from_world =
      camera.clip_from_camera(kNear_m) *
      rigid(pose.R_WC.transpose(), -pose.R_WC.transpose() * pose.p_WC_m);
  glDepthFunc(GL_GREATER);
  glUseProgram(solid_program_);
  draw_scene(clip_from_world);
  glBindVertexArray(box_array_);
  for (const Body& body : bodies) {
    draw_body(body, clip_from_world);
  }
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
}

void Renderer::draw_background(const Pinhole& camera, const CameraPose& pose) {
  glUseProgram(background_program_);
  const double pixel_m = 1.0 / camera.focal_px();
  const Eigen::Vector3d half{camera.width_px * pixel_m / 2.0, camera.height_px * pixel_m / 2.0,
                             1.0};
  set(background_program_, "ray_of_window", Eigen::Matrix3d{pose.R_WC * half.asDiagonal()});
  const Eigen::Vector3f eye = pose.p_WC_m.cast<float>();
  glUniform3fv(glGetUniformLocation(background_program_, "eye"), 1, eye.data());
  set(background_program_, "near", kNear_m);
  set(background_program_, "pixel", pixel_m);
  glUniform1i(glGetUniformLocation(background_program_, "has_plane"), has_flat_ground_ ? 1 : 0);
  glDepthFunc(GL_ALWAYS);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(scene_array_);  // any: the corners are made in the shader
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_CULL_FACE);
}

void Renderer::draw_scene(const Eigen::Matrix4d& clip_from_world) {
  set(solid_program_, "clip_from_model", clip_from_world);
  set(solid_program_, "world_from_model", Eigen::Matrix3d{Eigen::Matrix3d::Identity()});
  glBindVertexArray(scene_array_);
  for (const Tile& tile : tiles_) {
    if (may_be_seen(tile, clip_from_world)) {
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(tile.first_vertex),
                   static_cast<GLsizei>(tile.vertices));
    }
  }
}

void Renderer::draw_body(const Body& body, const Eigen::Matrix4d& clip_from_world) {
  const Eigen::Matrix3d R_WB = body.q_WB.toRotationMatrix();
  set(solid_program_, "clip_from_model",
      Eigen::Matrix4d{clip_from_world * rigid(R_WB * body.size_m.asDiagonal(), body.p_WB_m)});
  set(solid_program_, "world_from_model", R_WB);
  glDrawArrays(GL_TRIANGLES, 0, box_vertices_);
}

}  // namespace cuscus::camera
