// SPDX-License-Identifier: BSD-3-Clause
// Mesh files that a command writes: their names, and their bytes as binary STL or as OBJ.
#pragma once

#include <set>
#include <string>

#include "vps/mesh.h"
#include "vps_scenes/cad/colors.h"

namespace vps::viewer {

/// The mesh as a binary STL file, in metres. Coordinates are floats, which resolve 0.06 um at 1 m; vertices
/// that are equal stay equal to the bit, so that readers can weld them.
std::string stlBytes(const Mesh& mesh);

/// File extension that suits the mesh: ".obj" if its faces have colours, or if it is so far from its origin
/// that the floats of STL would move its vertices by more than 0.1 um; else ".stl".
std::string meshExtension(const Mesh& mesh, const scenes::FaceColors& colors = {});
/// The bytes of a file with the extension meshExtension(), in metres. OBJ coordinates are as precise as
/// floats relative to the size of the mesh; OBJ colours (sRGB) are stored by vertex.
std::string meshBytes(const Mesh& mesh, const scenes::FaceColors& colors = {});

/// A file name made from a part's name, different from the names in `taken`, to which the new name is added.
/// Binary PLY would be smaller than STL, but the assimp of Debian 12 reads a first data byte of 0x0A as a
/// line end.
/// @param extension  meshExtension() of the part's mesh
std::string partFileName(const std::string& name, const std::string& extension, std::set<std::string>& taken);

}  // namespace vps::viewer
