// SPDX-License-Identifier: BSD-3-Clause
// The force on the hand as number and colour, for those whose device cannot push.
#pragma once

#include <string>
#include <vector>

#include "view/camera_motion.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_viewer/draw/stereo.h"

namespace vps::viewer {

struct HandMark {
  std::string words;  ///< "2.5 N  0.10 N m"
  double share = 0;   ///< of the scale of colours, which ends at the mouse's greatest force and torque
};
[[nodiscard]] VPS_VIEWER_API HandMark handMark(const scenes::Snapshot& shot);

/// Where in the picture the mark is written, its left end. In mono beside the hand. In stereo at the left
/// border, once for each eye where each has a part of the picture of its own: that is the depth of the
/// screen, for both eyes.
[[nodiscard]] VPS_VIEWER_API std::vector<PixelPlace> handMarkPlaces(StereoMode mode, const Vec3& hand_W,
                                                                    const Camera& camera, PictureSize size);

}  // namespace vps::viewer
