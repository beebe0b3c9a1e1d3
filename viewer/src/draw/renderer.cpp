// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/renderer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "draw/egl_context.h"
#include "draw/frame_targets.h"
#include "draw/marks.h"
#include "draw/overlay.h"
#include "draw/scene_buffers.h"
#include "draw/shaders.h"

namespace vps::viewer {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

const Vector3f kHandColor(0.028f, 0.21f, 0.74f);  // blue: the warm depth colours of contacts stand out on it
const Vector4f kNoCut(0, 0, 0, 1);

/// Everything that stays the same during one picture.
struct View {
  Pose X_CW;
  Matrix4f projection = Matrix4f::Identity();
  Vector2f half_view;  ///< tan of half the angles of view
  float near_m = 0;
  Vector3f up_C;
  Vec3 center_C;
  double radius_m = 1;  ///< of a sphere around all that is drawn
  double detail_m = 1;  ///< the same for what the picture shows of it, which is less in a close-up
  Vec3 floor_C;         ///< on the floor, under the centre
  Vector4f cut_C = kNoCut;
  bool has_caps = false;
  Matrix4f shadow_from_C = Matrix4f::Identity(), shadow_projection = Matrix4f::Identity();
};

Matrix4f perspective(const Vector2f& half_view, double near_m, double far_m) {
  Matrix4f m = Matrix4f::Zero();
  m(0, 0) = 1 / half_view.x();
  m(1, 1) = 1 / half_view.y();
  m(2, 2) = static_cast<float>(-(far_m + near_m) / (far_m - near_m));
  m(2, 3) = static_cast<float>(-2 * far_m * near_m / (far_m - near_m));
  m(3, 2) = -1;
  return m;
}

/// Parallel projection of a sphere, seen by a viewer far out on the unit vector back, to [-1, 1]^3.
Matrix4f parallel(const Vec3& center, double radius_m, const Vec3& back, const Vec3& up) {
  const Vec3 x = up.cross(back).normalized();
  Mat3 R;
  R << x, back.cross(x), back;
  Matrix4f m = Matrix4f::Identity();
  const Mat3 scaled = Vec3(1, 1, -1).asDiagonal() * R.transpose() / radius_m;
  m.topLeftCorner<3, 3>() = scaled.cast<float>();
  m.topRightCorner<3, 1>() = (-(scaled * center)).cast<float>();
  return m;
}

Matrix4f halfAndShift() {  // [-1, 1] to [0, 1], for lookups
  Matrix4f m = Matrix4f::Identity() * 0.5f;
  m.topRightCorner<3, 1>().setConstant(0.5f);
  m(3, 3) = 1;
  return m;
}

bool isDrawn(scenes::BodyRole role, bool show_waiting) {
  return show_waiting || role != scenes::BodyRole::Waiting;
}

Box movedBounds(const Box& box_P, const Pose& X_WP) {
  Box box_W;
  for (int i = 0; i < 8; ++i)
    box_W.add(X_WP * Vec3((i & 1) != 0 ? box_P.max.x() : box_P.min.x(),
                          (i & 2) != 0 ? box_P.max.y() : box_P.min.y(),
                          (i & 4) != 0 ? box_P.max.z() : box_P.min.z()));
  return box_W;
}

void grow(Box& box, const Box& other) {
  if (other.isEmpty()) return;
  box.add(other.min);
  box.add(other.max);
}

/// Calls visit(part, X_WP, role) for each part to draw; fixed parts need not be listed in the snapshot.
template <class Visit>
void forEachBody(std::size_t part_count, const std::vector<std::pair<bool, Pose>>& fixed,
                 const scenes::Snapshot& snapshot, bool show_waiting, Visit visit) {
  std::vector<bool> is_listed(part_count, false);
  for (const scenes::BodySnapshot& body : snapshot.bodies) {
    if (body.part >= part_count || !body.X_WP.isFinite()) continue;
    is_listed[body.part] = true;
    if (fixed[body.part].first || isDrawn(body.role, show_waiting)) visit(body.part, body.X_WP, body.role);
  }
  for (std::size_t i = 0; i < part_count; ++i)
    if (!is_listed[i] && fixed[i].first) visit(i, fixed[i].second, scenes::BodyRole::Mounted);
}

std::vector<std::pair<bool, Pose>> fixedPoses(const RenderScene& scene) {
  std::vector<std::pair<bool, Pose>> fixed;
  for (const DrawnMesh& m : scene) fixed.emplace_back(m.is_fixed, m.X_WP);
  return fixed;
}

/// Where a part lies in the viewport, and whether the cutting plane passes through it.
struct ScreenBox {
  GLint x, y;
  GLsizei width, height;
  bool meets_plane;
};

ScreenBox boxOnScreen(const Box& box_P, const DrawnBody& body, const View& view) {
  GLint viewport[4];
  glGetIntegerv(GL_VIEWPORT, viewport);
  ScreenBox whole = {0, 0, viewport[2], viewport[3], false};
  Eigen::Array2d low(1, 1), high(-1, -1);
  bool is_near_side = false, is_far_side = false, reaches_eye = false;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner_P((i & 1) != 0 ? box_P.max.x() : box_P.min.x(),
                        (i & 2) != 0 ? box_P.max.y() : box_P.min.y(),
                        (i & 4) != 0 ? box_P.max.z() : box_P.min.z());
    const Vec3 p_C = body.X_CP * (corner_P - body.mesh->shading.center);
    (view.cut_C.head<3>().cast<double>().dot(p_C) > view.cut_C.w() ? is_near_side : is_far_side) = true;
    if (p_C.z() > -view.near_m) {
      reaches_eye = true;
      continue;
    }
    const Eigen::Array2d ndc = p_C.head<2>().array() / (-p_C.z() * view.half_view.cast<double>().array());
    low = low.min(ndc);
    high = high.max(ndc);
  }
  whole.meets_plane = is_near_side && is_far_side;
  if (reaches_eye || !whole.meets_plane) return whole;
  low = low.max(-1.0);
  high = high.min(1.0);
  whole.x = static_cast<GLint>(std::floor(0.5 * (low.x() + 1) * viewport[2])) - 1;
  whole.y = static_cast<GLint>(std::floor(0.5 * (low.y() + 1) * viewport[3])) - 1;
  whole.width = std::max(0, static_cast<GLint>(std::ceil(0.5 * (high.x() + 1) * viewport[2])) + 1 - whole.x);
  whole.height = std::max(0, static_cast<GLint>(std::ceil(0.5 * (high.y() + 1) * viewport[3])) + 1 - whole.y);
  return whole;
}

