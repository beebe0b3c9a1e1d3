// SPDX-License-Identifier: BSD-3-Clause
// How the mouse moves the camera: orbit, pan, zoom, fit, standard views.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "vps_viewer/draw/camera.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Size of the picture in pixels.
struct PictureSize {
  int width = 1280, height = 720;
  bool operator==(const PictureSize&) const = default;
};

/// A place in the picture in pixels: x right, y down.
using PixelPlace = std::array<double, 2>;

/// A ray from the eye; its direction is a unit vector.
struct Ray {
  Vec3 p_W = Vec3::Zero();
  Vec3 d_W = -Vec3::UnitZ();
};
[[nodiscard]] VPS_VIEWER_API Ray rayThrough(const Camera& camera, const PixelPlace& at, PictureSize size);

/// Turns the camera about its target: half a turn for a drag over the picture's height. It stops short of
/// looking along its up direction, where left and right would change places.
VPS_VIEWER_API void orbit(Camera& camera, const PixelPlace& drag, PictureSize size);

/// Moves eye and target so that a point at depth_m in front of the eye follows the cursor.
VPS_VIEWER_API void pan(Camera& camera, const PixelPlace& drag, double depth_m, PictureSize size);
/// The same at the target's depth.
VPS_VIEWER_API void pan(Camera& camera, const PixelPlace& drag, PictureSize size);

/// Divides the distance from eye to target by `factor`; what is under the cursor at the target's depth stays
/// there. The distance stays between the given ones.
VPS_VIEWER_API void zoom(Camera& camera, double factor, const PixelPlace& at, PictureSize size,
                         double least_m, double most_m);

/// A direction from the scene to the eye, with a name and the up direction that goes with it.
struct StandardView {
  std::string_view name;  ///< "front"
  Vec3 direction_W, up_W;
};
/// iso, front, back, left, right, top, bottom.
VPS_VIEWER_API const std::vector<StandardView>& standardViews();

/// The nearest view of the box from that side.
[[nodiscard]] VPS_VIEWER_API Camera cameraFor(const StandardView& view, const Box& box_W, PictureSize size);
/// The nearest view of the box from where the camera looks now.
[[nodiscard]] VPS_VIEWER_API Camera fitted(const Camera& camera, const Box& box_W, PictureSize size);

}  // namespace vps::viewer
