// SPDX-License-Identifier: BSD-3-Clause
// Finds a thread on a part's mesh.
#pragma once

#include <optional>

#include "vps/mesh.h"

namespace vps::scenes {

struct ThreadForm {
  double lead_m = 0;       ///< its way in one turn; negative: a left-hand thread
  int starts = 1;          ///< threads side by side; the pitch is the lead divided by this
  bool is_inside = false;  ///< in a bore
};

/// The thread around an axis: the surface's distance from the axis is nearly periodic along a helix over two
/// turns or more. Nothing if there is none, or if it is shallower than a twentieth of its pitch.
/// @param p, axis  the axis, in the part's frame; unit
/// Accuracy: a hundredth of the lead for five turns, more for fewer. Some 0.2 s for 50,000 triangles.
std::optional<ThreadForm> findThread(const Mesh& mesh, const Vec3& p, const Vec3& axis);
/// The same on the outside of a solid, or in a bore.
std::optional<ThreadForm> findThread(const Mesh& mesh, const Vec3& p, const Vec3& axis, bool is_inside);

}  // namespace vps::scenes