struct Programs {
  gl::Program mesh{"mesh", glsl::kMeshVertex, std::string(glsl::kStudio) + glsl::kMeshFragment};
  gl::Program ghost{"ghost", glsl::kMeshVertex, glsl::kGhostFragment};
  gl::Program depth{"depth", glsl::kMeshVertex, glsl::kEmptyFragment};
  gl::Program geometry{"geometry", glsl::kMeshVertex, glsl::kGeometryFragment};
  gl::Program cap{"cap", glsl::kCapVertex, std::string(glsl::kStudio) + glsl::kCapFragment};
  gl::Program cap_geometry{"cap geometry", glsl::kCapVertex, glsl::kGeometryFragment};
  gl::Program occlusion{"occlusion", glsl::kFullScreenVertex, glsl::kOcclusionFragment};
  gl::Program occlusion_blur{"occlusion blur", glsl::kFullScreenVertex, glsl::kOcclusionBlurFragment};
  gl::Program floor{"floor", glsl::kMeshVertex, glsl::kFloorFragment};
  gl::Program floor_blur{"floor blur", glsl::kFullScreenVertex, glsl::kFloorBlurFragment};
  gl::Program floor_shadow{"floor shadow", glsl::kCapVertex, glsl::kFloorShadowFragment};
  gl::Program background{"background", glsl::kFullScreenVertex, glsl::kBackgroundFragment};
  gl::Program line{"line", glsl::kLineVertex, glsl::kFlatFragment};
  gl::Program mark{"mark", glsl::kMarkVertex, glsl::kMarkFragment};
  gl::Program final{"final", glsl::kFullScreenVertex, glsl::kFinalFragment};
};

}  // namespace

