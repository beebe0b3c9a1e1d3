// SPDX-License-Identifier: BSD-3-Clause
// How a free body vibrates: its natural frequencies and the shapes that go with them.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "sound/brick_element.h"
#include "vps/mesh.h"
#include "vps_viewer/export.h"

namespace vps::viewer::inline v0 {

struct ModeSettings {
  std::size_t most_bricks = 700;  ///< filled ones. assumed: modes of a part within a second on one core
  std::size_t most_modes = 40;
  double most_hz = 18000;  ///< higher modes are left out: few people hear them
  int least_across = 2;    ///< bricks across the box's shortest edge
};

/// Modes of one body, in its frame P. Mode i has mass 1: a force f at corner c drives its amplitude q with
/// q'' + w^2 q = shape(i, c) . f, and moves that corner by shape(i, c) q.
struct VPS_VIEWER_API BodyModes {
  double mass_kg = 0;
  double surface_m2 = 0;
  std::vector<double> frequency_hz;     ///< rising
  std::vector<double> normal_rms;       ///< of each mode: rms of its displacement along the surface's normal
  std::vector<Vec3> corners_P;          ///< of the surface
  std::vector<Eigen::Vector3f> shapes;  ///< mode by mode, for each corner

  [[nodiscard]] const Eigen::Vector3f& shape(std::size_t mode, std::size_t corner) const {
    return shapes[mode * corners_P.size() + corner];
  }
  /// The corner nearest to p_P. O(corners).
  [[nodiscard]] std::size_t nearestCorner(const Vec3& p_P) const;
};

/// Finite elements on a grid of bricks that divides the box; of a brick that the surface cuts, stiffness and
/// mass are integrated over what is inside. Curved walls come out too high: of two bricks by 3 %, of one by
/// 10 %, of half a brick by 20 %. Nothing inside, or no mode below most_hz: no modes. O(bricks^2) about.
/// Deterministic.
/// @param isInside  in P
VPS_VIEWER_API BodyModes findModes(const Box& box_P, const std::function<bool(const Vec3& p_P)>& isInside,
                                   double density_kg_m3, const Elasticity& material,
                                   const ModeSettings& settings = {});

}  // namespace vps::viewer::inline v0
