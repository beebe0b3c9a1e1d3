// SPDX-License-Identifier: BSD-3-Clause
// Triangles of Bullet as a Mesh, and a Shape from what a file in Bullet's format holds of it.
#pragma once

#include <memory>

#include "vps/mesh.h"
#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"
#include "vps_bullet/shape.h"

class btStridingMeshInterface;

namespace vps::bullet {

/// All triangles, with equal vertices joined and the interface's scaling applied. Throws
/// std::invalid_argument for a mesh without triangles, with a vertex that is not finite, or with an index
/// beyond its vertices.
VPS_BULLET_API Mesh meshOf(const btStridingMeshInterface& triangles);

/// Null if `saved_as` is not what Shape::serialize() writes. Throws LoadError for numbers out of range and as
/// buildPartModel().
/// @param saved_as  the name that the file gives the shape
VPS_BULLET_API std::unique_ptr<Shape> restoreShape(const char* saved_as,
                                                   const btStridingMeshInterface& triangles);

}  // namespace vps::bullet
