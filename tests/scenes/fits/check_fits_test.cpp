// SPDX-License-Identifier: BSD-3-Clause
// Fits of parts whose sizes are known by construction.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fits/iso_sizes.h"
#include "scenes/drawn_part.h"
#include "support/lathe.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

const CheckSettings kFits{.has_fits = true, .has_play = false};

std::vector<CheckedFit> fitsOf(const std::vector<DrawnPart>& parts) {
  return checkAssembly("test", parts, kFits).fits;
}

/// Tabulated values of ISO 286-2:2010 [um].
TEST(Iso286, ZonesAreThoseOfTheTables) {
  struct Row {
    const char* zone;
    double nominal_mm, lower_um, upper_um;
  };
  for (const Row& row :
       {Row{"H7", 24, 0, 21}, Row{"g6", 24, -20, -7}, Row{"f7", 40, -50, -25}, Row{"k6", 12, 1, 12},
        Row{"n6", 50, 17, 33}, Row{"p6", 80, 32, 51}, Row{"d9", 100, -207, -120}, Row{"h11", 3, -60, 0},
        Row{"G7", 30, 7, 28}, Row{"F8", 10, 13, 35}, Row{"e8", 18, -59, -32}, Row{"H8", 18.5, 0, 33},
        Row{"m6", 400, 21, 57}}) {
    const std::optional<Zone> zone = isoZone(row.zone, 1e-3 * row.nominal_mm);
    ASSERT_TRUE(zone) << row.zone;
    EXPECT_NEAR(zone->lower_m, 1e-6 * row.lower_um, 1e-12) << row.zone << " at " << row.nominal_mm;
    EXPECT_NEAR(zone->upper_m, 1e-6 * row.upper_um, 1e-12) << row.zone << " at " << row.nominal_mm;
  }
  EXPECT_FALSE(isoZone("H7", 0.501));
  EXPECT_FALSE(isoZone("x7", 0.02));
  EXPECT_FALSE(isoZone("H", 0.02));
}

TEST(Iso286, FitsAreNamedWhereBothSizesLieInTheirZones) {
  EXPECT_EQ(isoFit(24.010e-3, 23.985e-3), "H7/g6");
  EXPECT_EQ(isoFit(24.010e-3, 23.995e-3), "H6/h5");
  EXPECT_EQ(isoFit(24.010e-3, 24.020e-3), "H7/m6");
  EXPECT_EQ(isoFit(24.000e-3, 24.000e-3), "H6/h5");
  EXPECT_EQ(isoFit(24.300e-3, 24.000e-3), "");
}

TEST(CheckFits, AShaftInABoreHasItsClearanceWhateverTheFacets) {
  for (const double clearance_m : {-10e-6, 0.0, 1e-6, 24e-6, 0.5e-3})
    for (const int segments : {32, 101, 720}) {
      const Pose X(rotationFromVector(Vec3(0.7, -0.3, 0.9)), Vec3(0.04, 0.1, -0.02));
      const Mesh bore = makeTube(0.02, 0.006 + clearance_m / 2, 0.03, segments);
      const std::vector<CheckedFit> fits =
          fitsOf({part("bore", bore, X), part("shaft", makeCylinder(0.006, 0.05, segments + 7),
                                              X * Pose::translation(Vec3(0, 0, 0.01)))});
      ASSERT_EQ(fits.size(), 1U) << clearance_m << " " << segments;
      const CheckedFit& fit = fits[0];
      EXPECT_EQ(fit.kind, FitKind::Shaft);
      EXPECT_EQ(fit.shaft, "shaft");
      EXPECT_EQ(fit.bore, "bore");
      EXPECT_NEAR(fit.diametral_clearance_m, clearance_m, 1e-12);
      EXPECT_LT(fit.error_m, 1e-12);  // the corners lie on the circles
      EXPECT_NEAR(fit.shaft_m, 0.012, 1e-12);
      EXPECT_NEAR(std::abs(fit.axis_W.dot(X.R * Vec3::UnitZ())), 1, 1e-12);
      EXPECT_NEAR(fit.length_m, 0.03, 1e-9);  // the shaft's middle is 10 mm up, and 25 mm to its end
      EXPECT_NEAR((X.inverse() * fit.at_W).norm(), 0, 1e-9);
    }
}

