// SPDX-License-Identifier: BSD-3-Clause
// Sections at planes that the user chose, through parts whose outlines are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/drawn_part.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

std::vector<PlaneSection> planeSectionsOf(const std::vector<DrawnPart>& parts,
                                          const std::vector<std::string>& planes) {
  CheckSettings settings{.has_play = false};
  for (const std::string& text : planes) settings.planes.push_back(sectionPlaneFromText(text, "--section"));
  return checkAssembly("test", parts, settings).plane_sections;
}

/// The message with which a plane is refused; empty if it is not.
std::string refusalOf(const std::string& plane, const std::vector<DrawnPart>& parts) {
  try {
    requireCut(sectionPlaneFromText(plane, "--section"), parts);
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(PlaneSection, ATubeIsTwoCirclesOfItsRadii) {
  const Vec3 middle(0.1, 0.2, 0.3);
  const auto sections = planeSectionsOf(
      {part("tube", makeTube(20e-3, 12e-3, 30e-3, 180), Pose::translation(middle))}, {"z=305mm"});
  ASSERT_EQ(sections.size(), 1U);
  const PlaneSection& section = sections[0];
  EXPECT_EQ(section.plane.name, "z=305mm");
  EXPECT_NEAR((section.at_W - Vec3(0.1, 0.2, 0.305)).norm(), 0, 2e-9);
  EXPECT_NEAR((section.right_W - Vec3::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((section.up_W - Vec3::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR(section.half_m[0], 20e-3, 1e-9);
  ASSERT_EQ(section.parts.size(), 1U);
  EXPECT_FALSE(section.parts[0].is_open);
  ASSERT_EQ(section.parts[0].chains.size(), 2U);
  std::vector<double> radii_m;
  for (const auto& chain : section.parts[0].chains) {
    double least_m = 1, most_m = 0;
    for (const auto& p : chain) {
      least_m = std::min(least_m, std::hypot(p[0], p[1]));
      most_m = std::max(most_m, std::hypot(p[0], p[1]));
    }
    radii_m.push_back(most_m);
    // Points between two corners are inside the circle by 1 - cos(pi / 180), 1.5e-4 of the radius.
    EXPECT_GT(least_m, most_m * (1 - 1.6e-4));
  }
  std::ranges::sort(radii_m);
  EXPECT_NEAR(radii_m[0], 12e-3, 1e-9);
  EXPECT_NEAR(radii_m[1], 20e-3, 1e-9);
}

// A face in the plane counts as above the cut: the top of a box is cut, the bottom is not.
TEST(PlaneSection, AFaceInThePlaneIsCutAwayWhicheverWayItIsRounded) {
  for (const double rounding_m : {-1e-15, 0.0, 1e-15}) {
    const std::vector<DrawnPart> parts = {
        part("box", makeBox(Vec3(0.02, 0.04, 0.01)), Pose::translation(Vec3(0, 0, 0.005 + rounding_m)))};
    const auto sections = planeSectionsOf(parts, {"z=10mm"});
    ASSERT_EQ(sections[0].parts.size(), 1U) << rounding_m;
    EXPECT_EQ(sections[0].parts[0].chains.size(), 1U);
    EXPECT_NEAR(sections[0].half_m[0], 0.01, 1e-12);
    EXPECT_NEAR(sections[0].half_m[1], 0.02, 1e-12);
    EXPECT_NE(refusalOf("z=0mm", parts), "") << rounding_m;
  }
}

TEST(PlaneSection, APlaneAcrossYIsSeenFromTheFront) {
  const auto sections = planeSectionsOf({part("box", makeBox(Vec3(0.02, 0.04, 0.01)))}, {"y=1mm", "x=1mm"});
  ASSERT_EQ(sections.size(), 2U);
  EXPECT_NEAR((sections[0].right_W - Vec3::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((sections[0].up_W - Vec3::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR((sections[1].right_W - Vec3::UnitY()).norm(), 0, 1e-12);
}

// The plane through the diagonal of a cube's side: a rectangle of 10 mm by 10 mm times the root of 2.
TEST(PlaneSection, APlaneByItsNormalNeedsNoUnitLength) {
  const auto sections = planeSectionsOf({part("cube", makeBox(Vec3(0.01, 0.01, 0.01)))}, {"0:0.7:0.7=0mm"});
  EXPECT_NEAR(sections[0].half_m[0], 0.005, 1e-8);
  EXPECT_NEAR(sections[0].half_m[1], 0.005 * std::sqrt(2.0), 1e-8);
}

TEST(PlaneSection, APlaneThatMissesAllPartsStatesTheirRange) {
  const std::vector<DrawnPart> parts = {
      part("low", makeBox(Vec3(0.02, 0.02, 0.01))),
      part("high", makeBox(Vec3(0.02, 0.02, 0.01)), Pose::translation(Vec3(0, 0, 0.03)))};
  EXPECT_EQ(refusalOf("z=1mm", parts), "");
  EXPECT_NE(
      refusalOf("z=40mm", parts).find("z=40mm cuts no part: the parts reach from -5 mm to 35 mm along z"),
      std::string::npos)
      << refusalOf("z=40mm", parts);
  EXPECT_NE(refusalOf("z=15mm", parts).find("gap between the parts"), std::string::npos);
}

TEST(PlaneSection, ATextThatIsNoPlaneIsRefused) {
  const std::vector<DrawnPart> parts = {part("cube", makeBox(Vec3(0.01, 0.01, 0.01)))};
  for (const char* text : {"z", "w=1mm", "z=1", "0:0:0=1mm", "0:1=1mm", "0:1:0:0=1mm", "=1mm", "z=1parsec"})
    EXPECT_NE(refusalOf(text, parts), "") << text;
}

}  // namespace
}  // namespace vps::scenes
