// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/touch_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <set>

#include "query/features/direction_cone.h"
#include "query/features/feature_contact.h"
#include "support/random_draw.h"
#include "support/screw.h"
#include "vps/contact_tolerances.h"
#include "vps/feature_set.h"
#include "vps/mesh.h"
#include "vps/mesh_distance.h"

namespace vps {
namespace {

bool isAllowed(const std::vector<Vec3>& rays, const Vec3& n, double slope) {
  return std::all_of(rays.begin(), rays.end(), [&](const Vec3& ray) { return n.dot(ray) >= -slope; });
}

// Rays of spikes, edges, flat places, saddles and random directions; the cone may be larger than necessary.
TEST(TouchCone, HoldsEveryDirectionThatAllRaysAllow) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> wide(0.1, 3.0);
  int empty = 0, narrow = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Vec3 axis = test::drawnDirection(random);
    const double spread = wide(random);
    std::vector<Vec3> rays;
    for (int i = 0; i < 3 + trial % 6; ++i)
      rays.push_back((axis + spread * test::drawnDirection(random)).normalized());
    if (trial % 3 == 0) rays.push_back(-rays[0]);  // a straight edge: two opposite rays
    const auto cone = touchCone(rays, kSinTouch);
    if (!cone) ++empty;
    if (cone && cone->angle_rad < 1.5) ++narrow;
    for (int k = 0; k < 3000; ++k) {
      const Vec3 n = test::drawnDirection(random);
      if (!isAllowed(rays, n, kSinTouch)) continue;
      ASSERT_TRUE(cone) << trial;
      ASSERT_LE(std::acos(std::clamp(n.dot(cone->axis), -1.0, 1.0)), cone->angle_rad + 1e-12) << trial;
    }
  }
  EXPECT_GT(empty, 5);
  EXPECT_GT(narrow, 100);
}

FeatureSet featuresOf(const Mesh& mesh) {
  FeatureSet features;
  features.append(mesh, Pose(), false);
  features.build();
  return features;
}

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

enum class Near { ToTheFacet, ToItsBoxAndPlane };

bool isNear(const FeatureSet& facets, std::uint32_t f, const Vec3& p, double margin_m, Near near) {
  const auto corner = [&](int k) -> const Vec3& { return facets.vertices()[facets.facets()[f][k]]; };
  if (near == Near::ToTheFacet)
    return (p - closestOnTriangle(p, corner(0), corner(1), corner(2)).q).norm() <= margin_m;
  Box box;
  for (int k = 0; k < 3; ++k) box.add(corner(k));
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).norm() <= margin_m &&
         std::abs(facets.normal(f).dot(p - corner(0))) <= margin_m;
}

// Tests every corner against every facet, by the definition.
// @param turn  rotation of the parts since the search
// @param slack_rad  tolerance for sines and cosines
Pairs searchAll(const FeatureSet& corners, const FeatureSet& facets, const Pose& X, double margin_m,
                Near near, const Mat3& turn, double slack_rad) {
  const double surely_flush = -std::cos(std::acos(kCosSameFace) - slack_rad);
  const Mat3 R = turn * X.R;
  Pairs found;
  for (std::uint32_t c = 0; c < corners.corners().size(); ++c) {
    const Vec3 p = X * corners.vertices()[corners.corners()[c]];
    for (std::uint32_t f = 0; f < facets.facets().size(); ++f) {
      const Vec3& n = facets.normal(f);
      bool can_touch = isNear(facets, f, p, margin_m, near);
      for (const Vec3& ray : corners.raysAt(c))
        can_touch = can_touch && n.dot(R * ray) >= -kSinTouch - slack_rad;
      if (facets.isCurved(f))
        for (const std::uint32_t edge : corners.edgesAt(c))
          for (const Vec3& own : corners.edges()[edge].normal)
            can_touch = can_touch && !((R * own).dot(n) < surely_flush);
      if (can_touch) found.emplace(c, f);
    }
  }
  return found;
}

