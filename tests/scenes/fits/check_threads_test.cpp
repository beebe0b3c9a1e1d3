// SPDX-License-Identifier: BSD-3-Clause
// Threads of screws and nuts whose shape is known by construction, and the motions that take them apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>

#include "fits/iso_sizes.h"
#include "motion/screw_profile.h"
#include "support/lathe.h"
#include "support/screw.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

using test::mirrored;

constexpr double kRadial = 100e-6;  // clearance of the nuts

DrawnPart drawn(const std::string& name, const Mesh& mesh, const Pose& X_WP = Pose()) {
  return {name, mesh, X_WP, {}, false};
}

/// An M12 thread with 96 facets in a turn.
test::ThreadShape threadOf(double turns, double clearance_m = 0) {
  test::ThreadShape thread;
  thread.length_m = turns * thread.pitch_m;
  thread.clearance_m = clearance_m;
  thread.columns = 96;
  thread.rows_per_pitch = 16;
  thread.face_steps = 4;
  thread.side_steps = 4;
  return thread;
}

/// A nut of six turns in the middle of a rod of ten turns. Their phases agree, so the clearance is the same
/// all around.
struct RodAndNut {
  Mesh rod = test::makeThreadedRod(threadOf(10)), nut = test::makeNut(threadOf(6, kRadial), 11e-3);
};

CheckResult checkThreads(const std::vector<DrawnPart>& parts, bool has_play = false) {
  return checkAssembly("test", parts, {.has_fits = true, .has_play = has_play});
}

TEST(Iso262, ThreadsAreNamedByMajorDiameterAndPitch) {
  EXPECT_EQ(metricThread(16e-3, 2e-3).name, "M16");
  // The tolerance 6g of ISO 965-2 allows 15.682 to 15.962.
  EXPECT_EQ(metricThread(15.682e-3, 2e-3).name, "M16");
  EXPECT_EQ(metricThread(15.9e-3, 1.5e-3).name, "M16x1.5");
  EXPECT_EQ(metricThread(9.97e-3, -1.25e-3).name, "M10x1.25-LH");
  EXPECT_EQ(metricThread(12e-3, 1.75e-3).pitch_m, 1.75e-3);
  EXPECT_EQ(metricThread(2.98e-3, 0.501e-3).name, "M3");
  EXPECT_EQ(metricThread(16.1e-3, 2e-3).name, "");      // larger than its nominal size
  EXPECT_EQ(metricThread(15.3e-3, 2e-3).name, "");      // below 8g: 15.51
  EXPECT_EQ(metricThread(16e-3, 1.9e-3).name, "");      // no such pitch
  EXPECT_EQ(metricThread(12.7e-3, 1.954e-3).name, "");  // 1/2-13 UNC
}

TEST(CheckThreads, ANutOnARodIsAThreadWithItsLeadAndHand) {
  const RodAndNut made;
  const Pose X(rotationFromVector(Vec3(0.7, -0.3, 0.9)), Vec3(0.04, 0.1, -0.02));
  for (const bool is_left : {false, true}) {
    const CheckResult found = checkThreads({drawn("nut", is_left ? mirrored(made.nut) : made.nut, X),
                                            drawn("rod", is_left ? mirrored(made.rod) : made.rod, X)});
    ASSERT_EQ(found.fits.size(), 1U);
    const CheckedFit& fit = found.fits[0];
    EXPECT_EQ(fit.kind, FitKind::Thread);
    EXPECT_EQ(fit.shaft, "rod");
    EXPECT_EQ(fit.bore, "nut");
    EXPECT_EQ(fit.thread, is_left ? "M12-LH" : "M12");
    EXPECT_EQ(fit.lead_m, is_left ? -1.75e-3 : 1.75e-3);
    EXPECT_EQ(fit.starts, 1);
    // Corners of the facets lie on the crests and roots; an offset of the axis may change their radii.
    EXPECT_LT(fit.error_m, 2e-6);
    EXPECT_NEAR(fit.shaft_m, 12e-3, fit.error_m + 1e-12);
    EXPECT_NEAR(fit.diametral_clearance_m, 2 * kRadial, fit.error_m + 1e-12);
    EXPECT_NEAR(std::abs(fit.axis_W.dot(X.R * Vec3::UnitZ())), 1, 1e-6);
    // The nut's length; the ends of its thread are found to a tenth of the pitch.
    EXPECT_NEAR(fit.length_m, 6 * 1.75e-3, 0.1 * 1.75e-3);
  }
}