TEST(CheckFits, AShaftThatIsDrawnBesideItsBoreIsNoStandardFit) {
  for (const double offset_m : {0.0, 70e-6}) {
    const std::vector<CheckedFit> fits =
        fitsOf({part("bore", makeTube(0.008, 0.004, 0.03, 96)),
                part("shaft", makeCylinder(0.004, 0.05, 96), Pose::translation(Vec3(offset_m, 0, 0)))});
    ASSERT_EQ(fits.size(), 1U);
    EXPECT_NEAR(fits[0].offset_m, offset_m, 1e-9);
    EXPECT_EQ(fits[0].isEccentric(), offset_m > 0);
    EXPECT_EQ(standardOf(fits[0]), offset_m > 0 ? "sizes of H6/h5, but axes 70.00 um apart" : "H6/h5");
  }
}

// The same rod, as coarse exports have it: with 15 sides it is read as a prism, with 16 as a cylinder.
TEST(CheckFits, AFaceOfFewSidesOnACircleSaysHowItWasRead) {
  const auto readAs = [](int sides) {
    return checkAssembly("test", {part("rod", makeCylinder(0.005, 0.02, sides))}, kFits).parts.at(0).read_as;
  };
  EXPECT_EQ(readAs(6), "");
  for (const int sides : {7, 15, 16, 24})
    EXPECT_TRUE(
        readAs(sides).starts_with("a face of " + std::to_string(sides) +
                                  " flat sides, whose corners lie on a circle of 10.000 mm, is read as a " +
                                  (sides < 16 ? "prism" : "cylinder")))
        << sides << ": " << readAs(sides);
  EXPECT_EQ(readAs(25), "");
  EXPECT_EQ(checkAssembly("test", {part("box", makeBox(Vec3(0.01, 0.02, 0.03)))}, kFits).parts[0].read_as,
            "");
}

// Other programs write facets that are divided further: the new corners lie on the flat facets, inside the
// circle.
TEST(CheckFits, ADividedMeshHasTheSizesOfItsCorners) {
  Mesh bore = makeTube(0.02, 0.00605, 0.03, 60);
  for (int round = 0; round < 3; ++round) {
    Mesh divided{bore.vertices, {}};
    for (const auto& t : bore.triangles) {
      std::array<std::uint32_t, 3> middle;
      for (std::size_t e = 0; e < 3; ++e) {
        middle[e] = static_cast<std::uint32_t>(divided.vertices.size());
        divided.vertices.emplace_back(0.5 * (bore.vertices[t[e]] + bore.vertices[t[(e + 1) % 3]]));
      }
      for (std::size_t e = 0; e < 3; ++e) divided.triangles.push_back({t[e], middle[e], middle[(e + 2) % 3]});
      divided.triangles.push_back(middle);
    }
    bore = welded(divided);
  }
  const std::vector<CheckedFit> fits =
      fitsOf({part("bore", bore), part("shaft", makeCylinder(0.006, 0.05, 100))});
  ASSERT_EQ(fits.size(), 1U);
  EXPECT_NEAR(fits[0].diametral_clearance_m, 100e-6, 1e-9);
  EXPECT_LT(fits[0].error_m, 1e-9);
  EXPECT_NEAR(fits[0].length_m, 0.03, 1e-9);
}

