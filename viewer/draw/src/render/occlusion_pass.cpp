// SPDX-License-Identifier: BSD-3-Clause
// Ambient occlusion in screen space, from the normal and depth of the visible surface.
#include <array>
#include <cstdint>

#include "render/passes.h"

namespace vps::viewer {

void renderGeometry(const Picture& picture) {
  const FrameTargets& frame = *picture.gl.frame;
  glBindFramebuffer(GL_FRAMEBUFFER, frame.geometry_target.id());
  glViewport(0, 0, frame.width, frame.height);
  glClearColor(0, 0, 0, -1e9f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  drawMeshes(picture.gl.programs.geometry, picture.bodies, picture.view, picture.view.projection, false);
  drawCaps(picture.gl.programs.cap_geometry, picture);
}

namespace {

/// Runs the program only on pixels that a part covers, by the depth test; all light reaches the background.
void drawOnParts(const gl::Framebuffer& target, const gl::Program& program, const GpuResources& gl) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.id());
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  gl.drawFullScreen(program);
}

}  // namespace

void renderOcclusion(const Picture& picture) {
  const View& view = picture.view;
  const FrameTargets& frame = *picture.gl.frame;
  // On llvmpipe a pixel of the background costs as much as a pixel of a part, unless the depth test rejects
  // it.
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  const auto radius_m = static_cast<float>(0.16 * view.detail_m);
  glBindTextureUnit(0, frame.geometry.id());
  const gl::Program& occlusion = picture.gl.programs.occlusion;
  occlusion.set("geometry", 0);
  occlusion.set("half_view", view.half_view);
  occlusion.set("view_shift", view.shift);
  occlusion.set("radius_m", radius_m);
  glBindTextureUnit(1, picture.gl.shadows.key.id());
  occlusion.set("shadow_map", 1);
  occlusion.set("shadow_from_C", view.shadow_from_C);
  occlusion.set("shadow_offset_m", static_cast<float>(0.006 * view.radius_m));
  drawOnParts(frame.occlusion_raw_target, occlusion, picture.gl);
  glBindTextureUnit(1, frame.occlusion_raw.id());
  const gl::Program& blur = picture.gl.programs.occlusion_blur;
  blur.set("geometry", 0);
  blur.set("occlusion", 1);
  blur.set("radius_m", radius_m);
  drawOnParts(frame.occlusion_target, blur, picture.gl);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

void lightEverything(const Picture& picture) {
  const std::array<std::uint8_t, 2> all = {255, 255};
  glClearTexImage(picture.gl.frame->occlusion.id(), 0, GL_RG, GL_UNSIGNED_BYTE, all.data());
}

}  // namespace vps::viewer