TEST(CheckThreads, WhatIsNoThreadInAThreadIsNoThreadFit) {
  const RodAndNut made;
  const auto has = [](const CheckResult& found) {
    for (const CheckedFit& fit : found.fits)
      if (fit.kind == FitKind::Thread) return true;
    return false;
  };
  test::ThreadShape fine = threadOf(10);
  fine.pitch_m = 1.25e-3;
  EXPECT_TRUE(has(checkThreads({drawn("nut", made.nut), drawn("rod", made.rod)})));
  EXPECT_FALSE(has(checkThreads({drawn("nut", made.nut), drawn("rod", mirrored(made.rod))})));
  EXPECT_FALSE(has(checkThreads({drawn("nut", made.nut), drawn("rod", test::makeThreadedRod(fine))})));
  EXPECT_FALSE(has(checkThreads({drawn("nut", made.nut), drawn("pin", makeCylinder(5e-3, 0.03, 96))})));
  EXPECT_FALSE(has(checkThreads({drawn("tube", makeTube(9e-3, 6.1e-3, 0.01, 96)), drawn("rod", made.rod)})));
  // The parts are next to each other.
  EXPECT_FALSE(has(
      checkThreads({drawn("nut", made.nut, Pose::translation({17.2e-3, 0, 0})), drawn("rod", made.rod)})));
}

TEST(CheckThreads, ANutLeavesItsRodByScrewAtBothEnds) {
  const RodAndNut made;
  for (const bool is_left : {false, true}) {
    const CheckResult found = checkThreads({drawn("nut", is_left ? mirrored(made.nut) : made.nut),
                                            drawn("rod", is_left ? mirrored(made.rod) : made.rod)},
                                           true);
    for (const CheckedPart& part : found.parts) {
      EXPECT_TRUE(part.ways_out_W.empty()) << part.name;  // the part cannot leave in a straight line
      ASSERT_EQ(part.screw_ways_out.size(), 2U) << part.name;
      EXPECT_NEAR(part.screw_ways_out[0].axis_W.dot(part.screw_ways_out[1].axis_W), -1, 1e-9);
      for (const ScrewWay& way : part.screw_ways_out) EXPECT_EQ(way.lead_m, is_left ? -1.75e-3 : 1.75e-3);
    }
    // Flanks rise by sqrt(3) relative to the axis, so the play along the axis is the radial clearance times
    // sqrt(3). Facets of 1/96 turn deviate by 3.2 um at r = 6 mm.
    const CheckedPart& nut = found.parts[0];
    ASSERT_TRUE(nut.play);
    EXPECT_NEAR(nut.play->m[4], kRadial / std::sqrt(3.0), 3.2e-6);
  }
}

// The rod has a disc on one end, in one piece with it, which is wider than the nut's hole.
TEST(CheckThreads, ANutLeavesABoltOnlyAwayFromItsHead) {
  const RodAndNut made;
  Mesh bolt = made.rod;
  Mesh head = makeCylinder(9e-3, 4e-3, 48);
  for (Vec3& v : head.vertices) v.z() -= 0.5 * 10 * 1.75e-3 + 1e-3;  // 1 mm into the rod
  append(bolt, head);
  const CheckResult found = checkThreads({drawn("nut", made.nut), drawn("bolt", bolt)}, true);
  for (const CheckedPart& part : found.parts) {
    ASSERT_EQ(part.screw_ways_out.size(), 1U) << part.name;
    EXPECT_NEAR(part.screw_ways_out[0].axis_W.z(), part.name == "nut" ? 1 : -1, 1e-6);
  }
}

// A rotation of 1.5 rad without the advance of 0.42 mm along the axis makes the flanks overlap.
TEST(CheckThreads, ThreadsThatAreDrawnOutOfPhaseOverlapAsDrawn) {
  const RodAndNut made;
  const Pose turned(rotationFromVector(Vec3(0, 0, 1.5)), Vec3::Zero());
  const CheckResult found = checkThreads({drawn("nut", made.nut, turned), drawn("rod", made.rod)}, true);
  EXPECT_EQ(found.pairs.at(0).state, PairState::Thread);
  EXPECT_NE(found.pairs.at(0).explanation.find("out of phase"), std::string::npos);
  for (const CheckedPart& part : found.parts) EXPECT_TRUE(part.screw_ways_out.empty());
}