TEST(CheckFits, AKeywayLeavesTheRestOfTheBore) {
  // The bore covers 300 degrees; the facets of the other 60 degrees are left out, so the surface is open.
  Mesh bore = makeTube(0.02, 0.00601, 0.03, 180);
  std::erase_if(bore.triangles, [&](const auto& t) {
    const Vec3 p = (bore.vertices[t[0]] + bore.vertices[t[1]] + bore.vertices[t[2]]) / 3;
    return p.x() > 0 && std::abs(p.y()) < 0.5 * p.x() && p.head<2>().norm() < 0.0061;
  });
  const std::vector<CheckedFit> fits =
      fitsOf({part("bore", bore), part("shaft", makeCylinder(0.006, 0.05, 180))});
  ASSERT_EQ(fits.size(), 1U);
  EXPECT_NEAR(fits[0].diametral_clearance_m, 20e-6, 1e-12);
}

TEST(CheckFits, ASteppedShaftFitsEachOfItsBores) {
  const Mesh shaft =
      test::lathe({{0, 0}, {5e-3, 0}, {5e-3, 10e-3}, {8e-3, 10e-3}, {8e-3, 20e-3}, {0, 20e-3}}, 200);
  const Mesh housing = test::lathe(
      {{5.01e-3, -1e-3}, {20e-3, -1e-3}, {20e-3, 21e-3}, {8.02e-3, 21e-3}, {8.02e-3, 9e-3}, {5.01e-3, 9e-3}},
      200);
  std::vector<CheckedFit> fits = fitsOf({part("shaft", shaft), part("housing", housing)});
  ASSERT_EQ(fits.size(), 2U);
  std::sort(fits.begin(), fits.end(), [](const auto& a, const auto& b) { return a.shaft_m < b.shaft_m; });
  EXPECT_NEAR(fits[0].diametral_clearance_m, 20e-6, 1e-12);
  EXPECT_NEAR(fits[0].length_m, 9e-3, 1e-9);
  EXPECT_NEAR(fits[1].diametral_clearance_m, 40e-6, 1e-12);
  EXPECT_NEAR(fits[1].length_m, 10e-3, 1e-9);
}

TEST(CheckFits, PrismsConesAndBallsAreNoShafts) {
  const Mesh plate = makeTube(0.02, 0.0101, 0.03, 400);
  const Mesh cone = test::lathe({{0, 0}, {10e-3, 0}, {9.9e-3, 20e-3}, {0, 20e-3}}, 400);
  EXPECT_TRUE(fitsOf({part("bore", plate), part("prism", makeCylinder(0.01, 0.05, 8))}).empty());
  EXPECT_TRUE(fitsOf({part("bore", plate), part("cone", cone)}).empty());
  EXPECT_TRUE(fitsOf({part("bore", plate), part("ball", makeSphere(0.01, 4))}).empty());
}

TEST(CheckFits, AKeyInASlotHasItsWidthsAndClearance) {
  const Pose X(rotationFromVector(Vec3(0.2, 0.5, -0.4)), Vec3(0.01, 0.02, 0.03));
  for (const double clearance_m : {-5e-6, 0.0, 40e-6, 0.3e-3}) {
    const double wall_m = 10e-3, slot_m = 5e-3 + clearance_m;
    // The slot is one part: two walls on a floor.
    Mesh slot = makeBox(Vec3(0.03, 0.03, 0.01));
    for (const double side : {-1.0, 1.0})
      append(slot, transformed(makeBox(Vec3(wall_m, 0.03, 0.01)),
                               Pose::translation(Vec3(side * (slot_m + wall_m) / 2, 0, 0.01))));
    const Pose X_key = X * Pose::translation(Vec3(0, 0, 0.0081));
    const std::vector<CheckedFit> fits =
        fitsOf({part("slot", slot, X), part("key", makeBox(Vec3(5e-3, 0.02, 0.006)), X_key)});
    ASSERT_EQ(fits.size(), 1U) << clearance_m;
    EXPECT_EQ(fits[0].kind, FitKind::Key);
    EXPECT_EQ(fits[0].shaft, "key");
    EXPECT_NEAR(fits[0].shaft_m, 5e-3, 1e-12);
    EXPECT_NEAR(fits[0].diametral_clearance_m, clearance_m, 1e-12);
    EXPECT_LT(fits[0].error_m, 1e-12);
    EXPECT_NEAR(std::abs(fits[0].axis_W.dot(X.R * Vec3::UnitX())), 1, 1e-12);
    EXPECT_NEAR(fits[0].length_m, 0.02, 1e-9);
  }
}

