// SPDX-License-Identifier: BSD-3-Clause
// Cavities that no way leads into.
#pragma once

#include "vps/mesh.h"
#include "vps/pose.h"

namespace vps::scenes {

/// True if a part lies in a cavity of another, behind a closed shell that faces in. Parts that close a room
/// together are not seen, and neither is a room of which the part touches the wall with all of 32 vertices.
/// O(n log n) and the other's triangles for each of these vertices.
/// @param X_OP  of the part in the other part's frame
bool isInClosedRoom(const Mesh& part, const Mesh& other, const Pose& X_OP);

}  // namespace vps::scenes