struct Renderer::Impl {
  EglContext context;
  // OpenGL objects, made and destroyed while the context is current.
  struct Resources {
    Programs programs;
    ShadowTargets shadows;
    std::unique_ptr<FrameTargets> frame;
    std::map<const Mesh*, std::unique_ptr<GpuMesh>> meshes;  // equal parts share
    MarkShape arrow = MarkShape::arrow(), disc = MarkShape::disc();
    gl::Buffer quad_corners;
    gl::VertexArray quad = gl::makeVertexArray(), empty = gl::makeVertexArray();
  };
  std::unique_ptr<Resources> gl;
  std::vector<const GpuMesh*> part_meshes;
  RenderScene scene;
  std::vector<std::pair<bool, Pose>> fixed;
  std::vector<Box> part_bounds;
  Lettering lettering;
  std::string description;

  explicit Impl(const RenderScene& parts);
  ~Impl() {
    const EglContext::Current current(context);
    gl.reset();
  }

  View makeView(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options) const;
  std::vector<DrawnBody> place(const scenes::Snapshot& snapshot, const View& view,
                               const DrawOptions& options) const;
  Box drawnBounds(const scenes::Snapshot& snapshot, bool show_waiting, bool show_target) const;

  // The passes, in order; each leaves depth test on and blending, clipping and stencil off.
  void drawKeyShadow(const std::vector<DrawnBody>& bodies, const View& view) const;
  void drawFloor(const std::vector<DrawnBody>& bodies, const View& view) const;
  void drawGeometry(const std::vector<DrawnBody>& bodies, const View& view) const;
  void drawOcclusion(const View& view) const;
  void drawColor(const std::vector<DrawnBody>& bodies, const scenes::Snapshot& snapshot, const View& view,
                 const DrawOptions& options) const;
  Image finish() const;

