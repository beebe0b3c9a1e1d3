// SPDX-License-Identifier: BSD-3-Clause
// Mesh files that a command writes: their names, and their bytes as binary STL or as OBJ.
#pragma once

#include <set>
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

/// A file name made from a part's name, different from those in `taken`, to which it is added. Binary PLY
/// would be smaller than STL, but the assimp of Debian 12 reads a first data byte of 0x0A as a line end.
/// @param extension  meshExtension() of its mesh
std::string partFileName(const std::string& name, const std::string& extension, std::set<std::string>& taken);

}  // namespace vps::viewer
