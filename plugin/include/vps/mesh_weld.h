// SPDX-License-Identifier: BSD-3-Clause
// Welding of a mesh whose triangles have properties of their own, such as a colour.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

struct WeldedMesh {
  Mesh mesh;                           ///< as returned by welded()
  std::vector<std::uint32_t> sources;  ///< for each triangle its number in the given mesh, ascending
};

/// As welded(), but also tells which triangle of the given mesh each triangle was.
VPS_API WeldedMesh weldedWithSources(const Mesh& mesh, double tolerance_m = 0);

}  // namespace vps
