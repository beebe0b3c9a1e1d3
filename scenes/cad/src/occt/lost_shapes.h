// SPDX-License-Identifier: BSD-3-Clause
// Shapes of a STEP file of which its reader made nothing.
#pragma once

#include <string>

#include <XSControl_Reader.hxx>

namespace vps::scenes::import {

/// Losses in a file that the reader has transferred, in words; a text is empty if there is no such loss.
struct LostShapes {
  /// Instances of products with a shape that have no placement, so that the assembly lacks them.
  std::string unplaced;
  /// Solids that belong to no product, of kinds that Open CASCADE does not make, or whose translation failed.
  std::string left_out;
};

/// O(entities).
LostShapes lostShapes(const XSControl_Reader& reader);

}  // namespace vps::scenes::import
