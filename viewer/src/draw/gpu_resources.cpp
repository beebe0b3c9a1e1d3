// SPDX-License-Identifier: BSD-3-Clause
#include "draw/gpu_resources.h"

#include <array>

namespace vps::viewer::inline v0 {

GpuResources::GpuResources() {
  const std::array<float, 8> corners = {-1, -1, 1, -1, -1, 1, 1, 1};
  quad_corners = gl::makeBuffer(std::span<const float>(corners));
  gl::addAttribute(quad, quad_corners, 0, 2, 0, 2 * sizeof(float));
}

bool GpuResources::resizeFrame(int width, int height, int factor, bool is_draft) {
  std::unique_ptr<FrameTargets>& owner = is_draft ? draft_ : full_;
  frame = owner.get();
  if (frame != nullptr && frame->width == width && frame->height == height && frame->factor == factor)
    return false;
  owner.reset();  // first, so that two sizes are never in memory at once
  owner = std::make_unique<FrameTargets>(width, height, factor, is_draft);
  frame = owner.get();
  if (!final_.contains(factor))
    final_.try_emplace(factor, "final", glsl::kFullScreenVertex,
                       "const int factor = " + std::to_string(factor) +
                           ", samples = " + std::to_string(frame->samples) + ";\n" + glsl::kFinalFragment);
  return true;
}

void GpuResources::drawFullScreen(const gl::Program& program) const {
  program.use();
  glBindVertexArray(empty.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GpuResources::drawSquare(const gl::Program& program) const {
  program.use();
  glBindVertexArray(quad.id());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace vps::viewer::inline v0
