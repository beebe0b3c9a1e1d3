// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "case_run.h"
#include "families.h"
#include "faults.h"
#include "prism.h"
#include "support/temporary_folder.h"
#include "vps/solid.h"

namespace vps::search {
namespace {

OverlapMesh overlapMesh(const Mesh& mesh) {
  return OverlapMesh(std::make_shared<const Solid>(mesh));
}

double areaOf(const Polygon& polygon) {
  double twice_m2 = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice_m2 += a.x() * b.y() - a.y() * b.x();
  }
  return twice_m2 / 2;
}

TEST(Prism, WithHolesIsClosedAndHasItsVolume) {
  const Polygon outline{{0, 0}, {5, 0}, {5, 4}, {3, 1.5}, {1, 4}, {0, 2}};
  const std::vector<Polygon> holes{rectangle(Vec2(0.5, 0.3), Vec2(1, 1)),
                                   rectangle(Vec2(2, 0.2), Vec2(4, 0.5))};
  const Mesh prism = makePrism(outline, holes, -1, 2);
  EXPECT_TRUE(checkMesh(prism).isClosed());
  EXPECT_EQ(checkMesh(prism).shells, 1U);
  const double base_m2 = areaOf(outline) - areaOf(holes[0]) - areaOf(holes[1]);
  EXPECT_NEAR(massProperties(prism).volume_m3, 3 * base_m2, 1e-12);
}

TEST(Prism, EnlargedSidesAreParallelAtTheDistance) {
  const Polygon square = rectangle(Vec2(-1, -2), Vec2(1, 2));
  EXPECT_NEAR(areaOf(enlarged(square, 0.1)), 2.2 * 4.2, 1e-12);
  const Polygon hexagon = regularPolygon(6, 1);
  EXPECT_NEAR(areaOf(enlarged(hexagon, 0.5)), areaOf(hexagon) * 1.5 * 1.5, 1e-12);
}

TEST(PassThrough, AFastPlateIsFoundAndASlowOneNot) {
  const OverlapMesh wall = overlapMesh(makeBox(Vec3(0.002, 1, 1))),
                    block = overlapMesh(makeBox(Vec3(0.01, 0.01, 0.01)));
  const auto at = [](double x) { return Pose::translation(Vec3(x, 0, 0)); };
  EXPECT_TRUE(hasPassedThrough(block, wall, at(-0.02), at(0.02), 1e-4));
  EXPECT_FALSE(hasPassedThrough(block, wall, at(-0.02), at(-0.0061), 1e-4));
  EXPECT_FALSE(hasPassedThrough(block, wall, at(0.02), at(0.04), 1e-4));
  // The front corners of the block are inside the wall, which is an overlap and not a passage.
  EXPECT_FALSE(hasPassedThrough(block, wall, at(-0.02), at(-0.005), 1e-4));
}

TEST(Random, NumbersAreInTheirRangesAndRepeat) {
  Random a(7), b(7), other(8);
  std::set<int> seen;
  for (int i = 0; i < 1000; ++i) {
    const double x = a.uniform(2, 3);
    EXPECT_EQ(x, b.uniform(2, 3));
    EXPECT_NE(x, other.uniform(2, 3));
    EXPECT_TRUE(x >= 2 && x < 3);
    const double y = a.logUniform(1e-6, 1e-3);
    EXPECT_TRUE(y >= 1e-6 && y <= 1e-3);
    b.logUniform(1e-6, 1e-3);
    const int k = a.index(5);
    EXPECT_EQ(k, b.index(5));
    seen.insert(k);
    EXPECT_NEAR(a.direction().norm(), 1, 1e-15);
    b.direction();
  }
  EXPECT_EQ(seen, (std::set<int>{0, 1, 2, 3, 4}));
}

class FamilyTest : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] static const Family& family() { return *findFamily(GetParam()); }
};

