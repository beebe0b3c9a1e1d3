// SPDX-License-Identifier: BSD-3-Clause
// How the mouse moves the camera (orbit, pan, zoom, fit, standard views) and the section plane.
#pragma once

#include <string_view>
#include <vector>

#include "view/picking.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Turns the camera about its target: half a turn for a drag over the picture's height. The camera stops
/// before it looks along its up direction, where left and right would swap.
VPS_VIEWER_API void orbit(Camera& camera, const PixelPlace& drag, PictureSize size);

/// Moves eye and target so that a point at depth_m in front of the eye follows the cursor.
VPS_VIEWER_API void pan(Camera& camera, const PixelPlace& drag, double depth_m, PictureSize size);
/// Moves eye and target so that a point at the target's depth follows the cursor.
VPS_VIEWER_API void pan(Camera& camera, const PixelPlace& drag, PictureSize size);

/// Divides the distance from eye to target by `factor`, and keeps the point under the cursor at the target's
/// depth in place. The distance stays between least_m and most_m.
VPS_VIEWER_API void zoom(Camera& camera, double factor, const PixelPlace& at, PictureSize size,
                         double least_m, double most_m);

/// A named view: the direction from the scene to the eye, and the up direction.
struct StandardView {
  std::string_view name;  ///< "front"
  Vec3 direction_W, up_W;
};
/// The views iso, front, back, left, right, top and bottom.
VPS_VIEWER_API const std::vector<StandardView>& standardViews();

/// Camera of a standard view, as near as the box fits into the picture.
[[nodiscard]] VPS_VIEWER_API Camera cameraFor(const StandardView& view, const Box& box_W, PictureSize size);
/// Camera with the present direction of view, as near as the box fits into the picture.
[[nodiscard]] VPS_VIEWER_API Camera fitted(const Camera& camera, const Box& box_W, PictureSize size);

/// A section plane through the box's centre, perpendicular to the axis of W that points most to the viewer.
/// The section cuts away the half on the viewer's side.
[[nodiscard]] VPS_VIEWER_API CutPlane sectionFacing(const Camera& camera, const Box& box_W);

/// Moves the plane along its normal, so that a point of the plane follows the drag on the screen. If the
/// normal points at the eye, a drag up moves the plane away. The plane stays within the box.
VPS_VIEWER_API void dragSection(CutPlane& cut, const Camera& camera, const PixelPlace& drag, PictureSize size,
                                const Box& box_W);

/// Tilts the plane about its point p_W: half a turn for a drag over the picture's height.
VPS_VIEWER_API void tiltSection(CutPlane& cut, const Camera& camera, const PixelPlace& drag,
                                PictureSize size);

}  // namespace vps::viewer
