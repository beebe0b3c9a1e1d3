// SPDX-License-Identifier: BSD-3-Clause
#include "render/view.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "mesh/scene_meshes.h"

namespace vps::viewer {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector2f;

Matrix4f perspectiveProjection(const Vector2f& half_view, const Vector2f& shift, double near_m,
                               double far_m) {
  Matrix4f m = Matrix4f::Zero();
  m(0, 2) = shift.x() / half_view.x();
  m(1, 2) = shift.y() / half_view.y();
  m(0, 0) = 1 / half_view.x();
  m(1, 1) = 1 / half_view.y();
  m(2, 2) = static_cast<float>(-(far_m + near_m) / (far_m - near_m));
  m(2, 3) = static_cast<float>(-2 * far_m * near_m / (far_m - near_m));
  m(3, 2) = -1;
  return m;
}

/// Maps [-1, 1] to [0, 1], for texture lookups.
Matrix4f clipToTexture() {
  Matrix4f m = Matrix4f::Identity() * 0.5f;
  m.topRightCorner<3, 1>().setConstant(0.5f);
  m(3, 3) = 1;
  return m;
}

void setLens(View& view, const Camera& camera, const DrawOptions& options) {
  // Marks stick out of the box by up to a third of its size.
  const double reach_m = (options.is_draft ? 2.2 : 1.6) * view.radius_m;  // see coarseBounds()
  const double depth_m = -view.center_C.z();
  const double far_m = std::max(depth_m + reach_m, 1e-6);
  const double near_m = std::max(depth_m - reach_m, 1e-3 * far_m);
  view.near_m = static_cast<float>(near_m);
  const double tan_y = std::tan(0.5 * camera.fov_rad);
  view.detail_m = std::min(view.radius_m, 1.5 * tan_y * (camera.eye_W - camera.target_W).norm());
  const auto [half_x, half_y] = camera.halfView(options.width, options.height);
  view.px_m = 0.5 * options.height * std::max(1, options.supersampling) / half_y;
  view.half_view = Vector2f(static_cast<float>(half_x), static_cast<float>(half_y));
  view.shift = Vector2f(static_cast<float>(camera.shift_x), static_cast<float>(camera.shift_y));
  // The floor extends beyond the box, so the far plane lies further out than the box requires.
  view.projection = perspectiveProjection(view.half_view, view.shift, near_m, far_m + 3 * view.radius_m);
}

void setFloor(View& view, const Box& box_W, const Camera& camera) {
  const Vec3 up_C = view.X_CW.R * camera.up_W.normalized();
  view.up_C = up_C.cast<float>();
  double lowest = 1e300;
  for (const Vec3& p_W : corners(box_W)) lowest = std::min(lowest, up_C.dot(view.X_CW * p_W));
  view.floor_C = view.center_C + (lowest - up_C.dot(view.center_C)) * up_C;
}

void setCut(View& view, const CutPlane& cut) {
  const Vec3 n_C = view.X_CW.R * cut.n_W.normalized();
  const double offset = n_C.dot(view.X_CW * cut.p_W);
  view.cut_C << n_C.cast<float>(), static_cast<float>(offset);
  view.has_caps = offset < 0;  // the eye is the origin; from behind the plane it sees no cut face
}

}  // namespace

Matrix4f parallelProjection(const Vec3& center, double radius_m, const Vec3& back, const Vec3& up) {
  const Vec3 x = up.cross(back).normalized();
  Mat3 R;
  R << x, back.cross(x), back;
  Matrix4f m = Matrix4f::Identity();
  const Mat3 scaled = Vec3(1, 1, -1).asDiagonal() * R.transpose() / radius_m;
  m.topLeftCorner<3, 3>() = scaled.cast<float>();
  m.topRightCorner<3, 1>() = (-(scaled * center)).cast<float>();
  return m;
}

