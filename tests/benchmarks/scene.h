// SPDX-License-Identifier: BSD-3-Clause
// The timed pairs of parts with their models, and the motion of the second part.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "rival.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps::bench {

enum class Pair { PegInPlate, PlanetInRing, RodInNut, RingOnItself };

/// The size of the models. The defaults are the sizes of the table; tests of the program use smaller ones.
struct SceneSize {
  std::size_t points = 185'030;  ///< the paper's load; the shell has exactly this number of points
  int voxels = 512;              ///< number of voxels along the longest side of the map's part
  int coarser = 1;               ///< divisor of the meshes' steps; 1 gives about 200,000 triangles
  bool operator==(const SceneSize&) const = default;
};

struct Scene {
  Mesh map_mesh, shell_mesh;
  VoxMapSettings settings;
  VoxMap map;
  PointShell shell;
  std::shared_ptr<const RivalField> field;  ///< field of meshToVolume with default settings
};

inline constexpr double kBandVoxels = 4;

/// The meshes of the two parts, the part with the map first.
std::pair<Mesh, Mesh> meshesOf(Pair pair, int coarser);
/// Size [m] of a voxel if `voxels` voxels span the longest side.
double voxelFor(const Mesh& mesh, int voxels);
/// A shell of exactly `points` points: the spacing is searched for, and the surplus points at the end of the
/// progressive order are removed.
PointShell shellOfSize(const Mesh& mesh, std::size_t points);
/// A shell of the points from first to first + count of a shell.
PointShell patchOf(const PointShell& shell, std::size_t first, std::size_t count);
/// Builds a scene deterministically, which takes seconds. The last scene is kept, and the next scene reuses
/// the map or the shell of the last scene if it is the same.
std::shared_ptr<const Scene> sceneOf(Pair pair, const SceneSize& size);

/// Pose of the shell's part in the map's part at a step; deterministic, never the same twice in a run.
using Motion = std::function<Pose(int step)>;

/// A peg that slides in and out of a bore, rotates a little and is pressed to one side. step_m: travel of the
/// peg's points in each step.
Motion pegMotion(double step_m);
/// A planet wheel that rolls in its ring with one flank in contact.
Motion gearMotion(double step_m);
/// A rod that turns in its nut along the thread, by one turn forth and back, with one side of its flanks in
/// contact.
Motion screwMotion(double step_m);
/// A planet wheel that turns and tilts at 0.5 to 4 mm above the ring's face.
Motion hoverMotion(double step_m);
/// A planet wheel that tumbles far from the ring.
Motion freeMotion(double step_m);
/// A part that vibrates within its own surface by up to 30 um.
Motion trembleMotion(double step_m);

}  // namespace vps::bench