  void drawMeshes(const gl::Program& program, const std::vector<DrawnBody>& bodies, const View& view,
                  const Matrix4f& projection, bool is_shaded) const;
  void drawCaps(const gl::Program& program, const std::vector<DrawnBody>& bodies, const View& view) const;
  void drawFloorShadow(const View& view) const;
  void drawEdges(const std::vector<DrawnBody>& bodies, const View& view) const;
  void drawLines(const GpuLines& lines, const DrawnBody& body, const View& view, float width_px,
                 const Vector4f& color) const;
  void drawGhost(const DrawnBody& ghost, const View& view, const DrawOptions& options) const;
  void drawMarks(const scenes::Snapshot& snapshot, const View& view, const DrawOptions& options) const;
  void setStudio(const gl::Program& program, const View& view) const;
  void fullScreen(const gl::Program& program) const {
    program.use();
    glBindVertexArray(gl->empty.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  void quad(const gl::Program& program) const {
    program.use();
    glBindVertexArray(gl->quad.id());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
};

Renderer::Impl::Impl(const RenderScene& parts) : scene(parts), fixed(fixedPoses(parts)) {
  const EglContext::Current current(context);
  gl = std::make_unique<Resources>();
  const std::array<float, 8> corners = {-1, -1, 1, -1, -1, 1, 1, 1};
  gl->quad_corners = gl::makeBuffer(std::span<const float>(corners));
  gl::addAttribute(gl->quad, gl->quad_corners, 0, 2, 0, 2 * sizeof(float));
  for (DrawnMesh& part : scene) {
    std::unique_ptr<GpuMesh>& mesh = gl->meshes[part.mesh];
    if (!mesh) mesh = std::make_unique<GpuMesh>(*part.mesh);
    part_meshes.push_back(mesh.get());
    part_bounds.push_back(bounds(*part.mesh));
    part.mesh = nullptr;  // the caller may free it now
  }
  description = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", OpenGL " +
                reinterpret_cast<const char*>(glGetString(GL_VERSION));
}

Box Renderer::Impl::drawnBounds(const scenes::Snapshot& snapshot, bool show_waiting, bool show_target) const {
  Box box;
  forEachBody(scene.size(), fixed, snapshot, show_waiting,
              [&](std::size_t part, const Pose& X_WP, scenes::BodyRole) {
                grow(box, movedBounds(part_bounds[part], X_WP));
              });
  if (show_target && snapshot.has_target && snapshot.target_part < scene.size())
    grow(box, movedBounds(part_bounds[snapshot.target_part], snapshot.X_WP_target));
  if (box.isEmpty()) box = {Vec3::Constant(-1), Vec3::Constant(1)};
  return box;
}

View Renderer::Impl::makeView(const scenes::Snapshot& snapshot, const Camera& camera,
                              const DrawOptions& options) const {
  View view;
  view.X_CW = camera.pose().inverse();
  const Box box_W = drawnBounds(snapshot, options.show_waiting, options.show_target);
  view.center_C = view.X_CW * box_W.center();
  view.radius_m = std::max(1e-9, 0.5 * box_W.size().norm());
  // Marks stick out of the box by up to a third of its size.
  const double reach_m = 1.6 * view.radius_m, depth_m = -view.center_C.z();
  const double far_m = std::max(depth_m + reach_m, 1e-6);
  const double near_m = std::max(depth_m - reach_m, 1e-3 * far_m);
  view.near_m = static_cast<float>(near_m);
  const double tan_y = std::tan(0.5 * camera.fov_rad);
  view.detail_m = std::min(view.radius_m, 1.5 * tan_y * (camera.eye_W - camera.target_W).norm());
  view.half_view =
      Vector2f(static_cast<float>(tan_y * options.width / options.height), static_cast<float>(tan_y));
  // The floor reaches beyond the box: its far side may pass the far plane of the box, so leave room.
  view.projection = perspective(view.half_view, near_m, far_m + 3 * view.radius_m);

  const Vec3 up_C = view.X_CW.R * camera.up_W.normalized();
  view.up_C = up_C.cast<float>();
  double lowest = 1e300;
  for (int i = 0; i < 8; ++i)
    lowest = std::min(lowest, up_C.dot(view.X_CW * Vec3((i & 1) != 0 ? box_W.max.x() : box_W.min.x(),
                                                        (i & 2) != 0 ? box_W.max.y() : box_W.min.y(),
                                                        (i & 4) != 0 ? box_W.max.z() : box_W.min.z())));
  view.floor_C = view.center_C + (lowest - up_C.dot(view.center_C)) * up_C;

  if (options.cut) {
    const Vec3 n_C = view.X_CW.R * options.cut->n_W.normalized();
    const double offset = n_C.dot(view.X_CW * options.cut->p_W);
    view.cut_C << n_C.cast<float>(), static_cast<float>(offset);
    view.has_caps = offset < 0;  // the eye is the origin; from behind the plane no cut face shows
  }
  const Vec3 key = Vec3(-0.55, 0.75, 0.60).normalized();  // kKey of the shaders
  view.shadow_projection = parallel(view.center_C, 1.05 * view.radius_m, key, Vec3::UnitX());
  view.shadow_from_C = halfAndShift() * view.shadow_projection;
  return view;
}

std::vector<DrawnBody> Renderer::Impl::place(const scenes::Snapshot& snapshot, const View& view,
                                             const DrawOptions& options) const {
  std::vector<DrawnBody> bodies;
  forEachBody(scene.size(), fixed, snapshot, options.show_waiting,
              [&](std::size_t part, const Pose& X_WP, scenes::BodyRole role) {
                DrawnBody body;
                body.mesh = part_meshes[part];
                body.part = part;
                body.X_CP = view.X_CW * X_WP * Pose::translation(body.mesh->shading.center);
                body.color = Eigen::Map<const Vector3f>(scene[part].color.data());
                const bool is_in_hand = role == scenes::BodyRole::InHand;
                if (is_in_hand && options.highlight_hand) body.color = kHandColor;
                body.is_cut = options.cut && (!is_in_hand || options.cut->cuts_hand);
                bodies.push_back(body);
              });
  return bodies;
}

void Renderer::Impl::drawMeshes(const gl::Program& program, const std::vector<DrawnBody>& bodies,
                                const View& view, const Matrix4f& projection, bool is_shaded) const {
  program.use();
  program.set("projection", projection);
  glEnable(GL_CLIP_DISTANCE0);
  for (const DrawnBody& body : bodies) {
    program.set("X_CP", toMatrix(body.X_CP));
    program.set("cut_C", body.is_cut ? view.cut_C : kNoCut);
    if (is_shaded) program.set("color", body.color);
    body.mesh->draw();
  }
  glDisable(GL_CLIP_DISTANCE0);
}

void Renderer::Impl::drawKeyShadow(const std::vector<DrawnBody>& bodies, const View& view) const {
  glBindFramebuffer(GL_FRAMEBUFFER, gl->shadows.key_target.id());
  glViewport(0, 0, ShadowTargets::kKeySize, ShadowTargets::kKeySize);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 4);
  drawMeshes(gl->programs.depth, bodies, view, view.shadow_projection, false);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::Impl::drawFloor(const std::vector<DrawnBody>& bodies, const View& view) const {
  // The floor's texture covers three radii around the centre, seen from below so that the nearest wins.
  const double half_m = 3 * view.radius_m;
  const Vec3 up = view.up_C.cast<double>();
  const Vec3 x = std::abs(up.x()) < 0.8 ? Vec3(up.cross(Vec3::UnitX())).normalized()
                                        : up.cross(Vec3::UnitY()).normalized();
  const ShadowTargets& s = gl->shadows;
  glViewport(0, 0, ShadowTargets::kFloorSize, ShadowTargets::kFloorSize);
  glBindFramebuffer(GL_FRAMEBUFFER, s.floor_a_target.id());
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const gl::Program& floor = gl->programs.floor;
  floor.set("floor_C", Vector3f(view.floor_C.cast<float>()));
  floor.set("up_C", view.up_C);
  floor.set("size_m", static_cast<float>(2 * view.radius_m));
  drawMeshes(floor, bodies, view, parallel(view.floor_C, half_m, -up, x), false);

  glDisable(GL_DEPTH_TEST);
  const gl::Program& blur = gl->programs.floor_blur;
  const auto texels = static_cast<float>(ShadowTargets::kFloorSize * view.radius_m / (2 * half_m));
  blur.set("sigma_texel", Vector2f(0.035f * texels, 0.16f * texels));
  for (const auto& [from, to, direction] : {std::tuple(&s.floor_a, &s.floor_b_target, Vector2f(1, 0)),
                                            {&s.floor_b, &s.floor_a_target, Vector2f(0, 1)}}) {
    glBindFramebuffer(GL_FRAMEBUFFER, to->id());
    glBindTextureUnit(0, from->id());
    blur.set("source", 0);
    blur.set("direction", direction);
    fullScreen(blur);
  }
  glEnable(GL_DEPTH_TEST);
}

void Renderer::Impl::drawGeometry(const std::vector<DrawnBody>& bodies, const View& view) const {
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame->geometry_target.id());
  glViewport(0, 0, gl->frame->width, gl->frame->height);
  glClearColor(0, 0, 0, -1e9f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  drawMeshes(gl->programs.geometry, bodies, view, view.projection, false);
  drawCaps(gl->programs.cap_geometry, bodies, view);
}

void Renderer::Impl::drawOcclusion(const View& view) const {
  glDisable(GL_DEPTH_TEST);
  const auto radius_m = static_cast<float>(0.16 * view.detail_m);
  glBindTextureUnit(0, gl->frame->geometry.id());
  const gl::Program& occlusion = gl->programs.occlusion;
  occlusion.set("geometry", 0);
  occlusion.set("half_view", view.half_view);
  occlusion.set("radius_m", radius_m);
  occlusion.set("projection", view.projection);
  glBindTextureUnit(1, gl->shadows.key.id());
  occlusion.set("shadow_map", 1);
  occlusion.set("shadow_from_C", view.shadow_from_C);
  occlusion.set("shadow_offset_m", static_cast<float>(0.006 * view.radius_m));
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame->occlusion_raw_target.id());
  fullScreen(occlusion);
  glBindTextureUnit(1, gl->frame->occlusion_raw.id());
  const gl::Program& blur = gl->programs.occlusion_blur;
  blur.set("geometry", 0);
  blur.set("occlusion", 1);
  blur.set("radius_m", radius_m);
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame->occlusion_target.id());
  fullScreen(blur);
  glEnable(GL_DEPTH_TEST);
}

void Renderer::Impl::setStudio(const gl::Program& program, const View& view) const {
  glBindTextureUnit(0, gl->frame->occlusion.id());
  program.set("light_reaching", 0);
  program.set("up_C", view.up_C);
  program.set("picture_px", Vector2f(static_cast<float>(gl->frame->width * gl->frame->factor),
                                     static_cast<float>(gl->frame->height * gl->frame->factor)));
}

void Renderer::Impl::drawCaps(const gl::Program& program, const std::vector<DrawnBody>& bodies,
                              const View& view) const {
  if (!view.has_caps) return;
  // A quad in the plane, large enough for everything, its axes fixed in the plane so that the hatch stays
  // put.
  const Vec3 n = view.cut_C.head<3>().cast<double>();
  const Vec3 up = view.up_C.cast<double>();
  const Vec3 y = std::abs(n.dot(up)) < 0.9 ? Vec3(up - n.dot(up) * n).normalized() : n.unitOrthogonal();
  const Vec3 origin = view.center_C + (view.cut_C.w() - n.dot(view.center_C)) * n;
  program.set("projection", view.projection);
  program.set("origin_C", Vector3f(origin.cast<float>()));
  program.set("x_C", Vector3f(y.cross(n).cast<float>()));
  program.set("y_C", Vector3f(y.cast<float>()));
  program.set("half_size_m", static_cast<float>(2 * view.radius_m));

  glEnable(GL_STENCIL_TEST);
  glEnable(GL_SCISSOR_TEST);
  for (const DrawnBody& body : bodies) {
    if (!body.is_cut) continue;
    const ScreenBox screen = boxOnScreen(part_bounds[body.part], body, view);
    if (!screen.meets_plane) continue;
    glScissor(screen.x, screen.y, screen.width, screen.height);  // stencil and caps cost by the pixel
    // Along a pixel's ray behind the plane: back faces minus front faces is 1 where the ray starts inside the
    // solid.
    glClear(GL_STENCIL_BUFFER_BIT);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_FALSE);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_CLAMP);
    glStencilFunc(GL_ALWAYS, 0, 0xFF);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_INCR_WRAP);
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_DECR_WRAP);
    drawMeshes(gl->programs.depth, {body}, view, view.projection, false);
    glDisable(GL_DEPTH_CLAMP);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glStencilFunc(GL_NOTEQUAL, 0, 0xFF);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    program.set("color", body.color);
    program.set("hatch", Vector2f(std::sqrt(0.5f), body.part % 2 == 0 ? std::sqrt(0.5f) : -std::sqrt(0.5f)));
    program.set("hatch_step_m", static_cast<float>(0.035 * view.detail_m * (1 + 0.25 * (body.part % 3))));
    quad(program);
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
}

