// SPDX-License-Identifier: BSD-3-Clause
// Finds a thread on a part's mesh.
#pragma once

#include <optional>

#include "vps/mesh.h"

namespace vps::scenes {

struct ThreadForm {
  double lead_m = 0;       ///< travel in one turn; negative: a left-hand thread
  int starts = 1;          ///< number of parallel threads; lead = starts * pitch
  bool is_inside = false;  ///< the thread is in a bore
};

/// Finds a thread around an axis: the surface's distance from the axis is nearly periodic along a helix over
/// two turns or more. The result is empty if there is no thread, or if the thread is shallower than a
/// twentieth of its pitch.
/// @param p, axis  a point of the axis and its unit direction, in the part's frame
/// Accuracy: 1 % of the lead for five turns, lower for fewer turns. Takes about 0.2 s for 50,000 triangles.
std::optional<ThreadForm> findThread(const Mesh& mesh, const Vec3& p, const Vec3& axis);
/// Finds a thread only on the outside of a solid, or only in a bore.
std::optional<ThreadForm> findThread(const Mesh& mesh, const Vec3& p, const Vec3& axis, bool is_inside);

}  // namespace vps::scenes
