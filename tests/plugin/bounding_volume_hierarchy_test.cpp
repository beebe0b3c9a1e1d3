// SPDX-License-Identifier: BSD-3-Clause
#include "vps/bounding_volume_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include "support/random_draw.h"

namespace vps {
namespace {

Box drawnBox(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Vec3 center = test::drawnVector(normal, random),
             half = 0.1 * test::drawnVector(normal, random).cwiseAbs();
  return {center - half, center + half};
}

std::vector<Box> drawnBoxes(std::size_t count, std::mt19937& random) {
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) boxes.push_back(drawnBox(random));
  return boxes;
}

std::size_t halfOf(std::span<std::uint32_t> items) {
  return items.size() / 2;
}

TEST(Hierarchy, OfNothingIsEmpty) {
  EXPECT_TRUE(buildHierarchy(0, halfOf).nodes.empty());
  EXPECT_TRUE(BoxTree({}).nodes().empty());
}

TEST(Hierarchy, DividesInTheOrderOfTheNodes) {
  std::vector<std::vector<std::uint32_t>> seen;
  const Hierarchy tree = buildHierarchy(11, [&](std::span<std::uint32_t> items) {
    seen.emplace_back(items.begin(), items.end());
    std::reverse(items.begin(), items.end());
    return items.size() > 2 ? items.size() / 3 : 0;
  });
  ASSERT_EQ(seen.size(), tree.nodes.size());
  EXPECT_TRUE(std::is_sorted(seen[0].begin(), seen[0].end()));
  for (std::size_t n = 0; n < seen.size(); ++n) {
    const HierarchyNode& node = tree.nodes[n];
    EXPECT_TRUE(std::is_permutation(seen[n].begin(), seen[n].end(), tree.order.begin() + node.first,
                                    tree.order.begin() + node.end));
    EXPECT_EQ(node.isLeaf(), node.end - node.first <= 2);
    if (node.isLeaf()) {
      EXPECT_EQ(node.skip, n + 1);
      continue;
    }
    const HierarchyNode &left = tree.nodes[n + 1], &right = tree.nodes[node.right];
    EXPECT_EQ(left.first, node.first);
    EXPECT_EQ(left.end, node.first + (node.end - node.first) / 3);
    EXPECT_EQ(right.first, left.end);
    EXPECT_EQ(right.end, node.end);
    EXPECT_EQ(left.skip, node.right);
    EXPECT_EQ(right.skip, node.skip);
  }
  EXPECT_EQ(tree.nodes[0].skip, tree.nodes.size());
}

// Of items with equal keys, the items with the lower indices go to the left.
TEST(Hierarchy, TellsEqualKeysApartByIndex) {
  std::vector<std::uint32_t> items = {7, 2, 9, 4, 0, 5};
  divideByKey(items, 3, [](std::uint32_t) { return 1.0; });
  EXPECT_EQ(std::set<std::uint32_t>(items.begin(), items.begin() + 3), (std::set<std::uint32_t>{0, 2, 4}));
  const std::vector<Vec3> points = {{0, 3, 0}, {1, 0, 0}, {0, 9, 2}, {1, 5, 0}};
  std::vector<std::uint32_t> all = {0, 1, 2, 3};
  divideByPoint(all, 2, points);
  EXPECT_EQ(std::set<std::uint32_t>(all.begin(), all.begin() + 2), (std::set<std::uint32_t>{0, 1}));
}

TEST(BoxTree, NodesAreTheBoxesAroundTheirItems) {
  std::mt19937 random(1);
  for (const std::size_t count : {1, 2, 5, 100})
    for (const auto axis : {BoxTree::Axis::OfCenters, BoxTree::Axis::OfBoxes}) {
      const std::vector<Box> boxes = drawnBoxes(count, random);
      const BoxTree tree(boxes, 3, axis);
      for (const BoxTree::Node& node : tree.nodes()) {
        EXPECT_TRUE(!node.isLeaf() || node.end - node.first <= 3);
        Box around;
        for (std::uint32_t i = node.first; i < node.end; ++i) {
          around.add(boxes[tree.order()[i]].min);
          around.add(boxes[tree.order()[i]].max);
        }
        EXPECT_EQ(node.box.min, around.min);
        EXPECT_EQ(node.box.max, around.max);
      }
    }
}

TEST(BoxTree, FindsTheOverlapsThatATestOfAllBoxesFinds) {
  std::mt19937 random(2);
  const std::vector<Box> boxes = drawnBoxes(200, random);
  const BoxTree tree(boxes);
  std::size_t found_count = 0;
  for (int i = 0; i < 100; ++i) {
    const Box box = grown(drawnBox(random), i % 2 == 0 ? 0 : 0.5);  // few boxes overlap it, or many
    std::set<std::uint32_t> expected, found, wanted;
    for (std::uint32_t k = 0; k < boxes.size(); ++k)
      if (overlap(boxes[k], box)) expected.insert(k);
    EXPECT_TRUE(tree.forEachOverlap(boxes, box, [&](std::uint32_t k) { return found.insert(k).second; }));
    EXPECT_EQ(found, expected);
    tree.forEach([&](const Box& node) { return overlap(node, box); },
                 [&](std::uint32_t k) {
                   if (!overlap(boxes[k], box)) return;
                   EXPECT_TRUE(wanted.insert(k).second);
                 });
    EXPECT_EQ(wanted, expected);
    found_count += found.size();
    int visits = 0;
    EXPECT_EQ(tree.forEachOverlap(boxes, box, [&](std::uint32_t) { return ++visits < 1; }), found.empty());
    EXPECT_EQ(visits, found.empty() ? 0 : 1);
  }
  EXPECT_GT(found_count, 100U);
  EXPECT_TRUE(tree.forEachOverlap(boxes, Box(), [](std::uint32_t) { return false; }));
}

TEST(BoxTree, PairsFindTheLeastDistanceOfAllPairs) {
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    const std::vector<Box> a = drawnBoxes(40, random), b = drawnBoxes(70, random);
    const Vec3 moved(0.5 * i, 0, 0);
    const auto place = [&](const Box& box) { return Box{box.min + moved, box.max + moved}; };
    const double infinite = std::numeric_limits<double>::infinity();
    double least2 = infinite, found2 = infinite;
    for (const Box& of_a : a)
      for (const Box& of_b : b) least2 = std::min(least2, distance2(of_a, place(of_b)));
    std::size_t visits = 0;
    visitPairs(
        BoxTree(a), BoxTree(b, 2), place, distance2, [&] { return found2; },
        [&](std::uint32_t k, std::uint32_t l) {
          ++visits;
          found2 = std::min(found2, distance2(a[k], place(b[l])));
        });
    EXPECT_EQ(found2, least2);
    EXPECT_LT(visits, a.size() * b.size() / 2);
  }
}

}  // namespace
}  // namespace vps
