// SPDX-License-Identifier: BSD-3-Clause
// The parts that a snapshot shows: which, at which pose, and the box around them.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "vps/mesh.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// A part's extent and, if it is fixed, its pose. A renderer keeps these extents after the meshes are
/// uploaded.
struct PartExtent {
  Box bounds_P;
  bool is_fixed = false;
  Pose X_WP;  ///< pose of a fixed part; the snapshot has the poses of other parts
};

std::vector<PartExtent> partExtents(const RenderScene& scene);

/// Calls visit(part, X_WP, role) for each part to draw. Fixed parts are drawn even if the snapshot does not
/// list them; bodies with an unknown part or a pose that is not finite are left out.
void forEachVisiblePart(
    const std::vector<PartExtent>& parts, const scenes::Snapshot& snapshot, bool show_waiting,
    const std::function<void(std::size_t part, const Pose& X_WP, scenes::BodyRole role)>& visit);

/// The box in W around all visible parts and, with show_target, the target. Empty if nothing is visible.
Box visibleBounds(const std::vector<PartExtent>& parts, const scenes::Snapshot& snapshot, bool show_waiting,
                  bool show_target);

/// The eight corners of a box. Corner i has the greatest x, y, z if bit 0, 1, 2 of i is set.
inline std::array<Vec3, 8> corners(const Box& box) {
  std::array<Vec3, 8> points;
  for (int i = 0; i < 8; ++i)
    points[static_cast<std::size_t>(i)] =
        Vec3((i & 1) != 0 ? box.max.x() : box.min.x(), (i & 2) != 0 ? box.max.y() : box.min.y(),
             (i & 4) != 0 ? box.max.z() : box.min.z());
  return points;
}

}  // namespace vps::viewer
