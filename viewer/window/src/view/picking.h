// SPDX-License-Identifier: BSD-3-Clause
// Which part is under the cursor.
#pragma once

#include <optional>

#include "view/camera_motion.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

struct PickedPlace {
  std::size_t part = 0;  ///< index into the RenderScene
  Vec3 p_W = Vec3::Zero();
  double distance_m = 0;  ///< from the eye
};

/// The part that the ray meets first among those that the options show; the section's plane and what is
/// behind it count as there, what it cuts away does not. O(triangles of the parts whose boxes the ray meets).
[[nodiscard]] VPS_VIEWER_API std::optional<PickedPlace> pick(const RenderScene& scene,
                                                             const scenes::Snapshot& snapshot,
                                                             const DrawOptions& options, const Ray& ray);

}  // namespace vps::viewer
