// SPDX-License-Identifier: BSD-3-Clause
// Names of the mesh files of a scene.
#pragma once

#include <set>
#include <string>

namespace vps::viewer {

/// A file name made from a part's name, different from those in `taken`, to which it is added. Binary PLY
/// would be smaller than STL, but the assimp of Debian 12 reads a first data byte of 0x0A as a line end.
/// @param extension  meshExtension() of its mesh
std::string partFileName(const std::string& name, const std::string& extension, std::set<std::string>& taken);

}  // namespace vps::viewer
