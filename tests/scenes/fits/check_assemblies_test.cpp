// SPDX-License-Identifier: BSD-3-Clause
// Checks of whole assemblies: the bearing block with its designed clearances, and one of 132 parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

/// The fits in the table of scenes/bearing_block/README.md.
TEST(CheckAssemblies, TheBearingBlocksDesignedClearancesAreFound) {
  ImportSettings settings;
  settings.in_own_process = false;
  const ImportedCad cad =
      importCad(std::string(VPS_SOURCE_DIR) + "/scenes/bearing_block/bearing_block.glb", settings);
  const CheckResult found =
      checkAssembly("bearing block", drawnParts(cad), {.has_fits = true, .has_play = false});
  EXPECT_EQ(found.clashes(), 0U);
  struct Designed {
    const char *shaft, *bore;
    FitKind kind;
    double size_m, clearance_m;
  };
  for (const Designed& d : {
           Designed{"bushing_lower", "housing", FitKind::Shaft, 24e-3, 30e-6},
           Designed{"shaft", "bushing_lower", FitKind::Shaft, 12e-3, 24e-6},
           Designed{"bushing_upper", "housing", FitKind::Shaft, 30e-3, 40e-6},
           Designed{"shaft", "bushing_upper", FitKind::Shaft, 12e-3, 40e-6},
           Designed{"key", "housing", FitKind::Key, 5e-3, 40e-6},
           Designed{"dowel_1", "housing", FitKind::Shaft, 4e-3, 20e-6},
           Designed{"dowel_2", "housing", FitKind::Shaft, 4e-3, 20e-6},
           Designed{"dowel_1", "cover", FitKind::Shaft, 4e-3, 60e-6},
           Designed{"dowel_2", "cover", FitKind::Shaft, 4e-3, 60e-6},
           Designed{"key", "cover", FitKind::Shaft, 5e-3, 300e-6},  // its round ends
           Designed{"shaft", "cover", FitKind::Shaft, 12e-3, 500e-6},
           Designed{"screw_1", "housing", FitKind::Shaft, 4e-3, 200e-6},
           Designed{"screw_2", "housing", FitKind::Shaft, 4e-3, 200e-6},
           Designed{"screw_1", "cover", FitKind::Shaft, 4e-3, 500e-6},
           Designed{"screw_2", "cover", FitKind::Shaft, 4e-3, 500e-6},
       }) {
    const auto fit = std::find_if(found.fits.begin(), found.fits.end(), [&](const CheckedFit& f) {
      return f.shaft == d.shaft && f.bore == d.bore && f.kind == d.kind &&
             std::abs(f.shaft_m - d.size_m) < 5e-6;
    });
    ASSERT_NE(fit, found.fits.end()) << d.shaft << " in " << d.bore;
    EXPECT_NEAR(fit->diametral_clearance_m, d.clearance_m, 2e-6) << d.shaft << " in " << d.bore;
    // The file has single precision: an error of 2 nm at 30 mm, for each of four faces.
    EXPECT_NEAR(fit->diametral_clearance_m, d.clearance_m, fit->error_m + 8e-9)
        << d.shaft << " in " << d.bore;
  }
}

// The assembly has 66 pins, each in a sleeve. Each pin moves by half of its clearance, which differs from pin
// to pin.
TEST(CheckAssemblies, SixtySixPinsEachHaveTheirOwnPlay) {
  const auto clearanceOf = [](int i) { return 10e-6 + 2e-6 * i; };
  std::vector<DrawnPart> parts;
  for (int i = 0; i < 66; ++i) {
    const Pose X = Pose::translation(Vec3(0.012 * (i % 11), 0.012 * (i / 11), 0));
    parts.push_back({"pin", makeCylinder(2e-3, 0.02, 180), X, {}, false});
    parts.back().name += std::to_string(i);
    parts.push_back({"sleeve", makeTube(5e-3, 2e-3 + clearanceOf(i) / 2, 0.02, 180), X, {}, false});
    parts.back().name += std::to_string(i);
  }
  const CheckResult found = checkAssembly("pins", parts);
  EXPECT_EQ(found.clashes(), 0U);
  EXPECT_EQ(found.fits.size(), 66U);
  for (int i = 0; i < 66; ++i) {
    const CheckedPart& pin = found.parts[static_cast<std::size_t>(2 * i)];
    ASSERT_TRUE(pin.play);
    EXPECT_NEAR(pin.play->m[0], clearanceOf(i) / 2, 1e-6) << i;
    EXPECT_TRUE(std::isinf(pin.play->rad[4])) << i;
    EXPECT_EQ(pin.ways_out_W.size(), 2U) << i;
  }
}

}  // namespace
}  // namespace vps::scenes
