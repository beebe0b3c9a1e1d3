// SPDX-License-Identifier: BSD-3-Clause
// The surface of a part that is smaller or larger than drawn: pressed in, or off its size.
#pragma once

#include "vps/mesh.h"

namespace vps::scenes {

/// The same facets, each moved inwards by the given distance, or outwards for a negative one. Where the
/// facets at a corner leave no such place, it is the nearest one. For distances far below the size of the
/// facets.
Mesh shrunkMesh(const Mesh& mesh, double by_m);

}  // namespace vps::scenes
