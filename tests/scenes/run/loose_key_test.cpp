// SPDX-License-Identifier: BSD-3-Clause
// A displacement within the clearance of a loose fit is no error.
#include <gtest/gtest.h>

#include <cmath>

#include "fits/fits.h"
#include "scenes/peg_in_cup.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

// A square key with 0.2 mm of clearance may lie in the corner of its pocket, 0.14 mm from where it is drawn:
// half of the clearance in both directions.
TEST(LooseKey, IsHomeWhereverItsPocketLetsItLie) {
  PegInCup key;
  key.flats = 4;
  key.peg_m = 6e-3;                                        // radius of the corners
  key.bore_m = key.peg_m + 0.5 * 0.2e-3 * std::sqrt(2.0);  // so that 0.2 mm are between its sides
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    Scene scene = pegInCup(key);
    scene.hand = {};
    scene.hand.seed = seed;
    const AssembleResult result = assemble(scene);
    EXPECT_NEAR(result.steps[0].tolerance_m, 0.1e-3 * std::sqrt(2.0) + 20e-6, 2e-6);
    EXPECT_EQ(result.verdict, Verdict::Fits) << seed << ": " << result.steps[0].reason;
  }
}

TEST(FitTolerance, IsTheGreaterOfWhatIsUsualAndOfThePlay) {
  EXPECT_DOUBLE_EQ(fitTolerance_m(-10e-6), 20e-6);
  EXPECT_DOUBLE_EQ(fitTolerance_m(50e-6), 70e-6);
  EXPECT_DOUBLE_EQ(fitTolerance_m(0.1e-3), kFitTolerance_m);
  EXPECT_DOUBLE_EQ(fitTolerance_m(0.2e-3), 0.2e-3 / std::sqrt(2.0) + 20e-6);
  EXPECT_DOUBLE_EQ(fitTolerance_m(2e-3), kSightTolerance_m);
}

}  // namespace
}  // namespace vps::scenes
