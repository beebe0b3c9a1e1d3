// SPDX-License-Identifier: BSD-3-Clause
// The sharp edges of a mesh, along which bodies touch first.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// Returns the vertex pairs of edges whose two faces differ by more than angle_rad, and of all edges that do
/// not have exactly two triangles, in ascending order. Expects shared vertices (see welded()). O(n log n).
VPS_API std::vector<std::array<std::uint32_t, 2>> sharpEdges(const Mesh& mesh, double angle_rad);

}  // namespace vps
