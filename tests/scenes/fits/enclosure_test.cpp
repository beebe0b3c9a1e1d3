// SPDX-License-Identifier: BSD-3-Clause
// Proofs that a part cannot leave another one. Whether it can is known by construction.
#include "proof/enclosure.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "search/prism.h"
#include "support/units.h"

namespace vps::scenes {
namespace {

using search::Polygon;
using search::rectangle;

PartSurface closedSurface(const Mesh& mesh) {
  return {std::make_shared<const Solid>(mesh), 0.0};
}

Enclosure enclosed(const Mesh& part, const Mesh& base, const Vec3& round_axis = Vec3::Zero()) {
  const PartSurface moving = closedSurface(part), rest = closedSurface(base);
  const Obstacle obstacle{&rest, Pose(), 0.5e-6};
  return enclosureOf(moving, Pose(), std::span(&obstacle, 1), Vec3::Zero(), round_axis, 20'000'000);
}

Polygon boxOf(double x_m, double y_m) {
  return rectangle({-0.5 * x_m, -0.5 * y_m}, {0.5 * x_m, 0.5 * y_m});
}

/// A block with a chamber, whose opening at the top has another outline; the chamber's bottom is at -3 mm.
Mesh chamber(const Polygon& inside, double height_m, const Polygon& opening) {
  const Polygon outline = boxOf(30 * kMm, 30 * kMm);
  Mesh mesh = search::makePrism(outline, {}, -8 * kMm, -3 * kMm);
  append(mesh, search::makePrism(outline, {inside}, -3 * kMm, -3 * kMm + height_m));
  append(mesh, search::makePrism(outline, {opening}, -3 * kMm + height_m, 3 * kMm + height_m));
  return mesh;
}

TEST(Enclosure, ABlockUnderAnOpeningThatIsTooSmallByLittle) {
  for (const double room_m : {20 * kUm, 200 * kUm})
    for (const double by_m : {10 * kUm, -10 * kUm}) {
      const Mesh base = chamber(boxOf(10 * kMm + room_m, 8 * kMm + room_m), 6 * kMm + room_m,
                                boxOf(10 * kMm - by_m, 8 * kMm + room_m));
      EXPECT_EQ(enclosed(makeBox({10 * kMm, 8 * kMm, 6 * kMm}), base).is_proven, by_m > 0);
    }
}

// The pin is round up to the facets' error, which is more than the openings differ; as a prism it may not
// turn, here with the drawn rotation about its axis.
TEST(Enclosure, APinUnderAnOpeningThatIsTooSmallByLittle) {
  const Mesh pin = search::makePrism(search::regularPolygon(24, 5 * kMm), {}, -3 * kMm, 3 * kMm);
  for (const double by_m : {50 * kUm, -10 * kUm}) {
    const Mesh base = chamber(search::regularPolygon(24, 5 * kMm + 20 * kUm), 6 * kMm + 20 * kUm,
                              search::regularPolygon(24, 5 * kMm - 0.5 * by_m));
    EXPECT_EQ(enclosed(pin, base, Vec3::UnitZ()).is_proven, by_m > 0) << by_m;
  }
}

// A block of 10 x 8 x 6 mm in a closed cavity with some room: it can never leave.
TEST(Enclosure, ABlockInACavityIsEnclosed) {
  for (const double room_m : {10 * kUm, 100 * kUm, 1 * kMm}) {
    Mesh cavity = makeBox({30 * kMm, 30 * kMm, 30 * kMm});
    Mesh inner = makeBox(Vec3(10 * kMm, 8 * kMm, 6 * kMm) + Vec3::Constant(room_m));
    for (auto& t : inner.triangles) std::swap(t[1], t[2]);
    append(cavity, inner);
    EXPECT_TRUE(enclosed(makeBox({10 * kMm, 8 * kMm, 6 * kMm}), cavity).is_proven) << room_m;
  }
}

}  // namespace
}  // namespace vps::scenes
