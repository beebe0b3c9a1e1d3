// SPDX-License-Identifier: BSD-3-Clause
// Vibration of a free body: its natural frequencies and mode shapes.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "modes/brick_grid.h"
#include "vps/mesh.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct ModeSettings {
  /// Most filled bricks. assumed: modes of a part take at most a second on one core.
  std::size_t most_bricks = 320;
  std::size_t most_modes = 40;
  double most_hz = 18000;  ///< higher modes are left out, since few people hear them
};

/// Modes of one body, in its frame P. Mode i has modal mass 1: a force f at p drives its amplitude q by
/// q'' + w^2 q = shapesAt(p)[i] . f, and the amplitude q displaces p by shapesAt(p)[i] q.
struct VPS_VIEWER_API BodyModes {
  double mass_kg = 0;
  double surface_m2 = 0;
  std::vector<double> frequency_hz;  ///< sorted, the lowest first
  std::vector<double> normal_rms;    ///< rms, in each mode, of the displacement along the surface normal
  BrickGrid grid;                    ///< grid without the fillings of its bricks
  Eigen::MatrixXf nodes;             ///< mode shapes: a column per mode, three rows per node of the grid

  /// Displacement of a point in each mode. A point outside the body moves with the nearest point of a brick.
  /// O(modes).
  [[nodiscard]] std::vector<Vec3> shapesAt(const Vec3& p_P) const;
};

/// Computes modes by finite elements on a grid of bricks that divides the mesh's box. In a brick that the
/// surface cuts, stiffness and mass are integrated over the inside only. With walls down to a sixth of a
/// brick, frequencies are within 3.5 % of thin-shell theory for up to four waves around the circumference.
/// The result is empty if nothing is inside or all modes are above most_hz. About O(bricks^2). Deterministic.
/// @param isInside  tells whether a point, in P, is inside the body
VPS_VIEWER_API BodyModes findModes(const Mesh& mesh_P, const std::function<bool(const Vec3& p_P)>& isInside,
                                   double density_kg_m3, const Elasticity& material,
                                   const ModeSettings& settings = {});

}  // namespace vps::viewer
