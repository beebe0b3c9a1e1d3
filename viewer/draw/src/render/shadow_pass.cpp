// SPDX-License-Identifier: BSD-3-Clause
// The key light's shadow, and the soft shadow on the invisible floor.
#include <cmath>
#include <tuple>

#include "render/passes.h"

namespace vps::viewer {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3f;

/// An axis in the floor, used both for rendering the floor's texture and for drawing it.
Vec3 floorAxis(const Vec3& up) {
  return std::abs(up.x()) < 0.8 ? Vec3(up.cross(Vec3::UnitX())).normalized()
                                : up.cross(Vec3::UnitY()).normalized();
}

}  // namespace

void renderKeyShadow(const Picture& picture) {
  const GpuResources& gl = picture.gl;
  glBindFramebuffer(GL_FRAMEBUFFER, gl.shadows.key_target.id());
  glViewport(0, 0, ShadowTargets::kKeySize, ShadowTargets::kKeySize);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 4);
  drawMeshes(gl.programs.depth, picture.bodies, picture.view, picture.view.shadow_projection, false,
             Detail::Shadow);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void renderFloorShadow(const Picture& picture) {
  // The camera looks up from below the floor, so that the nearest part wins the depth test.
  const View& view = picture.view;
  const double half_m = ShadowTargets::kFloorRadii * view.radius_m;
  const Vec3 up = view.up_C.cast<double>();
  const ShadowTargets& shadows = picture.gl.shadows;
  glViewport(0, 0, ShadowTargets::kFloorSize, ShadowTargets::kFloorSize);
  glBindFramebuffer(GL_FRAMEBUFFER, shadows.floor_a_target.id());
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const gl::Program& floor = picture.gl.programs.floor;
  floor.set("floor_C", Vector3f(view.floor_C.cast<float>()));
  floor.set("up_C", view.up_C);
  floor.set("size_m", static_cast<float>(2 * view.radius_m));
  drawMeshes(
      floor, picture.bodies, view, parallelProjection(view.floor_C, half_m, -up, floorAxis(up)), false,
      Detail::Draft);  // the shadow is blurred over a sixth of its width, so a draft's triangles suffice

  glDisable(GL_DEPTH_TEST);
  const gl::Program& blur = picture.gl.programs.floor_blur;
  // All parts lie within one radius of the centre, so no shadow lies farther out than the radius plus the
  // blur.
  constexpr int kHalf = FloorBlur::kRadius_texel + FloorBlur::kReach_texel + 1;
  static_assert(kHalf + FloorBlur::kReach_texel <= ShadowTargets::kFloorSize / 2);
  glBindFramebuffer(GL_FRAMEBUFFER, shadows.floor_b_target.id());
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_SCISSOR_TEST);
  glScissor(ShadowTargets::kFloorSize / 2 - kHalf, ShadowTargets::kFloorSize / 2 - kHalf, 2 * kHalf,
            2 * kHalf);
  for (const auto& [from, to, direction] :
       {std::tuple(&shadows.floor_a, &shadows.floor_b_target, Vector2i(1, 0)),
        {&shadows.floor_b, &shadows.floor_a_target, Vector2i(0, 1)}}) {
    glBindFramebuffer(GL_FRAMEBUFFER, to->id());
    glBindTextureUnit(0, from->id());
    blur.set("source", 0);
    blur.set("direction", direction);
    picture.gl.drawFullScreen(blur);
  }
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
}

void drawFloorShadow(const Picture& picture) {
  const View& view = picture.view;
  const Vec3 up = view.up_C.cast<double>();
  if (up.dot(view.floor_C) >= 0) return;  // the eye, at the origin, is under the floor
  // The axes of renderFloorShadow(): with back = -up and its up = x, parallelProjection() spans the axes
  // x cross -up and x.
  const Vec3 x = floorAxis(up);
  const gl::Program& program = picture.gl.programs.floor_shadow;
  program.set("projection", view.projection);
  program.set("origin_C", Vector3f(view.floor_C.cast<float>()));
  program.set("x_C", Vector3f(x.cross(-up).normalized().cast<float>()));
  program.set("y_C", Vector3f(x.cast<float>()));
  program.set("half_size_m", static_cast<float>(ShadowTargets::kFloorRadii * view.radius_m));
  glBindTextureUnit(0, picture.gl.shadows.floor_a.id());
  program.set("floor_shadow", 0);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  picture.gl.drawSquare(program);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace vps::viewer
