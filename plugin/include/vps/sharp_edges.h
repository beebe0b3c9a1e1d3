// SPDX-License-Identifier: BSD-3-Clause
// Where a mesh turns sharply: the edges along which bodies first touch.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// Vertex pairs of the edges whose two faces turn by more than angle_rad, and of all edges that have not
/// exactly two triangles. In ascending order. Expects shared vertices (see welded()). O(n log n).
VPS_API std::vector<std::array<std::uint32_t, 2>> sharpEdges(const Mesh& mesh, double angle_rad);

}  // namespace vps
