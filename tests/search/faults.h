// SPDX-License-Identifier: BSD-3-Clause
// Puts faults of CAD exports into a closed mesh.
#pragma once

#include "support/random_draw.h"
#include "vps/mesh.h"

namespace vps::search {

using test::Random;

/// Vertices along a crack are moved by kCrack_m at most, so that the surface stays nearly unchanged.
inline constexpr double kCrack_m = 0.5e-6;

/// The same solid with unshared vertices and one to three further faults: cracks, T-junctions, turned facets,
/// the whole mesh turned, repeated facets.
Mesh withFaults(const Mesh& mesh, Random& random);

}  // namespace vps::search