/// Random points of the facets, as radius and phase; the phase is a share of the lead.
template <class Visit>
void forEachPoint(const PlacedSurface& part, const Motion& screw, Visit visit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  const double lead_m = 2 * std::numbers::pi * screw.forward_m;
  for (std::uint32_t i = 0; i < part.surface->mesh().triangles.size(); ++i)
    for (int k = 0; k < 8; ++k) {
      double a = share(random), b = share(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const Triangle t = part.surface->triangle(i);
      const Vec3 p = t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
      const double phase = (p.z() - screw.forward_m * std::atan2(p.y(), p.x())) / lead_m;
      visit(i, p.head<2>().norm(), phase - std::floor(phase));
    }
}

TEST(ScrewProfile, WhatPassesIsBelowTheNutAtEveryPhase) {
  constexpr std::size_t kBins = 200;
  const Motion screw{Vec3::UnitZ(), Vec3::Zero(), true, 1.75e-3 / (2 * std::numbers::pi)};
  for (const double clearance_m : {kRadial, 20e-6, -20e-6}) {
    const std::vector<DrawnPart> parts = {drawn("nut", test::makeNut(threadOf(6, clearance_m), 11e-3)),
                                          drawn("rod", test::makeThreadedRod(threadOf(10)))};
    const std::vector<PlacedSurface> placed = placedSurfaces(parts, {});
    const std::vector<std::uint8_t> passing = ScrewProfile(placed[0], screw).passing(placed[1]);
    const auto count = std::count(passing.begin(), passing.end(), 1);
    // A facet of 1/96 turn deviates by 3.2 um at r = 6 mm. Bins of the profile are 1.7 um wide, which is 3 um
    // along flanks.
    if (clearance_m > 0)
      EXPECT_EQ(count, static_cast<std::ptrdiff_t>(passing.size())) << clearance_m;
    else
      EXPECT_LT(count, static_cast<std::ptrdiff_t>(passing.size()) / 2);
    std::array<double, kBins> least_m{};
    least_m.fill(1e300);
    const auto binOf = [](double phase) {
      return std::min(kBins - 1, static_cast<std::size_t>(phase * kBins));
    };
    forEachPoint(placed[0], screw, [&](std::uint32_t, double radius_m, double phase) {
      least_m[binOf(phase)] = std::min(least_m[binOf(phase)], radius_m);
    });
    const double rise_m = std::sqrt(3.0) * 1.75e-3 / kBins;  // rise of a flank within a bin
    forEachPoint(placed[1], screw, [&](std::uint32_t i, double radius_m, double phase) {
      if (passing[i] != 0) {
        ASSERT_LT(radius_m, least_m[binOf(phase)] + rise_m);
      }
    });
  }
}

TEST(CheckThreads, TheLooseM16NutIsScrewedOffItsBolt) {
  const char* folder = std::getenv("VPS_CAD_DIR");
  const std::filesystem::path from =
      std::filesystem::path(folder != nullptr ? folder : "../shared/cad") / "thread-m16-loose";
  if (!std::filesystem::exists(from)) GTEST_SKIP() << from.string() << " does not exist; set VPS_CAD_DIR";
  ImportSettings metres;
  metres.unit_m = 1;
  const auto mesh = [&](const char* file) {
    return importCad((from / file).string(), metres).parts.at(0).mesh;
  };
  const CheckResult found = checkThreads(
      {drawn("bolt", mesh("factory_bolt_m16_loose.obj")),
       drawn("nut", mesh("factory_nut_m16_loose_subdiv_3x.obj"), Pose::translation({0, 0, 2e-3}))},
      true);
  ASSERT_EQ(found.fits.size(), 1U);
  EXPECT_EQ(found.fits[0].thread, "M16");
  ASSERT_EQ(found.parts[1].screw_ways_out.size(), 1U);  // the bolt's head is at the other end
  EXPECT_NEAR(found.parts[1].screw_ways_out[0].axis_W.z(), 1, 1e-6);
}

}  // namespace
}  // namespace vps::scenes
