// SPDX-License-Identifier: BSD-3-Clause
// Warnings of meshes whose inside may be uncertain.
#include "vps_scenes/scene/model_options.h"

#include <gtest/gtest.h>

namespace vps::scenes {
namespace {

MeshReport ofTwoShells() {
  MeshReport report;
  report.shells = 2;
  report.signed_by_winding = true;
  return report;
}

TEST(MeshWarning, AClosedBlockWithAVoidGivesNone) {
  EXPECT_EQ(meshWarning(ofTwoShells()), "");
}

TEST(MeshWarning, AHoleIsNamedWithWhatItLeavesUncertain) {
  MeshReport report = ofTwoShells();
  report.open_edges = 4;
  report.certain_share = 0.91229;
  const std::string words = meshWarning(report);
  EXPECT_EQ(words.find("is not a closed surface: 2 shells, 4 open edges"), 0U) << words;
  EXPECT_NE(words.find("certain for 91.22 % of the space near it"), std::string::npos) << words;
}

TEST(MeshWarning, OverlappingShellsAreNotCalledOpen) {
  MeshReport report = ofTwoShells();
  report.overlapping_shells = 2;
  const std::string words = meshWarning(report);
  EXPECT_EQ(words.find("is repaired: "), 0U) << words;
  EXPECT_NE(words.find("2 overlapping shells"), std::string::npos) << words;
}

}  // namespace
}  // namespace vps::scenes