bool holds(const Pairs& all, const Pairs& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

TEST(TouchSearch, FindsWhatASearchAmongAllPairsFinds) {
  test::ThreadShape thread;
  thread.columns = 48;
  thread.rows_per_pitch = 16;
  thread.length_m = 2 * thread.pitch_m;
  const FeatureSet nut = featuresOf(test::makeNut(thread, 1.8 * thread.major_m));
  const FeatureSet rod = featuresOf(test::makeThreadedRod(thread));
  const FeatureSet box = featuresOf(makeBox(Vec3(6e-3, 8e-3, 5e-3)));
  const FeatureSet tube = featuresOf(makeTube(5e-3, 3e-3, 6e-3, 60));
  const FeatureSet ball = featuresOf(makeSphere(5e-3, 3));
  std::mt19937 random(5);
  std::size_t count = 0;
  const auto compare = [&](const FeatureSet& a, const FeatureSet& b, const Pose& X, double margin_m,
                           double slack_rad) {
    std::vector<TouchPair> found;
    findTouchPairs(a, b, {X, X}, margin_m, slack_rad, found);
    Pairs pairs;
    for (const TouchPair& pair : found) pairs.emplace(pair.corner, pair.facet);
    EXPECT_EQ(pairs.size(), found.size());
    // The search finds all pairs that can touch after a rotation by less than slack_rad. Other pairs are
    // found only within the tolerance of a product of unit vectors.
    EXPECT_TRUE(
        holds(searchAll(a, b, X, margin_m, Near::ToItsBoxAndPlane, Mat3::Identity(), slack_rad), pairs));
    for (int k = 0; k < 3; ++k) {
      const Mat3 turn = rotationFromVector(slack_rad * test::drawnDirection(random));
      EXPECT_TRUE(holds(pairs, searchAll(a, b, X, margin_m * (1 - 1e-9), Near::ToTheFacet, turn, 0)));
    }
    count += pairs.size();
  };
  const FeatureSet* all[] = {&nut, &rod, &box, &tube, &ball};
  std::uniform_real_distribution<double> away(0, 4e-3), margin(10e-6, 1e-3), slack(0, 0.3);
  for (const FeatureSet* a : all)
    for (const FeatureSet* b : all)
      for (int trial = 0; trial < 3; ++trial) {
        const Vec3 axis = test::drawnDirection(random), way = test::drawnDirection(random);
        const Pose X(rotationFromVector(3 * axis), away(random) * way);
        const double margin_m = margin(random), slack_rad = slack(random);
        compare(*a, *b, X, margin_m, slack_rad);
        compare(*a, *b, X, margin_m, 0);
      }
  EXPECT_GT(count, 1000u);
}

// A pair that is found at any place of a straight motion is found for the whole motion.
TEST(TouchSearch, FindsWhatComesNearOnAWay) {
  test::ThreadShape thread;
  thread.columns = 48;
  thread.rows_per_pitch = 16;
  thread.length_m = 2 * thread.pitch_m;
  const FeatureSet nut = featuresOf(test::makeNut(thread, 1.8 * thread.major_m));
  const FeatureSet box = featuresOf(makeBox(Vec3(6e-3, 8e-3, 5e-3)));
  const FeatureSet tube = featuresOf(makeTube(5e-3, 3e-3, 6e-3, 60));
  std::mt19937 random(6);
  std::uniform_real_distribution<double> away(0, 4e-3), margin(10e-6, 0.3e-3), way(0, 2e-3);
  std::size_t count = 0, least = 0;
  const FeatureSet* all[] = {&nut, &box, &tube};
  for (const FeatureSet* a : all)
    for (const FeatureSet* b : all)
      for (int trial = 0; trial < 4; ++trial) {
        const Pose from(rotationFromVector(3 * test::drawnDirection(random)),
                        away(random) * test::drawnDirection(random));
        const Pose to(from.R, from.p + way(random) * test::drawnDirection(random));
        const double margin_m = margin(random);
        std::vector<TouchPair> found;
        findTouchPairs(*a, *b, {from, to}, margin_m, 0, found);
        Pairs pairs;
        for (const TouchPair& pair : found) pairs.emplace(pair.corner, pair.facet);
        for (const double share : {0.0, 0.4, 1.0}) {
          const Pose X(from.R, from.p + share * (to.p - from.p));
          const Pairs near =
              searchAll(*a, *b, X, margin_m * (1 - 1e-9), Near::ToTheFacet, Mat3::Identity(), 0);
          EXPECT_TRUE(holds(pairs, near));
          least += near.size();
        }
        count += pairs.size();
      }
  EXPECT_GT(least, 300u);
  EXPECT_GT(count, 300u);
}

// A thread in its nut: the thread's crests can touch only faces that lie flush on theirs.
TEST(TouchSearch, LeavesOutFlushThreads) {
  test::ThreadShape thread;
  thread.length_m = 10 * thread.pitch_m;
  const FeatureSet rod = featuresOf(test::makeThreadedRod(thread));
  thread.length_m = 5 * thread.pitch_m;
  thread.clearance_m = 20e-6;
  const FeatureSet nut = featuresOf(test::makeNut(thread, 1.8 * thread.major_m));
  std::vector<TouchPair> found;
  const Pose X = Pose::translation({0, 0, 2.5 * thread.pitch_m});
  findTouchPairs(rod, nut, {X, X}, 100e-6, 0.01, found);
  EXPECT_LT(found.size(), rod.corners().size());
}

}  // namespace
}  // namespace vps
