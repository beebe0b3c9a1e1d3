// SPDX-License-Identifier: BSD-3-Clause
// Sections and clearance maps of parts whose outlines and gaps are known by construction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/drawn_part.h"
#include "support/lathe.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

CheckSettings pictures() {
  return {.has_play = false, .has_sections = true, .has_maps = true};
}

/// The sum of the areas of all chains; chains around holes count as negative.
double areaOf(const SectionOutline& outline) {
  double sum_m2 = 0;
  for (const auto& chain : outline.chains)
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const auto &a = chain[i], &b = chain[(i + 1) % chain.size()];
      sum_m2 += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
  return sum_m2;
}

// The shaft is shorter than the bushing, and the picture ends within the bushing.
TEST(CheckSection, AShaftInABushingIsCutThroughItsAxis) {
  const int segments = 360;
  const Pose X(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(0.1, 0.2, 0.3));
  const CheckResult result = checkAssembly(
      "test",
      {part("bushing", makeTube(20e-3, 10.05e-3, 30e-3, segments), X),
       part("shaft", test::lathe({{0, -12e-3}, {10e-3, -12e-3}, {10e-3, 12e-3}, {0, 12e-3}}, segments), X)},
      pictures());
  ASSERT_EQ(result.sections.size(), 1U);
  const CheckedSection& section = result.sections[0];
  EXPECT_TRUE(section.is_fit);
  EXPECT_NEAR(std::abs(section.right_W.cross(section.up_W).dot(X.R * Vec3::UnitZ())), 0, 1e-9);
  ASSERT_EQ(section.parts.size(), 2U);
  EXPECT_EQ(section.parts[0].part, "shaft");
  EXPECT_EQ(section.parts[1].part, "bushing");
  EXPECT_FALSE(section.parts[0].is_open);
  EXPECT_FALSE(section.parts[1].is_open);
  // Facets are inside the circle by 1 - cos(pi / 360), 4e-5 of the radius.
  EXPECT_NEAR(areaOf(section.parts[0]), 20e-3 * 24e-3, 1e-4 * 20e-3 * 24e-3);
  // The picture shows 1.1 bore diameters to each side; outlines reach a tenth farther.
  const double side_m = std::min(20e-3, 1.1 * section.half_m) - 10.05e-3;
  EXPECT_NEAR(areaOf(section.parts[1]), 2 * side_m * 30e-3, 3e-4 * 2 * side_m * 30e-3);
  EXPECT_EQ(section.parts[1].chains.size(), 2U);
}

// Corners of a box that lie in the plane count as in front of it, so the outline closes.
TEST(CheckSection, AnOverlapIsCutWhereItIsDeepestAlongItsDepth) {
  const CheckResult result = checkAssembly(
      "test",
      {part("plate", transformed(makeBox(Vec3(0.1, 0.1, 0.02)), Pose::translation(Vec3(0, 0, -0.01)))),
       part("block", makeBox(Vec3(0.01, 0.01, 0.03)), Pose::translation(Vec3(0, 0, 0.015 - 90e-6)))},
      pictures());
  ASSERT_EQ(result.sections.size(), 1U);
  const CheckedSection& section = result.sections[0];
  EXPECT_FALSE(section.is_fit);
  EXPECT_NEAR(std::abs(section.up_W.z()), 1, 1e-9);
  for (const SectionOutline& outline : section.parts) EXPECT_FALSE(outline.is_open) << outline.part;
  ASSERT_EQ(section.parts[1].part, "block");
  EXPECT_EQ(section.parts[1].chains.size(), 1U);
  // The picture shows 18 mm to each side of the lower edge of the block; outlines reach a tenth farther.
  EXPECT_NEAR(areaOf(section.parts[1]), 10e-3 * 1.1 * section.half_m, 1e-9);
}

