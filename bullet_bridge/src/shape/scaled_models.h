// SPDX-License-Identifier: BSD-3-Clause
// A part's models, larger or smaller.
#pragma once

#include "vps_bullet/shape.h"

namespace vps::bullet {

/// Models of the part made `factor` times as large about the origin of their frame M. Shell and mesh are
/// scaled copies, the map and the exact surfaces are built anew, on a grid scaled alike: as many voxels, the
/// same quality. Costs what building them cost. A map that was fine only in regions becomes fine everywhere.
/// Throws std::invalid_argument for models with a map but neither surfaces nor a mesh to build it from.
ShapeModels scaledModels(const ShapeModels& models, double factor);

}  // namespace vps::bullet
