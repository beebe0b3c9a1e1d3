// SPDX-License-Identifier: BSD-3-Clause
// How the mouse moves a section's plane.
#pragma once

#include "view/camera_motion.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// The plane through the box's middle, across the axis of W that points to the viewer most; it cuts away the
/// half on the viewer's side.
[[nodiscard]] VPS_VIEWER_API CutPlane sectionFacing(const Camera& camera, const Box& box_W);

/// Moves the plane along its normal by as much as the drag moves a point of it on the screen. Where the
/// normal points at the eye, a drag up moves it away. It stays within the box.
VPS_VIEWER_API void dragSection(CutPlane& cut, const Camera& camera, const PixelPlace& drag, PictureSize size,
                                const Box& box_W);

/// Tilts the plane about the middle of the box's part of it: half a turn for a drag over the picture's
/// height.
VPS_VIEWER_API void tiltSection(CutPlane& cut, const Camera& camera, const PixelPlace& drag,
                                PictureSize size);

}  // namespace vps::viewer
