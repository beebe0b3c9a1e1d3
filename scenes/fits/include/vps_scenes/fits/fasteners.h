// SPDX-License-Identifier: BSD-3-Clause
// Fasteners of an assembly, recognised by their shapes.
#pragma once

#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

enum class FastenerKind {
  Screw,    ///< a thread with a head, or a plain shank whose head has faces for a wrench or a key
  Stud,     ///< a thread without a head
  Nut,      ///< a part with an internal thread, or a polygon around a plain hole
  Washer,   ///< a flat ring
  Pin,      ///< a plain cylinder
  Key,      ///< a bar between two parts
  Circlip,  ///< a thin open ring
  /// A plain shank of a metric size with a round head: a clevis pin, or a screw drawn without thread and
  /// drive.
  HeadedPin,
};
VPS_SCENES_API const char* toText(FastenerKind kind);

/// A part that has the shape of a fastener.
struct Fastener {
  std::string part;
  FastenerKind kind = FastenerKind::Screw;
  std::string words;  ///< kind and sizes: "screw M8 x 30, hexagon head"
};

/// Finds the fasteners among the parts, in the order of the parts, from the shape of each part alone. Keys
/// are not found by this function: planAssembly() recognises keys by their fits. A cylinder with fewer than
/// 16 sides counts as a prism and is not found. Throws LoadError for a part that cannot be measured.
VPS_SCENES_API std::vector<Fastener> findFasteners(const std::vector<DrawnPart>& parts,
                                                   const Progress& progress = {});

}  // namespace vps::scenes
