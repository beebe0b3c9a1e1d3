// SPDX-License-Identifier: BSD-3-Clause
// The pairs of parts that are timed, with their models; and how the second moves.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "rival.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps::bench {

enum class Pair { PegInPlate, PlanetInRing, RodInNut, RingOnItself };

/// How large models are. The defaults are those of the table; tests of the program take less.
struct SceneSize {
  std::size_t points = 185'030;  ///< the paper's load; the shell has exactly as many
  int voxels = 512;              ///< along the longest side of the map's part
  int coarser = 1;               ///< divides the meshes' steps; 1 gives about 200,000 triangles
  bool operator==(const SceneSize&) const = default;
};

struct Scene {
  Mesh map_mesh, shell_mesh;
  VoxMapSettings settings;
  VoxMap map;
  PointShell shell;
  std::shared_ptr<const RivalField> field;  ///< meshToVolume's, as it comes
};

inline constexpr double kBandVoxels = 4;

/// The two parts alone, map first.
std::pair<Mesh, Mesh> meshesOf(Pair pair, int coarser);
/// Size of a voxel [m] of which `voxels` span the longest side.
double voxelFor(const Mesh& mesh, int voxels);
/// A shell of exactly `points` points: the spacing is searched for, the few too many are the last of its
/// progressive order.
PointShell shellOfSize(const Mesh& mesh, std::size_t points);
/// The points first to first + count of a shell, as a shell.
PointShell patchOf(const PointShell& shell, std::size_t first, std::size_t count);
/// Takes seconds. Deterministic. The last one is kept, and so are its map or its shell where the next has the
/// same.
std::shared_ptr<const Scene> sceneOf(Pair pair, const SceneSize& size);

/// Pose of the shell's part in the map's part at a step; deterministic, never twice the same in a run.
using Motion = std::function<Pose(int step)>;

/// A peg that slides in and out of a bore, turning a little, pressed to one side. step_m: travel of its
/// points each step.
Motion pegMotion(double step_m);
/// A planet wheel that rolls in its ring, one flank touching.
Motion gearMotion(double step_m);
/// A rod that turns in its nut by its thread, to and fro by one turn, one side of its flanks touching.
Motion screwMotion(double step_m);
/// A planet wheel over the ring's face at 0.5 to 4 mm, turning and tilting.
Motion hoverMotion(double step_m);
/// A planet wheel that tumbles far from the ring.
Motion freeMotion(double step_m);
/// A part that trembles within its own surface by up to 30 um.
Motion trembleMotion(double step_m);

}  // namespace vps::bench
