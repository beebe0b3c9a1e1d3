// SPDX-License-Identifier: BSD-3-Clause
// The camera, section and light projection of one picture, in the camera frame C, and the rectangles of
// pixels that parts and marks cover in it.
#pragma once

#include <array>

#include "gl/scene_buffers.h"
#include "marks/marks.h"
#include "vps_viewer/draw/camera.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// A cut that removes nothing.
inline const Eigen::Vector4f kNoCut(0, 0, 0, 1);

/// The quantities that are constant during one picture.
struct View {
  Pose X_CW;
  Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();
  Eigen::Vector2f half_view;                        ///< tangents of half the angles of view
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();  ///< offset of the picture's middle, as tangents
  float near_m = 0;
  double px_m = 1;  ///< pixels per metre across the view at a distance of one metre, with supersampling
  Eigen::Vector3f up_C;
  Vec3 center_C;
  double radius_m = 1;  ///< radius of a sphere around everything that is drawn
  double detail_m = 1;  ///< radius of a sphere around the visible region: smaller than radius_m in a close-up
  Vec3 floor_C;         ///< the point of the floor under the centre
  Eigen::Vector4f cut_C = kNoCut;                               ///< (n, w): the section keeps n.p <= w
  bool has_caps = false;                                        ///< whether the eye sees cut faces
  Eigen::Matrix4f shadow_from_C = Eigen::Matrix4f::Identity();  ///< from C to texture coordinates and depth
  Eigen::Matrix4f shadow_projection =
      Eigen::Matrix4f::Identity();  ///< from C to clip coordinates of the shadow map
};

/// @param box_W box around everything that is drawn; if it is empty, a box of 2 m around the origin is used
View makeView(const Box& box_W, const Camera& camera, const DrawOptions& options);

/// Parallel projection of a sphere to [-1, 1]^3.
/// @param back unit vector from the centre to the viewer
Eigen::Matrix4f parallelProjection(const Vec3& center, double radius_m, const Vec3& back, const Vec3& up);

/// A rectangle of pixels, from the lower left corner as in OpenGL.
struct PixelRect {
  GLint x = 0, y = 0;
  GLsizei width = 0, height = 0;

  [[nodiscard]] bool isEmpty() const { return width <= 0 || height <= 0; }
  bool operator==(const PixelRect&) const = default;
};
PixelRect intersection(const PixelRect& a, const PixelRect& b);
/// The smallest rectangle around both; an empty rectangle is ignored.
PixelRect join(const PixelRect& a, const PixelRect& b);
/// The four rectangles that `all` has around `inner`, which lies in `all`: below, above, left, right.
std::array<PixelRect, 4> around(const PixelRect& all, const PixelRect& inner);
/// The same rectangle in a picture that is `factor` times as large.
PixelRect scaled(const PixelRect& rect, int factor);

/// The rectangle around a part in a picture of the given size; the whole picture if the part reaches behind
/// the near plane.
/// @param margin_px  margin on each side of the part, for the lines along its outline
PixelRect boxOnScreen(const DrawnBody& body, const View& view, int width, int height, int margin_px);
/// The rectangle around an arrow or a disc, as boxOnScreen().
PixelRect markOnScreen(const Mark& mark, const View& view, int width, int height);

}  // namespace vps::viewer
