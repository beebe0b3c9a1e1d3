// SPDX-License-Identifier: BSD-3-Clause
// A mesh as a binary STL file, or as an OBJ file where the floats of STL are too coarse.
#pragma once

#include <string>

#include "vps/mesh.h"
#include "vps_scenes/cad/face_colors.h"

namespace vps::viewer {

/// The bytes of the file, in metres. Coordinates are floats, which resolve 0.06 um at 1 m; vertices that are
/// equal stay equal to the bit, so that readers can weld them.
std::string stlBytes(const Mesh& mesh);

/// ".stl", or ".obj" for a mesh whose faces have colours, or that is so far from its origin that floats would
/// move its vertices by more than 0.1 um.
std::string meshExtension(const Mesh& mesh, const scenes::FaceColors& colors = {});
/// A file with that extension, in metres. OBJ reads back within a float's resolution of the mesh's size, and
/// has colours (sRGB) by vertex.
std::string meshBytes(const Mesh& mesh, const scenes::FaceColors& colors = {});

}  // namespace vps::viewer
