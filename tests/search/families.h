// SPDX-License-Identifier: BSD-3-Clause
// Generators of cases: sharp-edged parts that fit into each other, or fall onto each other.
#pragma once

#include <span>
#include <string>

#include "case.h"
#include "support/random_draw.h"

namespace vps::search {

using test::Random;

struct Family {
  const char* name;
  const char* description;
  Case (*draw)(Random& random);
};

std::span<const Family> families();
/// Null if no family has this name.
const Family* findFamily(const std::string& name);

/// Draws until no bodies overlap at the start.
/// @param is_faulty  gives the engine meshes with cracks, T-junctions, turned or repeated facets
Case makeCase(const Family& family, std::uint64_t seed, bool is_faulty);

// In families_of_fits.cpp: a hand brings one part into another.
Case drawTSlot(Random& random);
Case drawDovetail(Random& random);
Case drawKey(Random& random);
Case drawSquarePeg(Random& random);
Case drawHexagonalPeg(Random& random);
Case drawComb(Random& random);
Case drawPuzzle(Random& random);
// In families_of_falls.cpp: parts fall and tumble.
Case drawChain(Random& random);
Case drawTetrahedra(Random& random);
Case drawStairs(Random& random);
Case drawPrisms(Random& random);
Case drawRings(Random& random);

}  // namespace vps::search