void Renderer::Impl::drawFloorShadow(const View& view) const {
  const Vec3 up = view.up_C.cast<double>();
  if (up.dot(view.floor_C) >= 0) return;  // the eye, at the origin, is under the floor
  // The same axes as in drawFloor(): parallel() with back = -up and its up = x spans (x cross -up, x).
  const Vec3 x = std::abs(up.x()) < 0.8 ? Vec3(up.cross(Vec3::UnitX())).normalized()
                                        : up.cross(Vec3::UnitY()).normalized();
  const gl::Program& program = gl->programs.floor_shadow;
  program.set("projection", view.projection);
  program.set("origin_C", Vector3f(view.floor_C.cast<float>()));
  program.set("x_C", Vector3f(x.cross(-up).normalized().cast<float>()));
  program.set("y_C", Vector3f(x.cast<float>()));
  program.set("half_size_m", static_cast<float>(3 * view.radius_m));
  glBindTextureUnit(0, gl->shadows.floor_a.id());
  program.set("floor_shadow", 0);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  quad(program);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Renderer::Impl::drawLines(const GpuLines& lines, const DrawnBody& body, const View& view, float width_px,
                               const Vector4f& color) const {
  if (lines.count == 0) return;
  const gl::Program& program = gl->programs.line;
  program.use();
  const auto factor = static_cast<float>(gl->frame->factor);
  program.set("projection", view.projection);
  program.set("X_CP", toMatrix(body.X_CP));
  program.set("cut_C", body.is_cut ? view.cut_C : kNoCut);
  program.set("picture_px", Vector2f(gl->frame->width * factor, gl->frame->height * factor));
  program.set("width_px", width_px * factor * std::clamp(gl->frame->height / 960.0f, 0.6f, 3.0f));
  program.set("pull",
              static_cast<float>(0.004 * view.detail_m / std::max(view.detail_m, -view.center_C.z())));
  program.set("near_m", view.near_m);
  program.set("color", color);
  glBindVertexArray(lines.array.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, lines.count);
}

void Renderer::Impl::drawEdges(const std::vector<DrawnBody>& bodies, const View& view) const {
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_BLEND);
  for (const DrawnBody& body : bodies) {
    const Vector3f ink = 0.10f * body.color + Vector3f::Constant(0.004f);
    const Vec3 p_eye = -(body.X_CP.R.transpose() * body.X_CP.p);
    const std::vector<ShadingEdge> rim = outline(body.mesh->shading, p_eye);
    drawLines(body.mesh->sharp_edges, body, view, 1.25f, {ink.x(), ink.y(), ink.z(), 0.85f});
    drawLines(GpuLines(rim), body, view, 1.25f, {ink.x(), ink.y(), ink.z(), 0.85f});
  }
  glDisable(GL_CLIP_DISTANCE0);
  if (view.has_caps)
    for (const DrawnBody& body : bodies) {
      if (!body.is_cut) continue;
      const Vec3 n_C = view.cut_C.head<3>().cast<double>();
      // The section in the mesh's own frame; its lines must not be clipped by the plane they lie in.
      const Vec3 n_P = body.X_CP.R.transpose() * n_C;
      const double offset = view.cut_C.w() - n_C.dot(body.X_CP.p) + n_P.dot(body.mesh->shading.center);
      DrawnBody whole = body;
      whole.is_cut = false;
      drawLines(GpuLines(sectionSegments(body.mesh->shading, n_P, offset)), whole, view, 1.7f,
                {0.01f, 0.01f, 0.012f, 1});
    }
  glDisable(GL_BLEND);
}

