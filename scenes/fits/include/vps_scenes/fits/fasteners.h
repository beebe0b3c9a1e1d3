// SPDX-License-Identifier: BSD-3-Clause
// Fasteners of an assembly, recognised by their shapes.
#pragma once

#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

enum class FastenerKind {
  Screw,    ///< a round shank with a head, threaded or drawn plain
  Stud,     ///< a thread without a head
  Nut,      ///< with a thread inside, or a polygon around a plain hole
  Washer,   ///< a flat ring
  Pin,      ///< a plain cylinder
  Key,      ///< a bar between two parts
  Circlip,  ///< a thin open ring
};
VPS_SCENES_API const char* toText(FastenerKind kind);

struct Fastener {
  std::string part;
  FastenerKind kind = FastenerKind::Screw;
  std::string words;  ///< with its sizes: "screw M8 x 30, hexagon head"
};

/// The fasteners among the parts, in their order, by the shape of each part alone; a key needs its fits and
/// is only found by planAssembly(). Cylinders with fewer than 16 sides are prisms, and are not found. Throws
/// LoadError for parts that cannot be measured.
VPS_SCENES_API std::vector<Fastener> findFasteners(const std::vector<DrawnPart>& parts,
                                                   const Progress& progress = {});

}  // namespace vps::scenes
