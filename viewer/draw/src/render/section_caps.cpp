// SPDX-License-Identifier: BSD-3-Clause
// The hatched cut faces of a section, found with the stencil buffer.
#include <cmath>

#include "mesh/scene_meshes.h"
#include "render/passes.h"
#include "render/view.h"

namespace vps::viewer {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// Whether the section passes through the part's box.
bool meetsPlane(const DrawnBody& body, const View& view) {
  bool is_near_side = false, is_far_side = false;
  for (const Vec3& corner_P : corners(body.mesh->bounds_P)) {
    const Vec3 p_C = body.X_CP * (corner_P - body.mesh->shading.center);
    (view.cut_C.head<3>().cast<double>().dot(p_C) > view.cut_C.w() ? is_near_side : is_far_side) = true;
  }
  return is_near_side && is_far_side;
}

/// A square in the section's plane, large enough for everything. The axes of the square are fixed in the
/// plane, so that the hatch does not move with the camera.
void setPlane(const gl::Program& program, const View& view) {
  const Vec3 n = view.cut_C.head<3>().cast<double>();
  const Vec3 up = view.up_C.cast<double>();
  const Vec3 y = std::abs(n.dot(up)) < 0.9 ? Vec3(up - n.dot(up) * n).normalized() : n.unitOrthogonal();
  const Vec3 origin = view.center_C + (view.cut_C.w() - n.dot(view.center_C)) * n;
  program.set("projection", view.projection);
  program.set("origin_C", Vector3f(origin.cast<float>()));
  program.set("x_C", Vector3f(y.cross(n).cast<float>()));
  program.set("y_C", Vector3f(y.cast<float>()));
  program.set("half_size_m", static_cast<float>(2 * view.radius_m));
}

/// Sets the stencil where the plane passes through the solid. Along a pixel's ray behind the plane, the
/// number of back faces minus front faces is 1 if the ray starts inside the solid.
void markInside(const DrawnBody& body, const Picture& picture) {
  glClear(GL_STENCIL_BUFFER_BIT);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glStencilFunc(GL_ALWAYS, 0, 0xFF);
  glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_INCR_WRAP);
  glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_DECR_WRAP);
  drawMeshes(picture.gl.programs.depth, {body}, picture.view, picture.view.projection, false);
  glDisable(GL_DEPTH_CLAMP);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glStencilFunc(GL_NOTEQUAL, 0, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void setScissor(const PixelRect& rect) {
  glScissor(rect.x, rect.y, rect.width, rect.height);
}

}  // namespace

void drawCaps(const gl::Program& program, const Picture& picture) {
  const View& view = picture.view;
  if (!view.has_caps) return;
  setPlane(program, view);
  // Stencil and caps cost time per pixel, so each part gets a scissor of its own within the pass's scissor.
  GLint pass[4], viewport[4];
  glGetIntegerv(GL_SCISSOR_BOX, pass);
  glGetIntegerv(GL_VIEWPORT, viewport);
  const bool had_scissor = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
  PixelRect within = {0, 0, viewport[2], viewport[3]};
  if (had_scissor) within = intersection(within, {pass[0], pass[1], pass[2], pass[3]});
  glEnable(GL_STENCIL_TEST);
  glEnable(GL_SCISSOR_TEST);
  for (const DrawnBody& body : picture.bodies) {
    if (!body.is_cut || !meetsPlane(body, view)) continue;
    const PixelRect screen = intersection(within, boxOnScreen(body, view, viewport[2], viewport[3], 1));
    if (screen.isEmpty()) continue;
    setScissor(screen);
    markInside(body, picture);
    program.set("color", body.color);
    program.set("hatch", Vector2f(std::sqrt(0.5f), body.part % 2 == 0 ? std::sqrt(0.5f) : -std::sqrt(0.5f)));
    program.set("hatch_step_m", static_cast<float>(0.035 * view.detail_m * (1 + 0.25 * (body.part % 3))));
    picture.gl.drawSquare(program);
  }
  if (had_scissor)
    setScissor({pass[0], pass[1], pass[2], pass[3]});
  else
    glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
}

}  // namespace vps::viewer
