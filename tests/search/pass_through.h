// SPDX-License-Identifier: BSD-3-Clause
// Whether a body went through another one within a step, so that no pose shows an overlap.
#pragma once

#include "vps/mesh_overlap.h"

namespace vps::search {

/// True if a vertex of `a`, outside `b` before and after, went through more than margin_m of b's material on
/// a straight path from one pose to the other.
/// @param X_BA_before, X_BA_after  poses of a in b
bool hasPassedThrough(const OverlapMesh& a, const OverlapMesh& b, const Pose& X_BA_before,
                      const Pose& X_BA_after, double margin_m);

}  // namespace vps::search