void Renderer::Impl::drawGhost(const DrawnBody& ghost, const View& view, const DrawOptions& options) const {
  // Its nearest surface only, or front and back would add up. Pushed back a little: where part and target
  // agree, the part is seen.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 8);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  drawMeshes(gl->programs.depth, {ghost}, view, view.projection, false);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glDepthFunc(GL_LEQUAL);
  drawMeshes(gl->programs.ghost, {ghost}, view, view.projection, true);
  glDisable(GL_POLYGON_OFFSET_FILL);
  if (options.show_edges) {
    glEnable(GL_CLIP_DISTANCE0);
    const Vec3 p_eye = -(ghost.X_CP.R.transpose() * ghost.X_CP.p);
    const std::vector<ShadingEdge> rim = outline(ghost.mesh->shading, p_eye);
    const Vector4f ink(0.2f * ghost.color.x(), 0.35f * ghost.color.y(), 0.6f * ghost.color.z(), 0.55f);
    drawLines(ghost.mesh->sharp_edges, ghost, view, 1.1f, ink);
    drawLines(GpuLines(rim), ghost, view, 1.1f, ink);
    // Behind other parts it is only hinted at.
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    drawLines(ghost.mesh->sharp_edges, ghost, view, 1.0f, {ink.x(), ink.y(), ink.z(), 0.16f});
    drawLines(GpuLines(rim), ghost, view, 1.0f, {ink.x(), ink.y(), ink.z(), 0.16f});
    glDepthMask(GL_TRUE);
    glDisable(GL_CLIP_DISTANCE0);
  }
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
}

