// SPDX-License-Identifier: BSD-3-Clause
// Generated families of wires, and of parts that could be mistaken for wires.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "overlaps/drawn_overlaps.h"
#include "scenes/assemblies_to_plan.h"
#include "support/swept.h"

namespace vps::scenes {
namespace {

/// A round wire along a curve; open ends are capped by discs.
Mesh wire(int columns, double radius_m, bool is_loop, const std::function<Vec3(double)>& curve) {
  constexpr std::uint32_t kSides = 12;
  Mesh mesh;
  for (int i = 0; i <= columns; ++i) {
    const double s = static_cast<double>(i) / columns, ds = 0.5 / columns;
    const Vec3 along = (curve(s + ds) - curve(s - ds)).normalized();
    const Vec3 u = along.cross(Vec3(0.1, 0.2, 1)).normalized(), v = along.cross(u);
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const double a = test::kTurn_rad * k / kSides;
      mesh.vertices.push_back(curve(s) + radius_m * (std::cos(a) * u + std::sin(a) * v));
    }
  }
  const auto rows = static_cast<std::uint32_t>(columns);
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = i * kSides + k, b = i * kSides + (k + 1) % kSides;
      mesh.triangles.push_back({a, b, b + kSides});
      mesh.triangles.push_back({a, b + kSides, a + kSides});
    }
  if (is_loop) return welded(mesh);
  for (std::uint32_t k = 1; k + 1 < kSides; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    mesh.triangles.push_back({rows * kSides, rows * kSides + k, rows * kSides + k + 1});
  }
  return mesh;
}

Mesh spring(double radius_m, double thick_m, double pitch_m, int turns) {
  return wire(32 * turns, thick_m / 2, false, [=](double s) {
    return test::polar(radius_m, test::kTurn_rad * turns * s, pitch_m * turns * s);
  });
}

/// A flat band around two pulleys.
Mesh belt(double apart_m, double radius_m, double thick_m, double width_m) {
  constexpr int kColumns = 64;
  return test::sweptSections(kColumns, [=](int i) {
    const double angle = test::kTurn_rad * (i % kColumns) / kColumns;
    const Vec3 aside(std::cos(angle) > 0 ? apart_m / 2 : -apart_m / 2, 0, 0);
    const auto at = [&](double r, double z) { return Vec3(test::polar(r, angle, z) + aside); };
    return std::vector<Vec3>{at(radius_m, 0), at(radius_m + thick_m, 0), at(radius_m + thick_m, width_m),
                             at(radius_m, width_m)};
  });
}

/// A ring with teeth inside.
Mesh ringGear(double inner_m, double outer_m, double width_m, int teeth) {
  const int columns = 8 * teeth;
  return test::sweptSections(columns, [=](int i) {
    const double angle = test::kTurn_rad * (i % columns) / columns;
    const double in_m = inner_m + 0.06 * inner_m * std::clamp(1.5 * std::sin(teeth * angle), -1.0, 1.0);
    return std::vector<Vec3>{test::polar(in_m, angle, 0), test::polar(outer_m, angle, 0),
                             test::polar(outer_m, angle, width_m), test::polar(in_m, angle, width_m)};
  });
}

Mesh motorCase(double radius_m, double height_m, double wall_m) {
  return test::lathe({{4e-3, 0},
                      {radius_m, 0},
                      {radius_m, height_m},
                      {radius_m - wall_m, height_m},
                      {radius_m - wall_m, wall_m},
                      {4e-3, wall_m}},
                     64);
}

void expectWire(const Mesh& mesh, bool is_wire, const std::string& what) {
  const WireMeasure m = measureWire(mesh);
  EXPECT_EQ(isWireLike(mesh), is_wire) << what << ": " << 1e3 * m.length_m << " mm by " << 1e3 * m.width_m
                                       << " mm, " << m.bands << " bands, slender " << m.slenderness();
}

TEST(WireLike, SpringsBeltsSealsAndBentRodsAre) {
  for (const double thick_m : {0.5e-3, 1e-3, 1.5e-3})
    expectWire(spring(5e-3, thick_m, 2.2 * thick_m, 8), true, "spring");
  for (const double width_m : {4e-3, 6e-3, 10e-3})
    expectWire(belt(0.1, 20e-3, 1.5e-3, width_m), true, "belt");
  for (const double thick_m : {0.5e-3, 0.8e-3, 1e-3}) expectWire(ring(10.5e-3, thick_m), true, "O-ring");
  expectWire(wire(96, 1e-3, false, [](double s) { return Vec3(0.1 * s, 0.02 * std::sin(9 * s), 0); }), true,
             "bent rod");
}

TEST(WireLike, ALengthIsThatOfTheCentreLine) {
  const WireMeasure seal = measureWire(ring(10.5e-3, 1e-3));
  EXPECT_NEAR(seal.length_m, test::kTurn_rad * 10.5e-3, 0.15 * test::kTurn_rad * 10.5e-3);
}

TEST(WireLike, ShellsGearsCupsAndPlatesAreNot) {
  for (const double wall_m : {0.5e-3, 1e-3, 2e-3}) {
    expectWire(motorCase(20e-3, 30e-3, wall_m), false, "motor case");
    expectWire(makeTube(20e-3, 20e-3 - wall_m, 30e-3, 64), false, "tube");
    expectWire(cup(30e-3, wall_m), false, "cup");
    expectWire(block({0, 0, 0}, {0.1, 0.06, wall_m}), false, "plate");
  }
  for (const double width_m : {10e-3, 15e-3, 25e-3})
    expectWire(ringGear(25e-3, 30e-3, width_m, 40), false, "ring gear");
  expectWire(perforatedPlate(8, 10e-3, 4e-3, 2e-3), false, "perforated plate");
  expectWire(makeCylinder(5e-3, 40e-3, 48), false, "pin");
}

TEST(WireLike, AMeshWithoutVolumeIsNone) {
  EXPECT_FALSE(isWireLike(Mesh{}));
  EXPECT_FALSE(isWireLike(Mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}}));
}

}  // namespace
}  // namespace vps::scenes
