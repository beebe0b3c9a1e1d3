// SPDX-License-Identifier: BSD-3-Clause
#include "render/passes.h"

#include <algorithm>

namespace vps::viewer {

namespace {

/// Whether only front faces of the part can be visible: the part is closed, not cut, and the eye (the origin)
/// is outside it.
bool showsFrontOnly(const DrawnBody& body, const View& view) {
  const double reach_m = 0.5 * body.mesh->bounds_P.size().norm() + view.near_m;
  return body.mesh->shading.is_closed && !body.is_cut && body.X_CP.p.norm() > reach_m;
}

/// Least distance of the part from the eye along the line of sight.
double nearest_m(const DrawnBody& body, const View& view) {
  return std::max<double>(view.near_m, -body.X_CP.p.z() - 0.5 * body.mesh->bounds_P.size().norm());
}

}  // namespace

void drawMeshes(const gl::Program& program, const std::vector<DrawnBody>& bodies, const View& view,
                const Eigen::Matrix4f& projection, bool is_shaded, std::optional<Detail> detail) {
  program.use();
  program.set("projection", projection);
  for (const DrawnBody& body : bodies) {
    // Clipping and back faces cost as much as visible faces, so both are switched off where they are not
    // needed.
    if (body.is_cut) glEnable(GL_CLIP_DISTANCE0);
    if (showsFrontOnly(body, view)) glEnable(GL_CULL_FACE);
    program.set("X_CP", toMatrix(body.X_CP));
    program.set("cut_C", body.is_cut ? view.cut_C : kNoCut);
    if (is_shaded) program.set("color", body.shows_faces ? Eigen::Vector3f::Ones().eval() : body.color);
    if (is_shaded) program.set("tint_share", body.mesh->has_face_colors && !body.shows_faces ? 0.0f : 1.0f);
    if (detail || body.detail != Detail::Full || body.is_cut)
      body.mesh->draw(detail.value_or(body.detail));
    else
      body.mesh->drawAt(view.px_m / nearest_m(body, view));
    glDisable(GL_CULL_FACE);
    glDisable(GL_CLIP_DISTANCE0);
  }
}

}  // namespace vps::viewer
