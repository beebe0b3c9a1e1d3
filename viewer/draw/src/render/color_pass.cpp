// SPDX-License-Identifier: BSD-3-Clause
// The colour image: parts, cut faces, edges, marks, and the part's target, over the background.
#include <algorithm>
#include <optional>

#include "render/passes.h"

namespace vps::viewer {
namespace {

using Eigen::Vector2f;
using Eigen::Vector4f;

/// The uniforms of kStudio in shaders.h.
void setStudio(const gl::Program& program, const Picture& picture) {
  const FrameTargets& frame = *picture.gl.frame;
  glBindTextureUnit(0, frame.occlusion.id());
  program.set("light_reaching", 0);
  program.set("up_C", picture.view.up_C);
  program.set("picture_px", Vector2f(static_cast<float>(frame.width * frame.factor),
                                     static_cast<float>(frame.height * frame.factor)));
}

void drawGhostEdges(const DrawnBody& ghost, const Picture& picture) {
  glEnable(GL_CLIP_DISTANCE0);
  const Vec3 p_eye = -(ghost.X_CP.R.transpose() * ghost.X_CP.p);
  std::vector<ShadingEdge> rim;
  if (!picture.options.is_draft) rim = outline(ghost.mesh->shading, p_eye);
  const Vector4f ink(0.2f * ghost.color.x(), 0.35f * ghost.color.y(), 0.6f * ghost.color.z(), 0.55f);
  drawLines(ghost.mesh->sharp_edges, ghost, picture, 1.1f, ink);
  drawLines(GpuLines(rim), ghost, picture, 1.1f, ink);
  // Edges of the target are faint behind other parts.
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  drawLines(ghost.mesh->sharp_edges, ghost, picture, 1.0f, {ink.x(), ink.y(), ink.z(), 0.16f});
  drawLines(GpuLines(rim), ghost, picture, 1.0f, {ink.x(), ink.y(), ink.z(), 0.16f});
  glDepthMask(GL_TRUE);
  glDisable(GL_CLIP_DISTANCE0);
}

void drawGhost(const DrawnBody& ghost, const Picture& picture) {
  // Only the nearest surface of the target is drawn, because the opacities of front and back would add up.
  // The surface is pushed back a little, so that a part that coincides with its target is visible.
  const View& view = picture.view;
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 8);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  drawMeshes(picture.gl.programs.depth, {ghost}, view, view.projection, false);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glDepthFunc(GL_LEQUAL);
  drawMeshes(picture.gl.programs.ghost, {ghost}, view, view.projection, true);
  glDisable(GL_POLYGON_OFFSET_FILL);
  if (picture.options.show_edges) drawGhostEdges(ghost, picture);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
}

void drawMarks(const MarkList& marks, const Picture& picture) {
  const View& view = picture.view;
  const gl::Program& program = picture.gl.programs.mark;
  program.use();
  program.set("projection", view.projection);
  program.set("pull", static_cast<float>(0.01 * view.detail_m / std::max(view.detail_m, -view.center_C.z())));
  if (picture.options.show_hidden_marks) {
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GREATER);
    program.set("alpha", 0.28f);
    picture.gl.arrow.draw(marks.arrows);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
  }
  program.set("alpha", 1.0f);
  picture.gl.disc.draw(marks.discs);
  picture.gl.arrow.draw(marks.arrows);
}

}  // namespace

void renderBehind(const Picture& picture) {
  const FrameTargets& frame = *picture.gl.frame;
  glBindFramebuffer(GL_FRAMEBUFFER, frame.behind_target.id());
  glViewport(0, 0, frame.width, frame.height);
  glDisable(GL_DEPTH_TEST);
  const gl::Program& background = picture.gl.programs.background;
  background.use();
  background.set("darkness", picture.options.is_dark ? 1.0f : 0.0f);
  picture.gl.drawFullScreen(background);
  if (picture.options.show_ground && !picture.options.is_draft) drawFloorShadow(picture);
  glEnable(GL_DEPTH_TEST);
}

void renderColor(const Picture& picture, const MarkList& marks, const DrawnBody* target) {
  const GpuResources& gl = picture.gl;
  const FrameTargets& frame = *gl.frame;
  glBindFramebuffer(GL_FRAMEBUFFER, frame.color_target.id());
  glViewport(0, 0, frame.width * frame.factor, frame.height * frame.factor);
  glEnable(GL_SCISSOR_TEST);
  const PixelRect region = scaled(picture.parts, frame.factor);
  glScissor(region.x, region.y, region.width, region.height);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  setStudio(gl.programs.mesh, picture);
  drawMeshes(gl.programs.mesh, picture.bodies, picture.view, picture.view.projection, true);
  setStudio(gl.programs.cap, picture);
  drawCaps(gl.programs.cap, picture);
  if (picture.options.show_edges) drawEdges(picture);
  drawMarks(marks, picture);
  if (target != nullptr) drawGhost(*target, picture);
  glDisable(GL_SCISSOR_TEST);
}

namespace {

void readBack(const PixelRect& rect, Image& image) {
  std::vector<std::uint8_t> rgba(std::size_t(4) * rect.width * rect.height);
  glReadPixels(rect.x, rect.y, rect.width, rect.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (int y = 0; y < rect.height; ++y) {
    const std::uint8_t* from = &rgba[std::size_t(4) * rect.width * y];
    std::uint8_t* to = image.at(rect.x, image.height - 1 - rect.y - y);  // OpenGL's rows start at the bottom
    for (int x = 0; x < rect.width; ++x) std::copy_n(from + 4 * x, 3, to + 3 * x);
  }
}

}  // namespace

void resolvePicture(const Picture& picture, Image& image) {
  const GpuResources& gl = picture.gl;
  const FrameTargets& f = *gl.frame;
  const PixelRect& region = picture.region;
  glBindFramebuffer(GL_FRAMEBUFFER, f.shown_target.id());
  glViewport(0, 0, f.width, f.height);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  glBindTextureUnit(0, f.color.id());
  glBindTextureUnit(1, f.behind.id());
  const auto draw = [&](const PixelRect& rect, bool has_parts) {
    if (rect.isEmpty()) return;
    glScissor(rect.x, rect.y, rect.width, rect.height);
    const gl::Program& program = gl.finalProgram(has_parts);
    program.set("parts", 0);
    program.set("behind", 1);
    gl.drawFullScreen(program);
  };
  draw(picture.parts, true);
  if (picture.parts.isEmpty())
    draw(region, false);
  else
    for (const PixelRect& rect : around(region, picture.parts)) draw(rect, false);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  readBack(region, image);
}

void drawFlash(const GpuResources& gl, bool is_lit, Image& image) {
  const FrameTargets& frame = *gl.frame;
  const int size_px = flashSize_px(frame.height);
  const PixelRect square = intersection({0, 0, size_px, size_px}, {0, 0, frame.width, frame.height});
  const float light = is_lit ? 1.0f : 0.0f;
  glBindFramebuffer(GL_FRAMEBUFFER, frame.shown_target.id());
  glEnable(GL_SCISSOR_TEST);
  glScissor(square.x, square.y, square.width, square.height);
  glClearColor(light, light, light, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  readBack(square, image);
}

}  // namespace vps::viewer
