// SPDX-License-Identifier: BSD-3-Clause
// Tells wires (springs, belts, rings of seals, bent rods) from shells, plates and solids.
#pragma once

#include "vps/mesh.h"

namespace vps::scenes {

/// A surface cut into bands of equal distance from one of its ends, measured along the surface: a wire has
/// one or two narrow bands at every distance, a shell has bands as wide as itself, and a perforated plate has
/// many.
struct WireMeasure {
  double length_m = 0;  ///< along the centre line, a loop all around
  double width_m = 0;   ///< mean diagonal of a section's box
  double bands = 0;     ///< greatest count that at least a twentieth of all distances have
  [[nodiscard]] double slenderness() const { return width_m > 0 ? length_m / width_m : 0; }
};

/// Measures on a grid of cells along the surface, of a quarter of the thickness of a round wire, and of at
/// most some 50,000 cells; turns of a spring that are nearer to each other than two cells are taken for one.
/// Empty for a mesh without volume or area. O(cells log cells). The same result on every machine.
WireMeasure measureWire(const Mesh& mesh);

/// Whether a part is long beside its width, and has no more than two sections at a distance from its end.
bool isWireLike(const Mesh& mesh);

}  // namespace vps::scenes
