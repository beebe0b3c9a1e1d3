// SPDX-License-Identifier: BSD-3-Clause
#include "families.h"

#include <array>
#include <stdexcept>

#include "faults.h"
#include "prism.h"
#include "vps/solid.h"

namespace vps::search {

namespace {

constexpr std::array kFamilies{
    Family{"tslot", "a T-shaped block in a slot, in hand", drawTSlot},
    Family{"dovetail", "a dovetail in its slot, in hand", drawDovetail},
    Family{"key", "a key in a keyway, in hand", drawKey},
    Family{"square_peg", "a square peg in a square hole, in hand", drawSquarePeg},
    Family{"hexagonal_peg", "a hexagonal peg in its hole, in hand", drawHexagonalPeg},
    Family{"comb", "a comb between the teeth of another, in hand", drawComb},
    Family{"puzzle", "one half of a star in its hole, the other in hand", drawPuzzle},
    Family{"chain", "links that hang from a fixed one or from a hand", drawChain},
    Family{"tetrahedra", "tetrahedra fall into a corner", drawTetrahedra},
    Family{"stairs", "parts tumble down stairs", drawStairs},
    Family{"prisms", "random prisms fall into a box", drawPrisms},
    Family{"rings", "pipes of many sides fall on each other", drawRings},
};

/// Equal seeds of different families are unrelated.
std::uint64_t seedOf(const Family& family, std::uint64_t seed) {
  std::uint64_t hash = 14695981039346656037ull ^ seed;
  for (const char* c = family.name; *c != 0; ++c)
    hash = (hash ^ static_cast<unsigned char>(*c)) * 1099511628211ull;
  return hash;
}

void finish(Case& made, Random& random) {
  for (CaseBody& body : made.bodies) {
    body.mesh = welded(body.mesh);
    body.given = made.is_faulty ? withFaults(body.mesh, random) : body.mesh;
    body.exact = std::make_shared<const OverlapMesh>(std::make_shared<const Solid>(body.mesh));
  }
}

bool isFreeAtStart(const Case& made) {
  std::vector<Pose> poses;
  for (const CaseBody& body : made.bodies) poses.push_back(body.X_WP);
  return !(deepestOverlap(made, poses).overlap.depth_m > 0);
}

}  // namespace

std::span<const Family> families() {
  return kFamilies;
}

const Family* findFamily(const std::string& name) {
  for (const Family& family : kFamilies)
    if (family.name == name) return &family;
  return nullptr;
}

Case makeCase(const Family& family, std::uint64_t seed, bool is_faulty) {
  Random random(seedOf(family, seed));
  for (int attempt = 0; attempt < 1000; ++attempt) {
    Case made;
    try {
      made = family.draw(random);
    } catch (const NotSimple&) {
      continue;
    }
    made.family = family.name;
    made.seed = seed;
    made.is_faulty = is_faulty;
    finish(made, random);
    if (isFreeAtStart(made)) return made;
  }
  throw std::logic_error(std::string(family.name) + ": all draws overlap at the start");
}

CaseOverlap deepestOverlap(const Case& made, const std::vector<Pose>& poses) {
  CaseOverlap worst;
  std::vector<Box> boxes_W;
  for (std::size_t i = 0; i < poses.size(); ++i)
    boxes_W.push_back(moved(made.bodies[i].exact->box(), poses[i]));
  for (std::size_t b = 0; b < poses.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      if (made.bodies[a].is_fixed && made.bodies[b].is_fixed) continue;
      if (!overlap(boxes_W[a], boxes_W[b])) continue;
      const Overlap found = deepestOverlap(*made.bodies[a].exact, poses[a], *made.bodies[b].exact, poses[b]);
      if (found.depth_m > worst.overlap.depth_m) worst = {found, a, b};
    }
  return worst;
}

}  // namespace vps::search
