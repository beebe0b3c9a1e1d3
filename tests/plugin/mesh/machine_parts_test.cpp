// SPDX-License-Identifier: BSD-3-Clause
// The parts of the benchmarks are closed, face outward, have the stated size, and do not touch where they
// have clearance.
#include <gtest/gtest.h>

#include <numbers>

#include "support/fit.h"
#include "support/gear.h"
#include "support/screw.h"
#include "support/units.h"
#include "vps/mesh_distance.h"

namespace vps::test {
namespace {

void expectClosedSolid(const Mesh& mesh) {
  const MeshReport report = checkMesh(mesh);
  EXPECT_TRUE(report.isClosed());
  EXPECT_EQ(report.shells, 1u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  EXPECT_GT(massProperties(mesh).volume_m3, 0);  // the facets face outward
}

double leastDistance(const Mesh& of, const Mesh& points, const Pose& X_MP) {
  const MeshDistance distance(of);
  double least_m = 1e300;
  for (const Vec3& p : points.vertices) least_m = std::min(least_m, distance.signedDistance(X_MP * p));
  return least_m;
}

/// Uses fewer points than the benchmarks, for the same shapes.
GearShape smallGear(int teeth, double other_radius_m) {
  return {.teeth = teeth,
          .backlash_m = 0.02 * kMm,
          .other_radius_m = other_radius_m,
          .points_per_tooth = 32,
          .axial_steps = 2,
          .radial_steps = 2};
}

TEST(MachineParts, AllAreClosedOutwardAndInOnePiece) {
  expectClosedSolid(makeSpurGear(smallGear(30, 5 * kMm)));
  expectClosedSolid(makeRingGear(smallGear(72, 42 * kMm)));
  expectClosedSolid(makeThreadedRod({.columns = 48, .rows_per_pitch = 16}));
  expectClosedSolid(makeNut({.clearance_m = 0.05 * kMm, .columns = 48, .rows_per_pitch = 16}, 12 * kMm));
  expectClosedSolid(makePeg({.columns = 64, .rows = 4}));
  expectClosedSolid(makeBoredPlate({.columns = 64, .bore_rows = 4}));
  expectClosedSolid(makeTorus(10 * kMm, 3 * kMm, 64, 32));
}

TEST(MachineParts, GearsInMeshKeepHalfTheirBacklashOnEachFlankAtEveryAngle) {
  const GearShape ring = smallGear(72, 42 * kMm), planet = smallGear(30, 5 * kMm);
  const Mesh ring_mesh = makeRingGear(ring), planet_mesh = makeSpurGear(planet);
  const double apart_m = pitchRadius(ring) - pitchRadius(planet);
  for (int k = 0; k < 7; ++k) {  // over one tooth
    const double planet_rad = kTurn_rad / planet.teeth * k / 7;
    const double ring_rad = planet_rad * planet.teeth / ring.teeth;
    const Pose X_WR(rotationFromVector({0, 0, ring_rad}), Vec3::Zero());
    const Pose X_WP(rotationFromVector({0, 0, planet_rad}), {apart_m, 0, 0});
    // Half of 0.02 mm goes to each side of a tooth, measured along the pitch circle: 0.02 cos 20 degrees
    // across the flanks. With steps of 0.19 mm chords deviate from the involute by 0.19^2 / 8r: 0.9 um on the
    // planet (r = 5 mm at the pitch circle), 0.4 um in the ring (12 mm). Measured: 0.4 um.
    const double least_m = leastDistance(ring_mesh, planet_mesh, X_WR.inverse() * X_WP);
    EXPECT_NEAR(least_m, 0.02 * kMm * std::cos(20 * std::numbers::pi / 180), 0.0013 * kMm) << k;
  }
}

TEST(MachineParts, RodTurnsInItsNutWithHalfTheRadialClearanceAcrossTheFlanks) {
  const ThreadShape rod{.length_m = 6 * kMm, .columns = 96, .rows_per_pitch = 32};
  ThreadShape nut = rod;
  nut.clearance_m = 0.05 * kMm;
  const Mesh rod_mesh = makeThreadedRod(rod), nut_mesh = makeNut(nut, 12 * kMm);
  for (const double turn_rad : {0.0, 0.3, 2.0}) {
    const Pose X_MP(rotationFromVector({0, 0, turn_rad}), {0, 0, rod.pitch_m * turn_rad / kTurn_rad});
    // Flanks are inclined by 30 degrees to the radius, and climb the helix (5.5 degrees at the root), which
    // takes a further fraction 1 - cos. Chords lie inside of circles by 6 mm (1 - cos(pi / 96)) = 3.2 um;
    // half of that across the flank.
    const double least_m = leastDistance(nut_mesh, rod_mesh, X_MP);
    EXPECT_NEAR(least_m, 0.05 * kMm * std::sin(std::numbers::pi / 6), 0.002 * kMm) << turn_rad;
  }
}

TEST(MachineParts, PegAndBoreHaveTheVolumeOfTheirFormulas) {
  const PegShape peg{.chamfer_m = 0, .columns = 256, .rows = 4};
  const double share = std::sin(kTurn_rad / 256) / (kTurn_rad / 256);  // of a circle in its polygon
  const double peg_m3 = std::numbers::pi * peg.radius_m * peg.radius_m * peg.length_m * share;
  EXPECT_NEAR(massProperties(makePeg(peg)).volume_m3 / peg_m3, 1, 1e-12);
  const PlateShape plate{.columns = 256, .bore_rows = 4};
  const double plate_m3 =
      plate.height_m * (plate.side_m * plate.side_m - std::numbers::pi * plate.bore_m * plate.bore_m * share);
  EXPECT_NEAR(massProperties(makeBoredPlate(plate)).volume_m3 / plate_m3, 1, 1e-12);
}

}  // namespace
}  // namespace vps::test
