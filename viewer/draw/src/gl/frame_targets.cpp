// SPDX-License-Identifier: BSD-3-Clause
#include "gl/frame_targets.h"

#include <algorithm>

namespace vps::viewer {
namespace {

gl::Framebuffer targetOf(const gl::Texture& texture, const char* what,
                         const gl::Renderbuffer* depth = nullptr) {
  gl::Framebuffer target = gl::makeFramebuffer();
  glNamedFramebufferTexture(target.id(), GL_COLOR_ATTACHMENT0, texture.id(), 0);
  if (depth != nullptr)
    glNamedFramebufferRenderbuffer(target.id(), GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth->id());
  gl::requireComplete(target, what);
  return target;
}

/// llvmpipe has 4 samples, GPUs 8 and more; more than 4 do not improve a supersampled picture visibly.
int usableSamples() {
  GLint color = 0, depth = 0;
  glGetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &color);
  glGetInternalformativ(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, GL_SAMPLES, 1, &depth);
  return std::clamp(std::min(color, depth), 1, 4);
}

}  // namespace

FrameTargets::FrameTargets(int width, int height, int factor, bool is_draft)
    : width(width), height(height), factor(factor), samples(usableSamples()) {
  const int lit_width = is_draft ? 1 : width, lit_height = is_draft ? 1 : height;
  geometry = gl::makeTexture(GL_RGBA32F, lit_width, lit_height, GL_NEAREST);
  geometry_depth = gl::makeRenderbuffer(GL_DEPTH24_STENCIL8, lit_width, lit_height, 0);
  geometry_target = targetOf(geometry, "normals", &geometry_depth);
  occlusion_raw = gl::makeTexture(GL_RG8, lit_width, lit_height, GL_NEAREST);
  occlusion_raw_target = targetOf(occlusion_raw, "occlusion", &geometry_depth);
  // Without supersampling each pixel has a texel of its own.
  occlusion = gl::makeTexture(GL_RG8, lit_width, lit_height, factor > 1 ? GL_LINEAR : GL_NEAREST);
  occlusion_target = targetOf(occlusion, "blurred occlusion", &geometry_depth);

  const int w = width * factor, h = height * factor;
  behind = gl::makeTexture(GL_RGBA16F, width, height, GL_NEAREST);
  behind_target = targetOf(behind, "background");
  color = gl::makeMultisampleTexture(GL_RGBA16F, w, h, samples);
  depth = gl::makeRenderbuffer(GL_DEPTH24_STENCIL8, w, h, samples);
  color_target = targetOf(color, "colour", &depth);
  shown = gl::makeRenderbuffer(GL_RGBA8, width, height, 0);
  shown_target = gl::makeFramebuffer();
  glNamedFramebufferRenderbuffer(shown_target.id(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, shown.id());
  gl::requireComplete(shown_target, "the finished picture");
}

ShadowTargets::ShadowTargets() {
  key = gl::makeTexture(GL_DEPTH_COMPONENT32F, kKeySize, kKeySize, GL_LINEAR);
  glTextureParameteri(key.id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(key.id(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  key_target = gl::makeFramebuffer();
  glNamedFramebufferTexture(key_target.id(), GL_DEPTH_ATTACHMENT, key.id(), 0);
  glNamedFramebufferDrawBuffer(key_target.id(), GL_NONE);
  gl::requireComplete(key_target, "shadows");

  floor_a = gl::makeTexture(GL_RG16F, kFloorSize, kFloorSize, GL_LINEAR);
  floor_b = gl::makeTexture(GL_RG16F, kFloorSize, kFloorSize, GL_LINEAR);
  floor_depth = gl::makeRenderbuffer(GL_DEPTH24_STENCIL8, kFloorSize, kFloorSize, 0);
  floor_a_target = targetOf(floor_a, "the floor", &floor_depth);
  floor_b_target = targetOf(floor_b, "the blurred floor");
}

}  // namespace vps::viewer
