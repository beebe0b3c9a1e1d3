// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/visible_parts.h"

#include "mesh/box_corners.h"

namespace vps::viewer {
namespace {

void addMoved(Box& box_W, const Box& box_P, const Pose& X_WP) {
  if (box_P.isEmpty()) return;
  for (const Vec3& p_P : corners(box_P)) box_W.add(X_WP * p_P);
}

}  // namespace

std::vector<PartExtent> partExtents(const RenderScene& scene) {
  std::vector<PartExtent> parts;
  for (const DrawnMesh& part : scene) parts.push_back({bounds(*part.mesh), part.is_fixed, part.X_WP});
  return parts;
}

void forEachVisiblePart(
    const std::vector<PartExtent>& parts, const scenes::Snapshot& snapshot, bool show_waiting,
    const std::function<void(std::size_t part, const Pose& X_WP, scenes::BodyRole role)>& visit) {
  std::vector<bool> is_listed(parts.size(), false);
  for (const scenes::BodySnapshot& body : snapshot.bodies) {
    if (body.part >= parts.size() || !body.X_WP.isFinite()) continue;
    is_listed[body.part] = true;
    if (parts[body.part].is_fixed || show_waiting || body.role != scenes::BodyRole::Waiting)
      visit(body.part, body.X_WP, body.role);
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!is_listed[i] && parts[i].is_fixed) visit(i, parts[i].X_WP, scenes::BodyRole::Mounted);
}

Box visibleBounds(const std::vector<PartExtent>& parts, const scenes::Snapshot& snapshot, bool show_waiting,
                  bool show_target) {
  Box box_W;
  forEachVisiblePart(parts, snapshot, show_waiting,
                     [&](std::size_t part, const Pose& X_WP, scenes::BodyRole) {
                       addMoved(box_W, parts[part].bounds_P, X_WP);
                     });
  if (show_target && snapshot.has_target && snapshot.target_part < parts.size())
    addMoved(box_W, parts[snapshot.target_part].bounds_P, snapshot.X_WP_target);
  return box_W;
}

Box snapshotBounds(const RenderScene& scene, const scenes::Snapshot& snapshot, bool show_waiting) {
  return visibleBounds(partExtents(scene), snapshot, show_waiting, true);
}

}  // namespace vps::viewer
