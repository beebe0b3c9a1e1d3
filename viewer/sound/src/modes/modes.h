// SPDX-License-Identifier: BSD-3-Clause
// How a free body vibrates: its natural frequencies and the shapes that go with them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "modes/brick_grid.h"
#include "vps/mesh.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct ModeSettings {
  std::size_t most_bricks = 320;  ///< filled ones. assumed: modes of a part within a second on one core
  std::size_t most_modes = 40;
  double most_hz = 18000;  ///< higher modes are left out: few people hear them
};

/// Modes of one body, in its frame P. Mode i has mass 1: a force f at p drives its amplitude q with
/// q'' + w^2 q = shapesAt(p)[i] . f, and moves p by shapesAt(p)[i] q.
struct VPS_VIEWER_API BodyModes {
  double mass_kg = 0;
  double surface_m2 = 0;
  std::vector<double> frequency_hz;  ///< rising
  std::vector<double> normal_rms;    ///< of each mode: rms of its displacement along the surface's normal
  BrickGrid grid;                    ///< without what fills its bricks
  Eigen::MatrixXf nodes;             ///< a column for each mode, three rows for each node of the grid

  /// Of each mode. A point beside the body moves as the nearest place of a brick. O(modes).
  [[nodiscard]] std::vector<Vec3> shapesAt(const Vec3& p_P) const;
};

/// Finite elements on a grid of bricks that divides the mesh's box; of a brick that the surface cuts,
/// stiffness and mass are integrated over what is inside. Walls down to a sixth of a brick come out within
/// 3.5 % of the theory of thin shells in up to four waves around. Nothing inside, or no mode below most_hz:
/// no modes. O(bricks^2) about. Deterministic.
/// @param isInside  in P
VPS_VIEWER_API BodyModes findModes(const Mesh& mesh_P, const std::function<bool(const Vec3& p_P)>& isInside,
                                   double density_kg_m3, const Elasticity& material,
                                   const ModeSettings& settings = {});

}  // namespace vps::viewer
