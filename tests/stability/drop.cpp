// SPDX-License-Identifier: BSD-3-Clause
#include "drop.h"

#include <algorithm>
#include <cmath>

#include "vps_bullet/convert.h"

namespace vps::stability {

namespace {

Mesh mirroredMesh(Mesh mesh) {
  for (Vec3& p : mesh.vertices) p.x() = -p.x();
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

Pose mirroredPose(const Pose& X) {
  const Mat3 mirror = Vec3(-1, 1, 1).asDiagonal();
  return {Mat3(mirror * X.R * mirror), mirror * X.p};
}

Pose startPose(const Drop& what, const Mesh& block) {
  const Mat3 R = rotationFromVector(what.tilt_rad);
  double lowest_m = 1e300;
  for (const Vec3& p : block.vertices) lowest_m = std::min(lowest_m, (R * p).z());
  return {R, Vec3(0, 0, what.fall_m * what.size - lowest_m)};
}

dynamics::PartMesh makePart(Mesh mesh, bool is_mirrored) {
  return dynamics::makePart(is_mirrored ? mirroredMesh(std::move(mesh)) : std::move(mesh));
}

}  // namespace

Dropped drop(Mode mode, const Drop& what) {
  const Mesh block_mesh = makeBox(what.size * kBlock_m);
  const double plate_m = what.size * what.plate_m;
  const dynamics::PartMesh plate_part =
      makePart(makeBox(Vec3(what.size * kPlate_m, what.size * kPlate_m, plate_m)), what.is_mirrored);
  const dynamics::PartMesh block_part = makePart(block_mesh, what.is_mirrored);
  const dynamics::Resolution resolution{what.size * what.voxel_m, what.size * what.spacing_m};
  dynamics::World world({mode, true, dynamics::vpsEngine(resolution, what.settings)});
  const Vec3 down_W = what.X_WS.R * Vec3(0, 0, -1);
  world.setGravity(dynamics::World::kGravity_m_s2 * down_W);
  const auto toScene = [&](const Pose& X_SP) { return what.is_mirrored ? mirroredPose(X_SP) : X_SP; };
  const Placed plate =
      world.add(plate_part, what.X_WS * Pose::translation(Vec3(0, 0, -plate_m / 2)), true, what.friction);
  const Placed block =
      world.add(block_part, what.X_WS * toScene(startPose(what, block_mesh)), false, what.friction);
  block.body->setLinearVelocity(bullet::toBt(Vec3(what.speed_m_s * down_W)));

  Dropped result;
  const auto X_SP = [&] { return what.X_WS.inverse() * block.pose(); };
  result.mass_kg = block_part.frame.mass_kg;
  result.weight_N = result.mass_kg * dynamics::World::kGravity_m_s2;
  result.start_m = X_SP().p.z();
  Watching watching;
  watching.dt_s = what.dt_s;
  watching.step_s = what.step_s;
  watching.steps = std::max(50, static_cast<int>(std::lround(what.duration_s / what.dt_s)));
  watching.before_step = [&](int i) {
    if (i % 10 == 0) result.X_SB_path.push_back(toScene(X_SP()));
  };
  result.watched = watch(world, {plate, block}, watching);
  result.X_SB_path.push_back(toScene(X_SP()));
  result.end_m = X_SP().p.z();
  return result;
}

double allowedDepth_m(Mode mode, const Drop& what, const Dropped& dropped) {
  const double half_m = what.size * kBlock_m.minCoeff() / 2;
  const double step_m = dropped.watched.fastest_m_s * what.dt_s;
  const double turned_m = std::min(half_m, step_m * step_m / (2 * half_m)) + 1e-6;
  if (mode != Mode::Penalty) return turned_m;
  const double fallen_J =
      dropped.weight_N * (dropped.start_m - half_m) + dropped.mass_kg * what.speed_m_s * what.speed_m_s / 2;
  const double spacing_m = what.size * what.spacing_m;
  const double k_N_per_m = what.settings.stiffness_N_per_m3 * spacing_m * spacing_m / 4;
  return turned_m + std::sqrt(2 * fallen_J / k_N_per_m);
}

Judgement judgeDrop(Mode mode, const Drop& what) {
  const Dropped dropped = drop(mode, what);
  Judgement judgement;
  judgeRun(judgement, dropped.watched, dropped.weight_N, allowedDepth_m(mode, what, dropped), what.dt_s);
  judgeRest(judgement, dropped.watched, what.dt_s);
  // The block lies on one of its faces: its height is half a side. A hundredth of the least side
  // distinguishes this position from others. The bridge ignores motion below a micrometre, so the least
  // tolerance is a tenth of a micrometre.
  double off_m = 1e300;
  for (const double side_m : kBlock_m)
    off_m = std::min(off_m, std::abs(dropped.end_m - what.size * side_m / 2));
  judgement.atMost("height over the plate off by", off_m,
                   std::max(0.1e-6, 1e-2 * what.size * kBlock_m.minCoeff() / 2), "m");
  return judgement;
}

}  // namespace vps::stability