void Renderer::Impl::drawMarks(const scenes::Snapshot& snapshot, const View& view,
                               const DrawOptions& options) const {
  const MarkList marks = listMarks(snapshot, view.X_CW, 2 * view.detail_m, options);
  const gl::Program& program = gl->programs.mark;
  program.use();
  program.set("projection", view.projection);
  program.set("pull", static_cast<float>(0.01 * view.detail_m / std::max(view.detail_m, -view.center_C.z())));
  if (options.show_hidden_marks) {
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GREATER);
    program.set("alpha", 0.28f);
    gl->arrow.draw(marks.arrows);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
  }
  program.set("alpha", 1.0f);
  gl->disc.draw(marks.discs);
  gl->arrow.draw(marks.arrows);
}

void Renderer::Impl::drawColor(const std::vector<DrawnBody>& bodies, const scenes::Snapshot& snapshot,
                               const View& view, const DrawOptions& options) const {
  const FrameTargets& f = *gl->frame;
  glBindFramebuffer(GL_FRAMEBUFFER, f.color_target.id());
  glViewport(0, 0, f.width * f.factor, f.height * f.factor);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  fullScreen(gl->programs.background);
  glEnable(GL_DEPTH_TEST);
  if (options.show_ground) drawFloorShadow(view);
  setStudio(gl->programs.mesh, view);
  drawMeshes(gl->programs.mesh, bodies, view, view.projection, true);
  setStudio(gl->programs.cap, view);
  drawCaps(gl->programs.cap, bodies, view);
  if (options.show_edges) drawEdges(bodies, view);
  drawMarks(snapshot, view, options);
  if (options.show_target && snapshot.has_target && snapshot.target_part < scene.size() &&
      snapshot.X_WP_target.isFinite()) {
    DrawnBody ghost;
    ghost.part = snapshot.target_part;
    ghost.mesh = part_meshes[ghost.part];
    ghost.X_CP = view.X_CW * snapshot.X_WP_target * Pose::translation(ghost.mesh->shading.center);
    ghost.color = kHandColor;
    ghost.is_cut = options.cut && options.cut->cuts_hand;
    drawGhost(ghost, view, options);
  }
}

