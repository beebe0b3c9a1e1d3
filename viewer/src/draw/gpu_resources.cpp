// SPDX-License-Identifier: BSD-3-Clause
#include "draw/gpu_resources.h"

#include <array>

namespace vps::viewer::inline v0 {

GpuResources::GpuResources() {
  const std::array<float, 8> corners = {-1, -1, 1, -1, -1, 1, 1, 1};
  quad_corners = gl::makeBuffer(std::span<const float>(corners));
  gl::addAttribute(quad, quad_corners, 0, 2, 0, 2 * sizeof(float));
}

void GpuResources::resizeFrame(int width, int height, int factor) {
  if (frame && frame->width == width && frame->height == height && frame->factor == factor) return;
  frame.reset();  // first, so that two sizes are never in memory at once
  frame = std::make_unique<FrameTargets>(width, height, factor);
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
