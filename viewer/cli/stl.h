// SPDX-License-Identifier: BSD-3-Clause
// A mesh as a binary STL file.
#pragma once

#include <string>

#include "vps/mesh.h"

namespace vps::viewer::inline v0 {

/// The bytes of the file, in metres. Coordinates are floats, which resolve 0.06 um at 1 m; vertices that are
/// equal stay equal to the bit, so that readers can weld them.
std::string stlBytes(const Mesh& mesh);

}  // namespace vps::viewer::inline v0
