// SPDX-License-Identifier: BSD-3-Clause
// Proofs that a part cannot leave another one. Whether it can is known by construction.
#include "proof/enclosure.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "pair/pair_measures.h"
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

DrawnPart drawnAt(const std::string& name, const Mesh& mesh) {
  return {name, mesh, Pose(), {}};
}

bool isPairEnclosed(const std::vector<DrawnPart>& parts) {
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, {});
  return enclosureOfPair(placed[0], placed[1], 5'000'000).is_proven;
}

// All corners of a sleeve with a narrow slot in the shape of an L lie on two cylinders, and the sleeve is not
// round: it turns by 39 degrees until the fin of the shaft is at the slot's leg, and comes off.
TEST(Enclosure, ASleeveWithASlotIsNotRound) {
  const auto arc = [](double from_deg, double to_deg) {  // of a ring, as a polygon
    constexpr int kSteps = 48;
    Polygon out;
    for (const auto& [r_m, from, to] :
         {std::array{13 * kMm, from_deg, to_deg}, std::array{10 * kMm, to_deg, from_deg}})
      for (int i = 0; i <= kSteps; ++i) {
        const double angle_rad = (from + (to - from) * i / kSteps) * std::numbers::pi / 180;
        out.emplace_back(r_m * std::cos(angle_rad), r_m * std::sin(angle_rad));
      }
    return out;
  };
  Mesh sleeve = search::makePrism(search::regularPolygon(48, 13 * kMm),
                                  {search::regularPolygon(48, 10 * kMm)}, 14 * kMm, 20 * kMm);
  append(sleeve, search::makePrism(arc(50, 358.8), {}, 8 * kMm, 14 * kMm));
  append(sleeve, search::makePrism(arc(2.8, 358.8), {}, 0, 8 * kMm));
  Mesh shaft = makeCylinder(9.9 * kMm, 64 * kMm, 48);
  const Mesh fin = makeBox({12 * kMm, 0.6 * kMm, 5.8 * kMm});
  const Mat3 R = rotationFromVector({0, 0, 40 * std::numbers::pi / 180});
  append(shaft, transformed(fin, Pose(R, R * Vec3(10 * kMm, 0, 0) + Vec3(0, 0, 11 * kMm))));
  EXPECT_FALSE(isPairEnclosed({drawnAt("sleeve", sleeve), drawnAt("shaft", shaft)}));
}

// A bar in a round chamber turns by a quarter and leaves through a hole of its own shape. The base is round
// outside and in its chamber, but not in the hole.
TEST(Enclosure, ABarThatTurnsInARoundChamberLeavesThroughAHoleOfItsShape) {
  const Polygon outline = search::regularPolygon(96, 10 * kMm);
  Mesh base = search::makePrism(outline, {}, -8 * kMm, -3.05 * kMm);
  append(base,
         search::makePrism(outline, {search::regularPolygon(96, 3.0584 * kMm)}, -3.05 * kMm, 3.05 * kMm));
  append(base, search::makePrism(outline, {boxOf(1.204 * kMm, 5.88 * kMm)}, 3.05 * kMm, 8 * kMm));
  EXPECT_FALSE(
      isPairEnclosed({drawnAt("base", base), drawnAt("bar", makeBox({5.876 * kMm, 1.2 * kMm, 6 * kMm}))}));
}

// A cone of strips of unequal width is farther from the true cone than the narrow strips tell. With 50 um of
// true clearance the cones do not touch, though their facets cross by more than a hundred.
TEST(Enclosure, FacetsOfUnequalWidthProveNothingAboutTheTrueFaces) {
  const auto cone = [](double wider_m, bool is_plug, double shift_rad) {
    Mesh mesh;
    std::vector<double> angles;
    double at = shift_rad;
    for (int i = 0; i < 16; ++i) {
      angles.push_back(at);
      angles.push_back(at + 0.02);
      at += 2 * std::numbers::pi / 16;
    }
    const auto n = static_cast<std::uint32_t>(angles.size());
    const auto add = [&](double r_m, double z_m) {
      for (const double a : angles) mesh.vertices.emplace_back(r_m * std::cos(a), r_m * std::sin(a), z_m);
    };
    const auto join = [&](std::uint32_t low, std::uint32_t high) {
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t k = (i + 1) % n;
        mesh.triangles.push_back({low * n + i, low * n + k, high * n + k});
        mesh.triangles.push_back({low * n + i, high * n + k, high * n + i});
      }
    };
    add(10 * kMm + wider_m, 0);
    add(12 * kMm + wider_m, 20 * kMm);
    if (is_plug) {
      add(1 * kMm, 20 * kMm);
      add(1 * kMm, 0);
    } else {
      add(18 * kMm, 20 * kMm);
      add(18 * kMm, 0);
    }
    for (std::uint32_t ring = 0; ring < 4; ++ring) join(ring, (ring + 1) % 4);
    if (!is_plug)
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
  };
  const std::vector<DrawnPart> parts = {drawnAt("hub", cone(0, false, 0)),
                                        drawnAt("plug", cone(-50 * kUm, true, std::numbers::pi / 16))};
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, {});
  EXPECT_GT(meshError_m(placed[0], placed[1]), 200 * kUm);
}

}  // namespace
}  // namespace vps::scenes