Image Renderer::Impl::finish() const {
  const FrameTargets& f = *gl->frame;
  const int w = f.width * f.factor, h = f.height * f.factor;
  glBlitNamedFramebuffer(f.color_target.id(), f.resolved_target.id(), 0, 0, w, h, 0, 0, w, h,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, f.shown_target.id());
  glViewport(0, 0, f.width, f.height);
  glDisable(GL_DEPTH_TEST);
  glBindTextureUnit(0, f.resolved.id());
  gl->programs.final.set("linear_picture", 0);
  gl->programs.final.set("factor", f.factor);
  fullScreen(gl->programs.final);
  glEnable(GL_DEPTH_TEST);
  std::vector<std::uint8_t> rgba(std::size_t(4) * f.width * f.height);
  glReadPixels(0, 0, f.width, f.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  Image image(f.width, f.height);
  for (int y = 0; y < f.height; ++y) {
    const std::uint8_t* row =
        &rgba[std::size_t(4) * f.width * (f.height - 1 - y)];  // OpenGL counts from below
    for (int x = 0; x < f.width; ++x) std::copy_n(row + 4 * x, 3, image.at(x, y));
  }
  return image;
}

Renderer::Renderer(const RenderScene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
std::string Renderer::description() const {
  return impl_->description;
}

Image Renderer::render(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options) {
  Impl& r = *impl_;
  const EglContext::Current current(r.context);
  const int width = std::clamp(options.width, 16, 8192), height = std::clamp(options.height, 16, 8192);
  const int factor = std::clamp(options.supersampling, 1, 4);
  std::unique_ptr<FrameTargets>& frame = r.gl->frame;
  if (!frame || frame->width != width || frame->height != height || frame->factor != factor) {
    frame.reset();  // first, so that two sizes never stand side by side
    frame = std::make_unique<FrameTargets>(width, height, factor);
  }
  DrawOptions clamped = options;
  clamped.width = width;
  clamped.height = height;

  glEnable(GL_DEPTH_TEST);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glClearStencil(0);
  const View view = r.makeView(snapshot, camera, clamped);
  const std::vector<DrawnBody> bodies = r.place(snapshot, view, clamped);
  r.drawKeyShadow(bodies, view);
  if (options.show_ground) r.drawFloor(bodies, view);
  r.drawGeometry(bodies, view);
  r.drawOcclusion(view);
  r.drawColor(bodies, snapshot, view, clamped);
  Image image = r.finish();
  drawOverlay(image, snapshot, options, {kHandColor, kHandColor}, r.lettering);
  return image;
}

Box snapshotBounds(const RenderScene& scene, const scenes::Snapshot& snapshot, bool show_waiting) {
  Box box;
  forEachBody(scene.size(), fixedPoses(scene), snapshot, show_waiting,
              [&](std::size_t part, const Pose& X_WP, scenes::BodyRole) {
                grow(box, movedBounds(bounds(*scene[part].mesh), X_WP));
              });
  if (snapshot.has_target && snapshot.target_part < scene.size())
    grow(box, movedBounds(bounds(*scene[snapshot.target_part].mesh), snapshot.X_WP_target));
  return box;
}

}  // namespace vps::viewer
