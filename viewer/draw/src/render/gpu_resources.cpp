// SPDX-License-Identifier: BSD-3-Clause
#include "render/gpu_resources.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace vps::viewer {

namespace {

std::string finalFragment(int factor, int samples, bool has_parts) {
  return "const int factor = " + std::to_string(factor) + ", samples = " + std::to_string(samples) +
         ";\nconst bool has_parts = " + (has_parts ? "true" : "false") + ";\n" + glsl::kFinalFragment;
}

}  // namespace

std::string FloorBlur::constants() {
  std::vector<std::array<double, 2>> weights;
  std::array<double, 2> sum = {0, 0};
  for (int i = -kReach_texel; i <= kReach_texel; ++i) {
    std::array<double, 2>& weight = weights.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      const double sigma = k == 0 ? kNarrow : kWide;
      weight[k] = std::exp(-0.5 * i * i / (sigma * sigma));
      sum[k] += weight[k];
    }
  }
  std::string list;
  for (const std::array<double, 2>& weight : weights) {
    char text[64];
    std::snprintf(text, sizeof text, "%svec2(%.9e, %.9e)", list.empty() ? "" : ", ", weight[0] / sum[0],
                  weight[1] / sum[1]);
    list += text;
  }
  return "const int kReach = " + std::to_string(kReach_texel) +
         ";\nconst vec2 kWeights[2 * kReach + 1] = vec2[](" + list + ");\n";
}

GpuResources::GpuResources()
    : final_background_("final background", glsl::kFullScreenVertex, finalFragment(1, 1, false)) {
  const std::array<float, 8> corners = {-1, -1, 1, -1, -1, 1, 1, 1};
  quad_corners = gl::makeBuffer(std::span<const float>(corners));
  gl::addAttribute(quad, quad_corners, 0, 2, 0, 2 * sizeof(float));
}

bool GpuResources::resizeFrame(int width, int height, int factor, bool is_draft) {
  std::unique_ptr<FrameTargets>& owner = is_draft ? draft_ : full_;
  frame = owner.get();
  if (frame != nullptr && frame->width == width && frame->height == height && frame->factor == factor)
    return false;
  owner.reset();  // free the old targets first, so that two sizes are never in memory at once
  owner = std::make_unique<FrameTargets>(width, height, factor, is_draft);
  frame = owner.get();
  if (!final_.contains(factor))
    final_.try_emplace(factor, "final", glsl::kFullScreenVertex, finalFragment(factor, frame->samples, true));
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

}  // namespace vps::viewer
