// SPDX-License-Identifier: BSD-3-Clause
// Meshes of several shells, compared with the formulas of their union.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/analytic.h"
#include "vps/mesh_repair.h"
#include "vps/solid.h"

namespace vps::test {
namespace {

Mesh block(const Vec3& min, const Vec3& max) {
  return transformed(makeBox(max - min), Pose::translation(0.5 * (min + max)));
}
Mesh joined(Mesh a, const Mesh& b) {
  append(a, b);
  return a;
}
Mesh turned(Mesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// A base of 60 x 20 x 10 mm with two arms of 10 x 20 x 30 mm on its ends, which reach into it.
Mesh channel(double overlap_m) {
  Mesh mesh = block({0, 0, 0}, {0.06, 0.02, 0.01});
  append(mesh, block({0, 0, 0.01 - overlap_m}, {0.01, 0.02, 0.04}));
  return joined(mesh, block({0.05, 0, 0.01 - overlap_m}, {0.06, 0.02, 0.04}));
}
constexpr double kChannel_m3 = 0.06 * 0.02 * 0.01 + 2 * 0.01 * 0.02 * 0.03;

TEST(ShellUnion, AChannelOfThreeBoxesIsOneSolid) {
  for (const double overlap_m : {0.0, 1e-6, 1e-4, 5e-3})
    for (const bool is_turned : {false, true}) {
      const Pose X = is_turned ? RandomPoints(3).pose(0.05) : Pose();
      const Solid solid(transformed(channel(overlap_m), X));
      EXPECT_NEAR(solid.mass().volume_m3 / kChannel_m3, 1, 1e-12) << overlap_m;
      EXPECT_EQ(solid.report().united_shells, 3u);
      EXPECT_FALSE(solid.report().is_union_incomplete);
      // A point on the seam, 5 mm from the ends, where single boxes have a face.
      EXPECT_NEAR(solid.signedDistance(X * Vec3(0.004, 0.01, 0.01)), -0.004, 1e-12) << overlap_m;
      EXPECT_NEAR(solid.signedDistance(X * Vec3(0.03, 0.01, 0.02)), 0.01, 1e-12) << overlap_m;
    }
}

TEST(ShellUnion, AGapOfAMicrometreStays) {
  const Solid solid(
      joined(block({0, 0, 0}, {0.02, 0.02, 0.01}), block({0, 0, 0.010001}, {0.02, 0.02, 0.02})));
  EXPECT_EQ(solid.report().united_shells, 0u);
  EXPECT_NEAR(solid.signedDistance({0.01, 0.01, 0.0100005}), 0.5e-6, 1e-12);
}

TEST(ShellUnion, ShellsThatDoNotTouchKeepTheirBits) {
  const Mesh apart = welded(
      joined(makeSphere(0.01, 3), transformed(makeBox({0.01, 0.01, 0.01}), Pose::translation({0.03, 0, 0}))));
  const Solid solid(apart);
  EXPECT_EQ(solid.mesh().vertices, apart.vertices);
  EXPECT_EQ(solid.mesh().triangles, apart.triangles);
  EXPECT_FALSE(solid.isByWinding());
}

TEST(ShellUnion, BoxesWithACommonEdgeOrCornerAreBothThere) {
  for (const double y : {0.0, 0.02}) {
    const Solid solid(
        joined(block({0, 0, 0}, {0.02, 0.02, 0.02}), block({0.02, y, 0.02}, {0.04, y + 0.02, 0.04})));
    EXPECT_NEAR(solid.mass().volume_m3 / 16e-6, 1, 1e-12);
    EXPECT_NEAR(solid.signedDistance({0.01, 0.01, 0.01}), -0.01, 1e-12);
    EXPECT_NEAR(solid.signedDistance({0.03, y + 0.01, 0.03}), -0.01, 1e-12);
  }
}

TEST(SolidMass, AnInvertedCubeBesideAnotherCounts) {
  const Mesh cube = makeBox({0.02, 0.02, 0.02});
  const Mesh both = joined(cube, turned(transformed(cube, Pose::translation({0.05, 0, 0}))));
  const MassProperties mass = Solid(both).mass();
  EXPECT_NEAR(mass.volume_m3 / 16e-6, 1, 1e-12);
  EXPECT_NEAR((mass.com - Vec3(0.025, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(solidMass(both).volume_m3, mass.volume_m3);
}

TEST(SolidMass, AnInnerShellIsACavityOnlyIfItFacesTheOtherWay) {
  const Mesh outer = makeBox({0.04, 0.04, 0.04}), inner = makeBox({0.02, 0.02, 0.02});
  EXPECT_NEAR(solidMass(joined(outer, inner)).volume_m3 / 64e-6, 1, 1e-12);
  EXPECT_NEAR(solidMass(joined(outer, turned(inner))).volume_m3 / 56e-6, 1, 1e-12);
  EXPECT_NEAR(solidMass(turned(joined(outer, inner))).volume_m3 / 64e-6, 1, 1e-12);
  EXPECT_NEAR(solidMass(turned(joined(outer, turned(inner)))).volume_m3 / 56e-6, 1, 1e-12);
}

TEST(ShellUnion, AnInvertedShellThatCrossesAnotherIsASolid) {
  const Mesh a = block({0, 0, 0}, {0.02, 0.02, 0.02}), b = block({2e-3, 2e-3, 2e-3}, {0.022, 0.022, 0.022});
  const double union_m3 = 2 * 8e-6 - std::pow(0.018, 3);
  for (const Mesh& mesh : {joined(a, b), joined(a, turned(b)), joined(turned(a), b), turned(joined(a, b))})
    EXPECT_NEAR(Solid(mesh).mass().volume_m3 / union_m3, 1, 1e-12);
  const double sunk_m = 1e-3;  // a void may touch the outer shell; one that reaches through it is a solid
  const Mesh plate = block({0, 0, 0}, {0.04, 0.04, 0.01});
  const auto boss = [](double top_m) { return block({0.01, 0.01, 2e-3}, {0.02, 0.02, top_m}); };
  EXPECT_NEAR(solidMass(joined(plate, turned(boss(0.01)))).volume_m3 / (16e-6 - 0.8e-6), 1, 1e-12);
  EXPECT_NEAR(solidMass(joined(plate, turned(boss(0.01 + sunk_m)))).volume_m3 / (16e-6 + 0.1e-6), 1, 1e-12);
}

/// All corners of the bar lie on the channel or in it; the bar's middle is outside.
TEST(ShellUnion, AnInvertedShellThatCrossesTheOpenPartOfAnotherIsASolid) {
  const Solid united(channel(0));
  const Mesh channel = united.mesh(), across = block({0.005, 5e-3, 0.02}, {0.055, 15e-3, 0.03});
  const double union_m3 = kChannel_m3 + 0.04 * 0.01 * 0.01;
  for (const Mesh& bar : {across, turned(across)})
    EXPECT_NEAR(solidMass(joined(channel, bar)).volume_m3 / union_m3, 1, 1e-12);
  const Mesh lid = block({0, 0, 0.03}, {0.06, 0.02, 0.04});
  for (const Mesh& bar : {lid, turned(lid)})
    EXPECT_NEAR(solidMass(joined(channel, bar)).volume_m3 / (kChannel_m3 + 0.04 * 0.02 * 0.01), 1, 1e-12);
}

/// The faces equal the faces of a single block, except for a line around its middle.
Mesh blockOfTwoHalves(const Vec3& min, const Vec3& max) {
  const double middle_m = 0.5 * (min.z() + max.z());
  Mesh mesh =
      welded(joined(block(min, {max.x(), max.y(), middle_m}), block({min.x(), min.y(), middle_m}, max)));
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](std::uint32_t v) { return std::abs(mesh.vertices[v].z() - middle_m) < 1e-9; });
  });
  return mesh;
}

/// Without the ends, which both shells have in common, the rest would close to a solid without volume.
TEST(ShellUnion, AnInvertedCopyWithOtherFacetsIsTheSameSolid) {
  const Mesh one = block({0, 0, 0}, {0.02, 0.02, 0.02}),
             two = blockOfTwoHalves({0, 0, 0}, {0.02, 0.02, 0.02});
  for (const Mesh& mesh : {joined(one, turned(two)), joined(two, turned(one)), joined(turned(one), two)})
    for (const Pose& X : {Pose(), RandomPoints(3).pose(0.05)}) {
      const Solid solid(transformed(mesh, X));
      EXPECT_NEAR(solid.mass().volume_m3 / 8e-6, 1, 1e-12) << describe(solid.report());
      EXPECT_TRUE(solid.isInside(X * Vec3(8e-3, 9e-3, 7e-3)));
      EXPECT_NEAR(solid.signedDistance(X * Vec3(0.01, 0.01, 5e-3)), -5e-3, 1e-12);
    }
}

TEST(ShellUnion, BoxesOfRoundSizesInTheSameFrameAreUnited) {
  const Solid plus(joined(makeBox({0.04, 0.01, 0.01}), makeBox({0.01, 0.04, 0.01})));
  EXPECT_FALSE(plus.report().is_union_incomplete);
  EXPECT_NEAR(plus.mass().volume_m3 / 7e-6, 1, 1e-12);
  EXPECT_NEAR(plus.signedDistance({0.012, 0.002, 0}), -0.003, 1e-12);
}

TEST(SolidMass, AVoidWithinAVoidAddsNothing) {
  const Mesh outer = makeBox({0.06, 0.06, 0.06}), cavity = makeBox({0.04, 0.04, 0.04}),
             inner = makeBox({0.02, 0.02, 0.02});
  const Solid solid(joined(joined(outer, turned(cavity)), turned(inner)));
  EXPECT_NEAR(solid.mass().volume_m3 / 152e-6, 1, 1e-12);
  EXPECT_FALSE(solid.isInside({0, 0, 0}));
  EXPECT_NEAR(solid.signedDistance({0, 0, 0}), 0.02, 1e-12);
  const Solid core(joined(joined(outer, turned(cavity)), inner));
  EXPECT_NEAR(core.mass().volume_m3 / 160e-6, 1, 1e-12);
  EXPECT_TRUE(core.isInside({0, 0, 0}));
}

TEST(SolidMass, ALidClosesAnOpenBoxAndAFlatSheetHasNoVolume) {
  Mesh open = makeBox({0.02, 0.02, 0.02});
  open.triangles.resize(open.triangles.size() - 2);  // one side
  EXPECT_NEAR(solidMass(open).volume_m3 / 8e-6, 1, 1e-12);
  Mesh sheet = transformed(makeBox({0.02, 0.02, 0.02}), RandomPoints(4).pose(0.1));
  sheet.triangles.resize(2);
  EXPECT_EQ(solidMass(sheet).volume_m3, 0);
}

TEST(ShellUnion, HasTheSameBitsForAnyNumberOfThreads) {
  Mesh mesh = makeSphere(0.01, 3);
  append(mesh, transformed(makeTube(0.008, 0.006, 0.03, 60), RandomPoints(5).pose(2e-3)));
  append(mesh, transformed(makeBox({0.03, 0.004, 0.006}), RandomPoints(6).pose(2e-3)));
  const Solid many(mesh);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Solid single(mesh);
  EXPECT_EQ(many.report().united_shells, 3u);
  EXPECT_EQ(many.mesh().vertices, single.mesh().vertices);
  EXPECT_EQ(many.mesh().triangles, single.mesh().triangles);
}

/// Facet 0 of the mesh is cut at the middle of its first side, but the facet across that side is not; a facet
/// without area fills the gap.
Mesh withFlatFacet(Mesh mesh) {
  const std::array<std::uint32_t, 3> t = mesh.triangles[0];
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(0.5 * (mesh.vertices[t[0]] + mesh.vertices[t[1]]));
  mesh.triangles[0] = {t[0], middle, t[2]};
  mesh.triangles.push_back({middle, t[1], t[2]});
  mesh.triangles.push_back({t[1], middle, t[0]});
  return mesh;
}

TEST(ShellUnion, AFacetWithoutAreaDoesNotPreventIt) {
  for (const double overlap_m : {0.0, 1e-4}) {
    const Solid solid(withFlatFacet(welded(channel(overlap_m))));
    EXPECT_EQ(solid.report().degenerate_triangles, 1u);
    EXPECT_EQ(solid.report().united_shells, 3u);
    EXPECT_FALSE(solid.report().is_union_incomplete);
    EXPECT_NEAR(solid.mass().volume_m3 / kChannel_m3, 1, 1e-12);
    EXPECT_NEAR(solid.signedDistance({0.004, 0.01, 0.01}), -0.004, 1e-12);
  }
}

TEST(ShellUnion, AnOpenPatchElsewhereDoesNotPreventIt) {
  Mesh sheet = makeBox({0.01, 0.01, 0.01});
  sheet.triangles.resize(2);
  const Solid solid(joined(channel(1e-4), transformed(sheet, Pose::translation({0.03, 0.01, 0.08}))));
  EXPECT_EQ(solid.report().united_shells, 3u);
  EXPECT_FALSE(solid.report().is_union_incomplete);
  EXPECT_EQ(solid.report().sheet_facets, 2u);
  EXPECT_NEAR(solid.mass().volume_m3 / kChannel_m3, 1, 1e-9);
  EXPECT_NEAR(solid.signedDistance({0.004, 0.01, 0.01}), -0.004, 1e-12);
}

/// A crack separates the side of one arm from the rest. The crack is too wide to be joined, and narrow enough
/// for the shell to count as closed.
TEST(ShellUnion, ShellsThatTouchButHaveCracksAreSaidNotToBeUnited) {
  Mesh arm = block({0, 0, 0.009}, {0.01, 0.02, 0.04});
  Mesh cut = arm;
  cut.triangles.resize(2);
  arm.triangles.erase(arm.triangles.begin(), arm.triangles.begin() + 2);
  const Vec3 n = (cut.vertices[cut.triangles[0][1]] - cut.vertices[cut.triangles[0][0]])
                     .cross(cut.vertices[cut.triangles[0][2]] - cut.vertices[cut.triangles[0][0]])
                     .normalized();
  append(arm, transformed(cut, Pose::translation(1e-5 * n)));
  const Solid solid(joined(block({0, 0, 0}, {0.06, 0.02, 0.01}), arm));
  EXPECT_EQ(solid.report().united_shells, 0u);
  EXPECT_TRUE(solid.report().is_union_incomplete) << describe(solid.report());
}

/// Pins that stand on one plate, so that all of them cover some of its two facets.
TEST(ShellUnion, ManyPinsOnAPlateAreOneSolid) {
  constexpr int kRow = 10, kSides = 16;
  constexpr double kPitch_m = 4e-3, kRadius_m = 1e-3, kHigh_m = 10e-3;
  Mesh mesh = block({0, 0, -5e-3}, {kRow * kPitch_m, kRow * kPitch_m, 0});
  for (int i = 0; i < kRow * kRow; ++i)
    append(mesh, transformed(makeCylinder(kRadius_m, kHigh_m, kSides),
                             Pose::translation(
                                 {(i % kRow + 0.5) * kPitch_m, (i / kRow + 0.5) * kPitch_m, 0.5 * kHigh_m})));
  const Solid solid(mesh);
  const double pin_m2 = 0.5 * kSides * kRadius_m * kRadius_m * std::sin(2 * std::numbers::pi / kSides);
  const double truth_m3 = std::pow(kRow * kPitch_m, 2) * 5e-3 + kRow * kRow * pin_m2 * kHigh_m;
  EXPECT_EQ(solid.report().united_shells, kRow * kRow + 1u);
  EXPECT_NEAR(solid.mass().volume_m3 / truth_m3, 1, 1e-10);
}

TEST(ShellUnion, WhatCouldNotBeUnitedIsSaid) {
  MeshReport report;
  report.shells = 2;
  report.is_union_incomplete = true;
  EXPECT_NE(describe(report).find("could not be united"), std::string::npos);
}

}  // namespace
}  // namespace vps::test
