// SPDX-License-Identifier: BSD-3-Clause
// Removes facets without area. Programs that fill T-junctions make them: three corners in a line.
#pragma once

#include <optional>

#include "vps/mesh.h"

namespace vps {

/// The mesh without facets of no area. The facet across the longest side of each such facet is split at its
/// middle corner, so that a closed mesh stays closed. Vertices stay. Nothing if some facet could not be left
/// out. O(n log n).
std::optional<Mesh> withoutFlatFacets(Mesh mesh);

}  // namespace vps
