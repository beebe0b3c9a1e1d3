// SPDX-License-Identifier: BSD-3-Clause
// Check, search for fasteners, plan and verification of paths end at any call of their progress callback.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "scenes/assemblies_to_plan.h"
#include "support/lathe.h"
#include "support/stop_at.h"
#include "support/units.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/fasteners.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {
namespace {

/// A ring on a plate with a pin in the ring, and a block that overlaps the plate, so that the check also
/// searches for places and the plan for a path along the ring's axis.
std::vector<DrawnPart> pinInRing() {
  const double h_m = 10 * kMm, bore_m = 5.05 * kMm;
  const Mesh ring = test::lathe({{bore_m, 0}, {12 * kMm, 0}, {12 * kMm, h_m}, {bore_m, h_m}}, 48);
  const Mesh pin = test::lathe({{0, 0}, {5 * kMm, 0}, {5 * kMm, 2 * h_m}, {0, 2 * h_m}}, 48);
  return {at("plate", block({-30 * kMm, -30 * kMm, -5 * kMm}, {30 * kMm, 30 * kMm, 0}), Vec3::Zero()),
          at("ring", ring, {0, 0, 0.02 * kMm}), at("pin", pin, {0, 0, 0.05 * kMm}),
          at("block", block({20 * kMm, 20 * kMm, -0.05 * kMm}, {28 * kMm, 28 * kMm, 8 * kMm}), Vec3::Zero())};
}

TEST(StopStages, FastenersAreSoughtUntilTheStop) {
  const std::vector<DrawnPart> parts = pinInRing();
  EXPECT_GT(test::stopAtEveryCall([&](const Progress& progress) { findFasteners(parts, progress); }), 4);
}

TEST(StopStages, ACheckWithPlayPlacesAndPicturesEndsAtAnyCall) {
  const std::vector<DrawnPart> parts = pinInRing();
  CheckSettings settings;
  settings.has_places = settings.has_sections = settings.has_maps = true;
  EXPECT_GT(test::stopAtEveryCall(
                [&](const Progress& progress) { checkAssembly("stop", parts, settings, progress); }),
            50);
}

TEST(StopStages, APlanEndsAtAnyCall) {
  const std::vector<DrawnPart> parts = pinInRing();
  PlanSettings settings;
  settings.fixed = {"plate"};
  EXPECT_GT(test::stopAtEveryCall(
                [&](const Progress& progress) { planAssembly("stop", parts, settings, progress); }),
            50);
}

TEST(StopStages, TheProgressOfACheckMovesThroughItsStages) {
  std::set<std::string> stages;
  std::string last;
  double share_of_last = 0;
  checkAssembly("stop", pinInRing(), {}, [&](std::string_view doing, double share) {
    stages.emplace(doing);
    if (last == doing) {
      EXPECT_GE(share, share_of_last) << doing;
    }
    last = doing;
    share_of_last = share;
    EXPECT_LE(share, 1);
  });
  for (const char* stage : {"preparing the parts", "measuring pairs", "finding fits", "measuring play"})
    EXPECT_TRUE(stages.contains(stage)) << stage;
}

}  // namespace
}  // namespace vps::scenes
