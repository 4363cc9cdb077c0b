#pragma once

// What runs once per corner and per pixel. Heights, checks and light are the same for the ground of
// a terrain and for the plane, which is a part of the background.
namespace cuscus::camera {

/// Light of a surface, and checks of 1 m and 8 m that fade where they are finer than a pixel.
inline constexpr const char* kShading = R"(
const vec3 kSun = vec3(0.6413, 0.2605, 0.7217);  // of length 1; no two walls at a right angle alike
float light(vec3 normal) { return 0.7 + 0.3 * dot(normal, kSun); }
float check(vec2 p, float side, float pixel) {
  vec2 cell = floor(p / side);
  float sign = mod(cell.x + cell.y, 2.0) * 2.0 - 1.0;
  return sign * clamp(1.0 - pixel / side, 0.0, 1.0);
}
vec3 ground(vec2 p, float pixel) {
  float checks = 0.07 * check(p, 1.0, pixel) + 0.07 * check(p, 8.0, pixel);
  return vec3(0.525, 0.502, 0.424) * (1.0 + checks);
}
)";

/// A triangle over the whole picture.
inline constexpr const char* kBackgroundVertex = R"(
uniform mat3 ray_of_window;  // ray ahead by 1 m, in the world
out vec3 ray;
void main() {
  vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  ray = ray_of_window * vec3(at, 1.0);
  gl_Position = vec4(at, 0.0, 1.0);
}
)";

/// The sky above the horizon; below it the plane z = 0 with its depth, or ground far away.
inline constexpr const char* kBackgroundFragment = R"(
uniform vec3 eye;       // the camera's place [m]
uniform float near;
uniform float pixel;    // of a pixel, 1 m ahead [m]
uniform bool has_plane;
in vec3 ray;
layout(location = 0) out vec4 colour;
void main() {
  gl_FragDepth = 0.0;
  float climb = ray.z / length(ray);
  if (ray.z >= 0.0) {
    colour = vec4(mix(vec3(0.78, 0.87, 0.96), vec3(0.29, 0.53, 0.85), sqrt(climb)), 1.0);
    return;
  }
  float far_grey = light(vec3(0.0, 0.0, 1.0));
  if (!has_plane || eye.z <= 0.0) {
    colour = vec4(vec3(0.525, 0.502, 0.424) * far_grey, 1.0);
    return;
  }
  float ahead = -eye.z / ray.z;
  vec2 at = eye.xy + ahead * ray.xy;
  colour = vec4(ground(at, pixel * ahead / max(-climb, 1e-6)) * far_grey, 1.0);
  gl_FragDepth = clamp(near / ahead, 0.0, 1.0);
}
)";

inline constexpr const char* kSolidVertex = R"(
uniform mat4 clip_from_model;
uniform mat3 world_from_model;
layout(location = 0) in vec3 p;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 paint;
out vec3 world;
out vec4 tint;
void main() {
  gl_Position = clip_from_model * vec4(p, 1.0);
  world = p;
  tint = vec4(paint.rgb * light(normalize(world_from_model * normal)), paint.a);
}
)";

inline constexpr const char* kSolidFragment = R"(
in vec3 world;
in vec4 tint;
layout(location = 0) out vec4 colour;
void main() {
  if (tint.a < 0.5) {
    colour = vec4(tint.rgb, 1.0);
    return;
  }
  float grain = max(length(dFdx(world)), length(dFdy(world)));
  colour = vec4(tint.rgb * ground(world.xy, grain) / vec3(0.525, 0.502, 0.424), 1.0);
}
)";

}  // namespace cuscus::camera
