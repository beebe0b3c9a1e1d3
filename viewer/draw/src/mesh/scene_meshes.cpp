// SPDX-License-Identifier: BSD-3-Clause
// The parts of a scene to draw, the box around them, and the plane of a section through them.
#include "mesh/scene_meshes.h"

#include <algorithm>
#include <cmath>

#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

RenderScene drawnMeshes(const scenes::Scene& scene) {
  // Linear RGB of muted steel, brass, sage, clay, slate and sand. Blue is reserved for the part in hand.
  static constexpr std::array<std::array<float, 3>, 6> kPalette = {{{0.55f, 0.57f, 0.60f},
                                                                    {0.60f, 0.43f, 0.17f},
                                                                    {0.34f, 0.46f, 0.36f},
                                                                    {0.52f, 0.27f, 0.18f},
                                                                    {0.26f, 0.30f, 0.34f},
                                                                    {0.66f, 0.58f, 0.45f}}};
  RenderScene drawn;
  std::size_t next = 0;
  for (const scenes::ScenePart& part : scene.parts) {
    const bool has_color = part.part.color != scenes::Part().color;
    drawn.push_back({&part.part.mesh, has_color ? part.part.color : kPalette[next++ % kPalette.size()],
                     part.is_fixed, part.X_WP});
    if (!part.part.face_colors.isNone()) drawn.back().face_colors = &part.part.face_colors;
  }
  return drawn;
}

CutPlane sectionAlong(const Vec3& p_W, const Vec3& d_W, const Vec3& to_viewer_W) {
  const Vec3 viewer = to_viewer_W.normalized();
  const Vec3 d = d_W.norm() > 0 ? Vec3(d_W.normalized()) : Vec3(Vec3::UnitZ());
  CutPlane cut;
  cut.p_W = p_W;
  double best = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 n = Vec3::Unit(axis) * (viewer[axis] < 0 ? -1 : 1);
    constexpr double kSinFiveDegrees = 0.087;  // a motion at a smaller angle counts as in the plane
    if (std::abs(n.dot(d)) < kSinFiveDegrees && n.dot(viewer) > best) {
      best = n.dot(viewer);
      cut.n_W = n;
    }
  }
  if (best < 0.3) {  // no axis qualifies: the plane through the motion that faces the viewer most
    const Vec3 across = viewer - viewer.dot(d) * d;
    cut.n_W = across.norm() > 1e-6 ? Vec3(across.normalized()) : Vec3(d.unitOrthogonal());
  }
  return cut;
}

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
