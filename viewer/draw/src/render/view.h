// SPDX-License-Identifier: BSD-3-Clause
// The camera, section and light projection of one picture, in the camera frame C, and the rectangles of
// pixels that parts and marks cover in it.
#pragma once

#include <array>

#include "gl/scene_buffers.h"
#include "marks/marks.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// A cut that removes nothing.
inline const Eigen::Vector4f kNoCut(0, 0, 0, 1);

/// What stays the same during one picture.
struct View {
  Pose X_CW;
  Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();
  Eigen::Vector2f half_view;                        ///< tan of half the angles of view
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();  ///< of the picture's middle, likewise
  float near_m = 0;
  double px_m = 1;  ///< pixels of a metre across at a distance of a metre, with supersampling
  Eigen::Vector3f up_C;
  Vec3 center_C;
  double radius_m = 1;  ///< of a sphere around all that is drawn
  double detail_m = 1;  ///< of a sphere around what the picture shows: smaller than radius_m in a close-up
  Vec3 floor_C;         ///< the point of the floor under the centre
  Eigen::Vector4f cut_C = kNoCut;                                   ///< (n, w): the section keeps n.p <= w
  bool has_caps = false;                                            ///< whether the eye sees cut faces
  Eigen::Matrix4f shadow_from_C = Eigen::Matrix4f::Identity();      ///< to texture coordinates and depth
  Eigen::Matrix4f shadow_projection = Eigen::Matrix4f::Identity();  ///< to clip coordinates
};

/// @param box_W what is drawn; if it is empty, a box of 2 m around the origin stands in
View makeView(const Box& box_W, const Camera& camera, const DrawOptions& options);

/// Parallel projection of a sphere to [-1, 1]^3.
/// @param back unit vector from the centre to the viewer
Eigen::Matrix4f parallelProjection(const Vec3& center, double radius_m, const Vec3& back, const Vec3& up);

/// Pixels from the lower left corner, as OpenGL counts.
struct PixelRect {
  GLint x = 0, y = 0;
  GLsizei width = 0, height = 0;

  [[nodiscard]] bool isEmpty() const { return width <= 0 || height <= 0; }
  bool operator==(const PixelRect&) const = default;
};
PixelRect intersection(const PixelRect& a, const PixelRect& b);
/// The least rectangle around both; an empty one has no place.
PixelRect join(const PixelRect& a, const PixelRect& b);
/// What the first has around the second, which lies in it: below, above, left, right.
std::array<PixelRect, 4> around(const PixelRect& all, const PixelRect& inner);
/// Pixels of a picture that is `factor` times as large.
PixelRect scaled(const PixelRect& rect, int factor);

/// Around a part, in a picture of that size. All of it where the part reaches behind the near plane.
/// @param margin_px  beyond the part on each side, as lines along its outline need
PixelRect boxOnScreen(const DrawnBody& body, const View& view, int width, int height, int margin_px);
/// Around an arrow or a disc, likewise.
PixelRect markOnScreen(const Mark& mark, const View& view, int width, int height);

}  // namespace vps::viewer
