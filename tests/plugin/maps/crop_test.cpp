// SPDX-License-Identifier: BSD-3-Clause
#include "support/units.h"
#include "vps/box.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/analytic.h"
#include "vps/errors.h"
#include "vps/query.h"

namespace vps {
namespace {

Box boxOf(const Vec3& min, const Vec3& max) {
  Box box;
  box.add(min);
  box.add(max);
  return box;
}

/// A tube of 20 mm, and its upper half with a margin, where a peg of 6 mm moves.
struct TubeAndPeg {
  Mesh tube = makeTube(10 * kMm, 3.02 * kMm, 20 * kMm, 48), peg = makeCylinder(3 * kMm, 12 * kMm, 48);
  VoxMap map = buildVoxMap(tube, {0.25 * kMm, 4}), peg_map = buildVoxMap(peg, {0.25 * kMm, 4});
  PointShell shell = buildPointShell(tube, {0.5 * kMm, 0.35}),
             peg_shell = buildPointShell(peg, {0.5 * kMm, 0.35});
  std::vector<Box> boxes = {boxOf({-6 * kMm, -6 * kMm, -1 * kMm}, {6 * kMm, 6 * kMm, 20 * kMm})};
};

/// Poses of the peg whose box, grown by the band, stays in the tube's region.
std::vector<Pose> posesInRegion(const TubeAndPeg& pair) {
  test::RandomPoints random(7);
  std::vector<Pose> poses;
  while (poses.size() < 200) {
    const Pose X_TP{rotationFromVector(random.inBox(Vec3::Constant(0.05))),
                    Vec3(0, 0, 11 * kMm) + random.inBox({1 * kMm, 1 * kMm, 4 * kMm})};
    if (isWithin(grown(moved(bounds(pair.peg), X_TP), pair.map.band_m()), pair.boxes[0]))
      poses.push_back(X_TP);
  }
  return poses;
}

void expectSameContacts(const ContactSet& a, const ContactSet& b) {
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].p_M, b.contacts[i].p_M);
    EXPECT_EQ(a.contacts[i].n_M, b.contacts[i].n_M);
    EXPECT_EQ(a.contacts[i].distance_m, b.contacts[i].distance_m);
    EXPECT_EQ(a.contacts[i].area_m2, b.contacts[i].area_m2);
  }
}

ContactSet contactsOf(const VoxMap& map, const PointShell& shell, const Pose& X_MP) {
  ContactSet set(shell.size());
  QueryOptions options;
  options.cutoff_m = 0.2 * kMm;
  EXPECT_EQ(queryContacts(map, shell, X_MP, options, set).status, Status::Ok);
  return set;
}

TEST(Crop, ACroppedMapReadsTheSameBitsInItsBoxesAndUsesLessMemory) {
  const TubeAndPeg pair;
  const VoxMap cropped = croppedVoxMap(pair.map, pair.boxes);
  test::RandomPoints random(3);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = pair.boxes[0].center() + random.inBox(0.5 * pair.boxes[0].size());
    ASSERT_EQ(pair.map.distance(p), cropped.distance(p));
    ASSERT_EQ(pair.map.normal(p), cropped.normal(p));
    ASSERT_EQ(pair.map.leastDistance(p), cropped.leastDistance(p));
  }
  // The region contains the bore's upper half and none of the outer wall: less than half of the surface.
  EXPECT_LT(cropped.brickCount(), pair.map.brickCount() / 2);
  EXPECT_LT(cropped.memoryBytes(), pair.map.memoryBytes());
}

TEST(Crop, APartThatStaysInTheBoxesHasTheSameContactsBothWays) {
  const TubeAndPeg pair;
  const VoxMap map = croppedVoxMap(pair.map, pair.boxes);
  const PointShell shell = croppedShell(pair.shell, pair.boxes);
  ASSERT_LT(shell.size(), pair.shell.size() / 2);
  std::size_t found = 0;
  for (const Pose& X_TP : posesInRegion(pair)) {
    const ContactSet of_peg = contactsOf(pair.map, pair.peg_shell, X_TP);
    expectSameContacts(of_peg, contactsOf(map, pair.peg_shell, X_TP));
    const ContactSet of_tube = contactsOf(pair.peg_map, pair.shell, X_TP.inverse());
    expectSameContacts(of_tube, contactsOf(pair.peg_map, shell, X_TP.inverse()));
    found += of_peg.contacts.size() + of_tube.contacts.size();
  }
  EXPECT_GT(found, 10000u) << "the poses must touch, or the test shows nothing";
}

TEST(Crop, ACroppedShellKeepsThePointsInItsBoxesOnly) {
  const TubeAndPeg pair;
  const PointShell shell = croppedShell(pair.shell, pair.boxes);
  std::size_t next = 0;
  for (std::size_t i = 0; i < pair.shell.size(); ++i) {
    Box point;
    point.add(pair.shell.points[i]);
    if (!isWithin(point, pair.boxes[0])) continue;
    ASSERT_LT(next, shell.size());
    EXPECT_EQ(shell.points[next], pair.shell.points[i]);
    EXPECT_EQ(shell.area_m2[next++], pair.shell.area_m2[i]);
  }
  EXPECT_EQ(next, shell.size());
  std::vector<bool> is_listed(shell.size(), false);
  for (const std::uint32_t i : shell.order) is_listed.at(i) = true;
  EXPECT_EQ(std::count(is_listed.begin(), is_listed.end(), true), static_cast<long>(shell.size()));
  EXPECT_EQ(croppedShell(pair.shell, {}).size(), 0u);
}

TEST(Crop, ACroppedMapCanBeMountedUpon) {
  const TubeAndPeg pair;
  const Pose X_TP = Pose::translation({0, 0, 6 * kMm});
  const VoxMap whole = mountVoxMap(pair.map, PlacedMesh{&pair.peg, X_TP});
  const VoxMap cropped = mountVoxMap(croppedVoxMap(pair.map, pair.boxes), PlacedMesh{&pair.peg, X_TP});
  test::RandomPoints random(5);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = pair.boxes[0].center() + random.inBox(0.5 * pair.boxes[0].size());
    ASSERT_EQ(whole.distance(p), cropped.distance(p));
    ASSERT_EQ(whole.owner(p), cropped.owner(p));
  }
}

TEST(Crop, AMountedMapSharesMemoryWithTheMapBelow) {
  const TubeAndPeg pair;
  const VoxMap mounted = mountVoxMap(pair.map, PlacedMesh{&pair.peg, Pose::translation({0, 0, 6 * kMm})});
  EXPECT_EQ(pair.map.additionalMemoryBytes(pair.map), 0u);
  EXPECT_LT(mounted.additionalMemoryBytes(pair.map), pair.map.memoryBytes() / 2);
  EXPECT_EQ(pair.peg_map.additionalMemoryBytes(pair.map), pair.peg_map.memoryBytes());
}

}  // namespace
}  // namespace vps