TEST_P(FamilyTest, MakesClosedBodiesThatStartApart) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Case made = makeCase(family(), seed, false);
    std::vector<Pose> poses;
    int moving = 0;
    for (const CaseBody& body : made.bodies) {
      EXPECT_TRUE(checkMesh(body.mesh).isClosed()) << seed << ' ' << body.name;
      EXPECT_EQ(checkMesh(body.mesh).shells, 1U) << seed << ' ' << body.name;
      EXPECT_GT(massProperties(body.mesh).volume_m3, 1e-9) << seed << ' ' << body.name;  // a cube of 1 mm
      EXPECT_LE(body.V_WP_W.v.norm(), 1.0 + 1e-12);
      poses.push_back(body.X_WP);
      moving += body.is_fixed ? 0 : 1;
    }
    EXPECT_GT(moving, 0);
    EXPECT_EQ(deepestOverlap(made, poses).overlap.depth_m, 0) << seed;
  }
}

TEST_P(FamilyTest, HasFaultyMeshesOfTheSameSolid) {
  const Case made = makeCase(family(), 3, true);
  bool is_any_faulty = false;
  for (const CaseBody& body : made.bodies) {
    is_any_faulty = is_any_faulty || !checkMesh(body.given).isClosed();
    for (const Vec3& p : body.given.vertices) EXPECT_LE(body.exact->solid().closest(p).distance_m, kCrack_m);
  }
  EXPECT_TRUE(is_any_faulty);
}

TEST_P(FamilyTest, RepeatsToTheBit) {
  const auto run = [](std::uint64_t seed) {
    Case made = makeCase(family(), seed, false);
    made.seconds = 0.05;
    return runCase(made, {});
  };
  const CaseResult first = run(5);
  EXPECT_EQ(first.refusal, "");
  EXPECT_EQ(first.hash, run(5).hash);
  EXPECT_NE(first.hash, run(6).hash);
}

INSTANTIATE_TEST_SUITE_P(Each, FamilyTest,
                         testing::Values("tslot", "dovetail", "key", "square_peg", "hexagonal_peg", "comb",
                                         "puzzle", "chain", "tetrahedra", "stairs", "prisms", "rings"),
                         [](const auto& info) { return std::string(info.param); });

// In an earlier version, the push that restores the gaps of a jammed part reduced the gap of a cracked edge
// step by step, until the edge was 43 um deep.
TEST(Search, TheGapOfASharpEdgeIsNotTakenByAPush) {
  EXPECT_LE(runCase(makeCase(*findFamily("puzzle"), 9011, true), {}).deepest.overlap.depth_m, 10e-6);
}

// The search must notice a body that passes through a floor which the engine does not know.
TEST(Search, FindsABodyThatGoesThroughAnother) {
  Case made;
  made.bodies.push_back({"floor", makeBox(Vec3(0.1, 0.1, 0.005)), {}, Pose(), true, 0.15, {}});
  made.bodies.push_back(
      {"block", makeBox(Vec3(0.01, 0.01, 0.01)), {}, Pose::translation(Vec3(0, 0, 0.01)), false, 0.15, {}});
  for (CaseBody& body : made.bodies)
    body.exact = std::make_shared<const OverlapMesh>(std::make_shared<const Solid>(body.mesh));
  made.bodies[1].given = made.bodies[1].mesh;
  // The engine gets a floor that is 20 mm lower.
  made.bodies[0].given = transformed(made.bodies[0].mesh, Pose::translation(Vec3(0, 0, -0.02)));
  made.seconds = 0.1;
  const CaseResult result = runCase(made, {});
  EXPECT_TRUE(result.has_tunnelled);
  EXPECT_GT(result.deepest.overlap.depth_m, kLost_m);
  ASSERT_FALSE(result.before.empty());

  const test::TemporaryFolder folder;
  const auto file = saveCase(folder.path() / "case", made, {}, result, "how it was made");
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_NE(text.str().find("how it was made"), std::string::npos);
  EXPECT_NE(text.str().find("velocity_m_s = ["), std::string::npos);
  // The body falls without the hand.
  EXPECT_EQ(text.str().find("only with the hand"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "case" / "block.stl"));
}

}  // namespace
}  // namespace vps::search
