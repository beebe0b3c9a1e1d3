// SPDX-License-Identifier: BSD-3-Clause
// A part's models at another size.
#pragma once

#include "vps_bullet/shape.h"

namespace vps::bullet {

/// Models of the part scaled by `factor` about the origin of their frame M. Shell and mesh are scaled copies.
/// The map and the exact surfaces are built again, the map on a grid scaled by the same factor, with as many
/// voxels and the same quality; that costs as much as building them the first time. Throws
/// std::invalid_argument for models with a map but neither surfaces nor a mesh to build it from.
ShapeModels scaledModels(const ShapeModels& models, double factor);

}  // namespace vps::bullet
