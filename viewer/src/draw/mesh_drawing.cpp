// SPDX-License-Identifier: BSD-3-Clause
#include "draw/passes.h"

namespace vps::viewer::inline v0 {

void drawMeshes(const gl::Program& program, const std::vector<DrawnBody>& bodies, const View& view,
                const Eigen::Matrix4f& projection, bool is_shaded) {
  program.use();
  program.set("projection", projection);
  glEnable(GL_CLIP_DISTANCE0);
  for (const DrawnBody& body : bodies) {
    program.set("X_CP", toMatrix(body.X_CP));
    program.set("cut_C", body.is_cut ? view.cut_C : kNoCut);
    if (is_shaded) program.set("color", body.color);
    body.mesh->draw(body.is_coarse);
  }
  glDisable(GL_CLIP_DISTANCE0);
}

}  // namespace vps::viewer::inline v0