/// Divides each triangle into four, and moves the corners towards its middle by a share of its size.
Mesh inPieces(const Mesh& mesh, int times, double drawn) {
  Mesh out;
  const auto add = [&](const std::array<Vec3, 3>& t) {
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3;
    const auto n = static_cast<std::uint32_t>(out.vertices.size());
    for (const Vec3& p : t) out.vertices.emplace_back(p + drawn * (middle - p));
    out.triangles.push_back({n, n + 1, n + 2});
  };
  const auto divide = [&](const auto& self, const std::array<Vec3, 3>& t, int left) -> void {
    if (left == 0) return add(t);
    const Vec3 a = 0.5 * (t[0] + t[1]), b = 0.5 * (t[1] + t[2]), c = 0.5 * (t[2] + t[0]);
    for (const auto& part : {std::array{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}})
      self(self, part, left - 1);
  };
  for (const auto& t : mesh.triangles)
    divide(divide, {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, times);
  return out;
}

// There are cracks of about 20 um between all facets.
TEST(CheckFits, AFaceInPiecesFitsOnce) {
  const Mesh key = makeBox(Vec3(0.03, 10e-3, 8e-3)), wall = makeBox(Vec3(0.03, 5e-3, 8e-3));
  Mesh slot = transformed(wall, Pose::translation(Vec3(0, 7.52e-3, 0)));
  append(slot, transformed(wall, Pose::translation(Vec3(0, -7.52e-3, 0))));
  const auto fitsOf = [](const Mesh& inner, const Mesh& outer) {
    return checkAssembly("test", {{"slot", outer, Pose(), {}, false}, {"key", inner, Pose(), {}, false}},
                         {.has_play = false})
        .fits;
  };
  const std::vector<CheckedFit> whole = fitsOf(key, slot);
  const std::vector<CheckedFit> pieces = fitsOf(inPieces(key, 3, 0.01), inPieces(slot, 3, 0.01));
  ASSERT_EQ(whole.size(), 1U);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_NEAR(pieces[0].diametral_clearance_m, 40e-6, 1e-9);
  EXPECT_NEAR(pieces[0].length_m, whole[0].length_m, 0.1e-3);
}

// H11/c11, the loosest common fit, has a clearance of up to 0.18 mm below 3 mm, so a share of the size does
// not limit the clearance.
TEST(CheckFits, AThinPlateFitsItsSlot) {
  for (const double thick_m : {0.05e-3, 0.5e-3}) {
    const Mesh wall = makeBox(Vec3(0.03, 5e-3, 8e-3));
    const double middle_m = 2.5e-3 + 0.5 * thick_m + 20e-6;
    Mesh slot = transformed(wall, Pose::translation(Vec3(0, middle_m, 0)));
    append(slot, transformed(wall, Pose::translation(Vec3(0, -middle_m, 0))));
    const CheckResult found = checkAssembly(
        "test",
        {{"slot", slot, Pose(), {}, false}, {"plate", makeBox(Vec3(0.02, thick_m, 6e-3)), Pose(), {}, false}},
        {.has_play = false});
    ASSERT_EQ(found.fits.size(), 1U) << thick_m;
    EXPECT_NEAR(found.fits[0].shaft_m, thick_m, 1e-9);
    EXPECT_NEAR(found.fits[0].diametral_clearance_m, 40e-6, 1e-9);
  }
}

TEST(CheckFits, ABlockThatStandsBesideOneWallFitsNothing) {
  EXPECT_TRUE(fitsOf({part("floor", makeBox(Vec3(0.1, 0.1, 0.01))),
                      part("block", makeBox(Vec3(0.01, 0.01, 0.01)), Pose::translation(Vec3(0, 0, 0.01)))})
                  .empty());
}

}  // namespace
}  // namespace vps::scenes