View makeView(const Box& drawn_W, const Camera& camera, const DrawOptions& options) {
  const Box box_W = drawn_W.isEmpty() ? Box{Vec3::Constant(-1), Vec3::Constant(1)} : drawn_W;
  View view;
  view.X_CW = camera.pose().inverse();
  view.center_C = view.X_CW * box_W.center();
  view.radius_m = std::max(1e-9, 0.5 * box_W.size().norm());
  setLens(view, camera, options);
  setFloor(view, box_W, camera);
  if (options.cut) setCut(view, *options.cut);
  const Vec3 key = Vec3(-0.55, 0.75, 0.60).normalized();  // same direction as kKey in shaders.h
  view.shadow_projection = parallelProjection(view.center_C, 1.05 * view.radius_m, key, Vec3::UnitX());
  view.shadow_from_C = clipToTexture() * view.shadow_projection;
  return view;
}

namespace {

/// The rectangle around the points; the whole picture if one of them is behind the near plane.
PixelRect around(std::span<const Vec3> points_C, const View& view, int width, int height, int margin_px) {
  const PixelRect whole = {0, 0, width, height};
  Eigen::Array2d low(1, 1), high(-1, -1);
  for (const Vec3& p_C : points_C) {
    if (!(p_C.z() <= -view.near_m)) return whole;
    const Eigen::Array2d ndc = (p_C.head<2>().array() / -p_C.z() - view.shift.cast<double>().array()) /
                               view.half_view.cast<double>().array();
    low = low.min(ndc);
    high = high.max(ndc);
  }
  low = low.max(-1.0);
  high = high.min(1.0);
  const auto first = [&](double ndc, int length) {
    return static_cast<GLint>(std::floor(0.5 * (ndc + 1) * length)) - margin_px;
  };
  const auto last = [&](double ndc, int length) {
    return static_cast<GLint>(std::ceil(0.5 * (ndc + 1) * length)) + margin_px;
  };
  const GLint x = first(low.x(), width), y = first(low.y(), height);
  return intersection({x, y, last(high.x(), width) - x, last(high.y(), height) - y}, whole);
}

}  // namespace

PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  const GLint x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::max(0, std::min(a.x + a.width, b.x + b.width) - x),
          std::max(0, std::min(a.y + a.height, b.y + b.height) - y)};
}

PixelRect join(const PixelRect& a, const PixelRect& b) {
  if (a.isEmpty()) return b;
  if (b.isEmpty()) return a;
  const GLint x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

std::array<PixelRect, 4> around(const PixelRect& all, const PixelRect& inner) {
  const GLint right = inner.x + inner.width, top = inner.y + inner.height;
  return {{{all.x, all.y, all.width, inner.y - all.y},
           {all.x, top, all.width, all.y + all.height - top},
           {all.x, inner.y, inner.x - all.x, inner.height},
           {right, inner.y, all.x + all.width - right, inner.height}}};
}

PixelRect scaled(const PixelRect& rect, int factor) {
  return {rect.x * factor, rect.y * factor, rect.width * factor, rect.height * factor};
}

PixelRect boxOnScreen(const DrawnBody& body, const View& view, int width, int height, int margin_px) {
  std::array<Vec3, 8> points_C = corners(body.mesh->bounds_P);
  for (Vec3& p : points_C) p = body.X_CP * (p - body.mesh->shading.center);
  return around(points_C, view, width, height, margin_px);
}

PixelRect markOnScreen(const Mark& mark, const View& view, int width, int height) {
  const double reach_m = std::hypot(mark.size_m[0], mark.size_m[1]);
  const Vec3 base_C(mark.base_C[0], mark.base_C[1], mark.base_C[2]);
  const std::array<Vec3, 8> points_C =
      corners(Box{base_C - Vec3::Constant(reach_m), base_C + Vec3::Constant(reach_m)});
  return around(points_C, view, width, height, 2);
}

}  // namespace vps::viewer
