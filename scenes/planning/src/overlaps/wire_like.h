// SPDX-License-Identifier: BSD-3-Clause
// Tells wires (springs, belts, rings of seals, bent rods) from shells, plates and solids.
#pragma once

#include "vps/mesh.h"

namespace vps::scenes {

/// Measures of a surface that is cut into bands of equal distance from one of its ends, measured along the
/// surface. A wire has one or two narrow bands at every distance, a shell has bands as wide as itself, and a
/// perforated plate has many bands.
struct WireMeasure {
  double length_m = 0;  ///< along the centre line; of a loop, its circumference
  double width_m = 0;   ///< mean diagonal of the box of a band
  double bands = 0;     ///< number of bands per distance that 95 % of all distances do not exceed
  [[nodiscard]] double slenderness() const { return width_m > 0 ? length_m / width_m : 0; }
};

/// Measures on a grid of cells along the surface. A cell is as wide as a quarter of the thickness of a round
/// wire, or wider so that there are at most about 50,000 cells; turns of a spring that are nearer to each
/// other than two cells are merged. Empty for a mesh without volume or area. O(cells log cells). The result
/// is the same on every machine.
WireMeasure measureWire(const Mesh& mesh);

/// Whether a part is much longer than wide, with at most two bands at each distance from its end.
bool isWireLike(const Mesh& mesh);

}  // namespace vps::scenes