TEST(CheckSection, AnOutlineOfASurfaceWithAHoleIsClosedAndSaysSo) {
  Mesh open = makeTube(20e-3, 10.05e-3, 30e-3, 90);
  // A strip of the outside is missing.
  std::erase_if(open.triangles, [&](const auto& t) {
    const Vec3 p = (open.vertices[t[0]] + open.vertices[t[1]] + open.vertices[t[2]]) / 3;
    return p.head<2>().norm() > 19e-3 && std::abs(p.z()) < 14e-3;
  });
  const CheckResult result =
      checkAssembly("test", {part("open", open), part("shaft", makeCylinder(10e-3, 50e-3, 90))}, pictures());
  ASSERT_EQ(result.sections.size(), 1U);
  ASSERT_EQ(result.sections[0].parts.size(), 2U);
  EXPECT_FALSE(result.sections[0].parts[0].is_open);
  EXPECT_TRUE(result.sections[0].parts[1].is_open);
}

TEST(CheckSection, AMapHasTheGapAtEachPointOfTheSurface) {
  const double gap_m = 0.2e-3;
  const CheckResult result = checkAssembly(
      "test",
      {part("plate", makeBox(Vec3(0.1, 0.1, 0.02)), Pose::translation(Vec3(0, 0, -0.01))),
       part("block", makeBox(Vec3(0.03, 0.02, 0.01)), Pose::translation(Vec3(0, 0, 0.005 + gap_m)))},
      pictures());
  ASSERT_EQ(result.maps.size(), 2U);
  for (const ClearanceMap& map : result.maps) {
    ASSERT_EQ(map.distance_m.size(), map.mesh_W.vertices.size());
    EXPECT_TRUE(checkMesh(map.mesh_W).isClosed()) << map.part;
    for (std::size_t i = 0; i < map.distance_m.size(); ++i) {
      const Vec3& p = map.mesh_W.vertices[i];
      double expected_m = p.z() - 0;  // height of the block's vertex above the plate
      if (map.part == "plate") {
        const Vec3 out = (p.cwiseAbs() - Vec3(0.015, 0.01, 0)).cwiseMax(0);
        expected_m = Vec3(out.x(), out.y(), gap_m - p.z()).norm();
      }
      EXPECT_NEAR(map.distance_m[i], std::min(expected_m, 1e-3), 1e-12) << map.part << " " << p.transpose();
    }
  }
  EXPECT_EQ(result.maps[0].part, "plate");
  EXPECT_GT(result.maps[0].mesh_W.vertices.size(), 500U);  // the plate of 8 corners is divided
}

// The coordinates of a file in single precision are off by up to 60 nm here, to both sides of the common
// plane.
TEST(CheckSection, AMapOfTouchingPlatesHasNoSpotsOfOverlap) {
  const Pose X_W(rotationFromVector(Vec3(1, 0.7, -0.4)), Vec3(1, 0.7, 0.3));
  const auto plate = [&](const std::string& name, const Vec3& size_m, double z_m) {
    Mesh mesh = makeBox(size_m);
    for (Vec3& p : mesh.vertices) p = (X_W * (p + Vec3(0, 0, z_m))).cast<float>().cast<double>();
    return part(name, mesh);
  };
  const CheckResult result = checkAssembly(
      "test", {plate("below", {0.04, 0.03, 0.005}, -0.0025), plate("above", {0.03, 0.02, 0.005}, 0.0025)},
      pictures());
  ASSERT_EQ(result.maps.size(), 2U);
  for (const ClearanceMap& map : result.maps) {
    std::size_t touching = 0;
    for (const double distance_m : map.distance_m) {
      EXPECT_GE(distance_m, 0) << map.part;
      touching += distance_m < 0.1e-6 ? 1 : 0;
    }
    EXPECT_GT(touching, 300U) << map.part;
  }
}

TEST(CheckSection, AMapHasTheDepthOfAClash) {
  const CheckResult result = checkAssembly(
      "test",
      {part("plate", makeBox(Vec3(0.1, 0.1, 0.02)), Pose::translation(Vec3(0, 0, -0.01))),
       part("block", makeBox(Vec3(0.03, 0.02, 0.01)), Pose::translation(Vec3(0, 0, 0.005 - 50e-6)))},
      pictures());
  ASSERT_EQ(result.maps.size(), 2U);
  for (const ClearanceMap& map : result.maps)
    EXPECT_NEAR(*std::ranges::min_element(map.distance_m), -50e-6, 1e-9) << map.part;
}

}  // namespace
}  // namespace vps::scenes
