// SPDX-License-Identifier: BSD-3-Clause
// Welding of a mesh whose triangles have properties of their own, such as a colour.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

struct WeldedMesh {
  Mesh mesh;                           ///< as welded() gives it
  std::vector<std::uint32_t> sources;  ///< by triangle: its number before, ascending
};

/// As welded(), with the triangle that each one was.
VPS_API WeldedMesh weldedWithSources(const Mesh& mesh, double tolerance_m = 0);

}  // namespace vps
