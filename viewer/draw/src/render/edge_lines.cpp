// SPDX-License-Identifier: BSD-3-Clause
// Sharp edges, outlines and the lines of a section.
#include <algorithm>

#include "render/passes.h"

namespace vps::viewer {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

void drawSectionLines(const Picture& picture) {
  const View& view = picture.view;
  for (const DrawnBody& body : picture.bodies) {
    if (!body.is_cut) continue;
    const Vec3 n_C = view.cut_C.head<3>().cast<double>();
    // The section in the mesh's own frame; the plane must not clip the lines that lie in it.
    const Vec3 n_P = body.X_CP.R.transpose() * n_C;
    const double offset = view.cut_C.w() - n_C.dot(body.X_CP.p) + n_P.dot(body.mesh->shading.center);
    DrawnBody whole = body;
    whole.is_cut = false;
    drawLines(GpuLines(sectionSegments(body.mesh->shading, n_P, offset)), whole, picture, 1.7f,
              {0.01f, 0.01f, 0.012f, 1});
  }
}

}  // namespace

void drawLines(const GpuLines& lines, const DrawnBody& body, const Picture& picture, float width_px,
               const Eigen::Vector4f& color) {
  if (lines.count == 0) return;
  const View& view = picture.view;
  const FrameTargets& frame = *picture.gl.frame;
  const gl::Program& program = picture.gl.programs.line;
  program.use();
  const auto factor = static_cast<float>(frame.factor);
  program.set("projection", view.projection);
  program.set("X_CP", toMatrix(body.X_CP));
  program.set("cut_C", body.is_cut ? view.cut_C : kNoCut);
  program.set("picture_px", Vector2f(frame.width * factor, frame.height * factor));
  program.set("width_px", width_px * factor * std::clamp(frame.height / 960.0f, 0.6f, 3.0f));
  program.set("pull",
              static_cast<float>(0.004 * view.detail_m / std::max(view.detail_m, -view.center_C.z())));
  program.set("near_m", view.near_m);
  program.set("color", color);
  glBindVertexArray(lines.array.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, lines.count);
}

void drawEdges(const Picture& picture) {
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_BLEND);
  for (const DrawnBody& body : picture.bodies) {
    if (body.mesh->isCoarser(body.detail))
      continue;  // the edges of the full mesh do not lie on the coarser triangles
    const Vector3f ink = 0.10f * body.color + Vector3f::Constant(0.004f);
    const Vec3 p_eye = -(body.X_CP.R.transpose() * body.X_CP.p);
    std::vector<ShadingEdge> rim;
    if (!picture.options.is_draft) rim = outline(body.mesh->shading, p_eye);
    drawLines(body.mesh->sharp_edges, body, picture, 1.25f, {ink.x(), ink.y(), ink.z(), 0.85f});
    drawLines(GpuLines(rim), body, picture, 1.25f, {ink.x(), ink.y(), ink.z(), 0.85f});
  }
  glDisable(GL_CLIP_DISTANCE0);
  if (picture.view.has_caps) drawSectionLines(picture);
  glDisable(GL_BLEND);
}

}  // namespace vps::viewer
