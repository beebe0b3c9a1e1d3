// SPDX-License-Identifier: BSD-3-Clause
// The kernels give the same bits on every processor, and their readings equal the trilinear formula.
#include "vps/simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>

#include "query/points/leaf_walk.h"
#include "support/random_draw.h"
#include "voxmap/kernels/read_kernel.h"
#include "voxmap/voxmap_layout.h"

namespace vps {
namespace {

constexpr int kCells = 8, kExtent = VoxMap::kBrick * kCells;  // of the field's directory, along each axis
constexpr Simd kWider[] = {Simd::Avx2, Simd::Avx512};

/// A field with the steepest possible nodes, within a rim of empty cells as in every map.
class SteepField {
 public:
  /// @param lone if given, the only cell with nodes
  SteepField(unsigned seed, double voxel_m, const Index3* lone = nullptr) {
    layout_.size = Index3::Constant(kCells);
    layout_.resizeCells();
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < layout_.bricks.size(); ++i) {
      const Index3 cell = layout_.cellAt(i);
      const bool is_wanted = lone ? cell == *lone : random() % 32 < (seed % 3 == 0 ? 2u : 24u);
      is_used_[i] = is_wanted && cell.minCoeff() > 0 && cell.maxCoeff() < kCells - 1;
      layout_.centers_m[i] = static_cast<float>(voxel_m * (static_cast<double>(random() % 9) - 2));
    }
    for (NodeValue& node : lattice_) node = steepNode(random);
    layout_.pool = std::make_shared<VoxPool>(layout_.bricks.size());
    for (std::size_t i = 0; i < layout_.bricks.size(); ++i)
      if (is_used_[i]) layout_.bricks[i] = makeBrick(layout_.cellAt(i));
    markFarCells(layout_);
    view_.voxel_m = voxel_m;
    view_.nodes = layout_.pool->nodes(0);
    view_.bricks = layout_.bricks.data();
    view_.centers_m = layout_.centers_m.data();
    view_.far_cells = layout_.far_cells.data();
    view_.voxels_per_m = static_cast<float>(1 / voxel_m);
    view_.quantum = view_.band / kFullBand;
    view_.quantum_m = static_cast<double>(view_.quantum) * voxel_m;
    for (int k = 0; k < 3; ++k) {
      view_.size[k] = kCells;
      view_.half[k] = 0.5 * kExtent;
      view_.box[0][k] = VoxMap::kBrick;
      view_.box[1][k] = kExtent - VoxMap::kBrick;
    }
  }

  [[nodiscard]] const FieldView& view() const { return view_; }
  [[nodiscard]] const VoxLayout& layout() const { return layout_; }

  /// The trilinear formula [quanta]; p is in voxels from the directory's corner.
  [[nodiscard]] double at(const Vec3& p) const {
    if (!((p.array() >= 0).all() && (p.array() < kExtent).all())) return kFullBand;
    const Index3 low = p.cast<int>();
    const Vec3 t = p - low.cast<double>();
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 step(corner >> 2, corner >> 1 & 1, corner & 1);
      double weight = 1;
      for (int k = 0; k < 3; ++k) weight *= step[k] ? t[k] : 1 - t[k];
      sum += weight * node(low + step);
    }
    return sum;
  }

 private:
  static NodeValue steepNode(std::mt19937& random) {
    if (random() % 2 == 0) return static_cast<NodeValue>(random() % 2 ? kFullBand : -kFullBand);
    return static_cast<NodeValue>(static_cast<int>(random() % (2 * kFullBand + 1)) - kFullBand);
  }
  /// Nodes that a brick shares with an empty cell have that cell's constant, so that the field is continuous.
  [[nodiscard]] NodeValue node(const Index3& at) const {
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 cell =
          (at - Index3(corner >> 2, corner >> 1 & 1, corner & 1)).unaryExpr([](int v) { return v >> 3; });
      if (!layout_.holds(cell) || !is_used_[layout_.cellIndex(cell)]) return kFullBand;
    }
    return lattice_[static_cast<std::size_t>((at.x() * kExtent + at.y()) * kExtent + at.z())];
  }
  std::uint32_t makeBrick(const Index3& cell) {
    const std::uint32_t brick = layout_.pool->take(1);
    NodeValue* nodes = layout_.pool->nodes(brick);
    std::fill_n(nodes, kBrickStride, NodeValue{0});
    for (int x = 0; x < kNodes; ++x)
      for (int y = 0; y < kNodes; ++y)
        for (int z = 0; z < kNodes; ++z)
          nodes[nodeIndex(x, y, z)] = node(VoxMap::kBrick * cell + Index3(x, y, z));
    return brick;
  }

  VoxLayout layout_;
  bool is_used_[kCells * kCells * kCells] = {};
  std::vector<NodeValue> lattice_ = std::vector<NodeValue>(kExtent * kExtent * kExtent);
  FieldView view_ = emptyView();

  static FieldView emptyView() {
    FieldView view{VoxMap()};
    view.band = 4;
    view.slope = 3;
    return view;
  }
};

/// A leaf or an inner block of up to sixteen points within `radius_m` of a centre.
ShellBlock randomBlock(std::mt19937& random, const Vec3& center, double radius_m, std::uint32_t count) {
  std::uniform_real_distribution<double> unit(-1, 1);
  ShellBlock block;
  block.radius_m = radius_m;
  block.count = count;
  block.is_leaf = 1;
  for (int k = 0; k < 3; ++k) block.center[k] = center[k];
  for (std::uint32_t i = 0; i < kLanes; ++i) {
    const double share = i % 2 ? 1 : std::abs(unit(random));
    Vec3 p = share * radius_m * test::drawnVector(unit, random).normalized();
    if (i >= count) p = Vec3(block.x[0], block.y[0], block.z[0]);
    block.x[i] = static_cast<float>(p.x());
    block.y[i] = static_cast<float>(p.y());
    block.z[i] = static_cast<float>(p.z());
    if (i < count) block.weight[i] = static_cast<float>(radius_m * std::abs(unit(random)));
  }
  return block;
}

/// A field, a pose, and a batch of blocks: inside, across the rim, at corners of cells, and very far away.
struct Trial {
  explicit Trial(unsigned seed)
      : random(seed), voxel_m(std::pow(10.0, -9 + static_cast<double>(seed % 13))), field(seed, voxel_m) {
    std::uniform_real_distribution<double> unit(-1, 1);
    X_MP = Pose{rotationFromVector(3 * test::drawnVector(unit, random)),
                voxel_m * 50 * test::drawnVector(unit, random)};
    for (int i = 0; i < kBatch; ++i) {
      Vec3 target = kExtent * 0.5 * (Vec3::Ones() + 1.2 * test::drawnVector(unit, random));
      if (i % 4 == 1) target = (target / 8).array().round().matrix() * 8;
      if (i % 8 == 2) target *= std::pow(10.0, static_cast<double>(random() % 13));
      if (i == 7) target = Vec3(-1e300, 1e300, 1e9);
      const double radius =
          i % 3 == 0 ? 7 * (1 + unit(random)) : std::pow(10.0, -3 + 2.45 * (1 + unit(random)));
      const double radius_m = voxel_m * radius;  // 1e-3 to 80 voxels
      blocks.push_back(randomBlock(random, X_MP.inverse() * (voxel_m * target), radius_m,
                                   i % 5 == 0 ? 1 : 1 + static_cast<std::uint32_t>(random() % kLanes)));
    }
  }

  std::unique_ptr<ReadBatch> read(Simd simd, const FieldView& view) const {
    auto batch = std::make_unique<ReadBatch>();
    std::memset(batch.get(), 0, sizeof *batch);
    const ShellBlock* pointers[kBatch];
    for (std::size_t i = 0; i < kBatch; ++i) pointers[i] = &blocks[i];
    readKernels(simd).read(view, GridPose(view, X_MP), pointers, kBatch, *batch);
    return batch;
  }
  [[nodiscard]] std::unique_ptr<ReadBatch> read(Simd simd) const { return read(simd, field.view()); }

  std::mt19937 random;
  double voxel_m;
  SteepField field;
  Pose X_MP;
  std::vector<ShellBlock> blocks;
};

constexpr unsigned kTrials = 150;

template <typename T>
bool sameBits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(SimdKernels, ReadsHaveTheSameBitsOnEveryPath) {
  std::size_t read = 0, skipped = 0;
  for (unsigned seed = 0; seed < kTrials; ++seed) {
    const Trial trial(seed);
    const auto plain = trial.read(Simd::Scalar);
    for (const bool is_read : plain->is_read) ++(is_read ? read : skipped);
    for (const Simd simd : kWider) {
      const auto wide = trial.read(simd);
      ASSERT_TRUE(sameBits(*wide, *plain)) << toText(availableSimd(simd)) << ", trial " << seed;
    }
  }
  EXPECT_GT(read, kTrials * kBatch / 3);
  EXPECT_GT(skipped, kTrials * kBatch / 8);
}

TEST(SimdKernels, ReadingsAreTheTrilinearFormula) {
  for (unsigned seed = 0; seed < kTrials; ++seed) {
    const Trial trial(seed);
    const auto batch = trial.read(Simd::Best);
    for (int i = 0; i < kBatch; ++i) {
      const ShellBlock& block = trial.blocks[static_cast<std::size_t>(i)];
      // Positions are rounded to whole steps. Errors in floats before positions are rounded: the matrix and
      // the point are rounded, then three products and three sums of numbers up to the block's radius and a
      // cell, each to 2^-24 of itself.
      const double radius = block.radius_m / trial.voxel_m;
      const double off_steps = 0.5 + (3 * 3 * radius + 3 * (8 + 2 * radius)) * kSteps * std::exp2(-24);
      // Errors in doubles: the centre, computed from the far corner of the pose.
      const double c = Vec3(block.center[0], block.center[1], block.center[2]).norm() / trial.voxel_m;
      const double off_voxels = off_steps / kSteps + 1e-15 * (c + 1000);
      // Neighbouring nodes differ by at most twice the band along each axis; sums of floats below the band
      // add their rounding.
      const double tol = 3 * 2 * kFullBand * off_voxels + 12 * kFullBand * std::exp2(-24);
      float least = kFullBand;
      for (int lane = 0; lane < kLanes; ++lane) {
        const Vec3 p_P = Vec3(block.center[0], block.center[1], block.center[2]) +
                         Vec3(block.x[lane], block.y[lane], block.z[lane]);
        const float value = batch->value[kLanes * i + lane];
        ASSERT_NEAR(value, trial.field.at(trial.X_MP * p_P / trial.voxel_m), tol)
            << "trial " << seed << ", block " << i << ", radius " << radius << " voxels";
        least = std::min(least, value);
      }
      ASSERT_EQ(batch->least[i], least);
    }
  }
}

TEST(SimdKernels, LeavesInEmptySurroundingsReadTheSameWithoutPlacement) {
  std::size_t saved = 0;
  for (unsigned seed = 0; seed < kTrials; ++seed) {
    const Trial trial(seed);
    FieldView unknown = trial.field.view();
    unknown.far_cells = nullptr;
    const auto known = trial.read(Simd::Best), placed = trial.read(Simd::Best, unknown);
    ASSERT_TRUE(sameBits(known->value, placed->value) && sameBits(known->least, placed->least));
    for (int i = 0; i < kBatch; ++i) saved += placed->is_read[i] && !known->is_read[i];
  }
  EXPECT_GT(saved, 20u);
}

TEST(SimdKernels, ALeafThatReachesBeyondTheNeighbourCellsIsRead) {
  const Index3 lone(4, 4, 4);
  const SteepField field(1, 1, &lone);
  std::mt19937 random(1);
  const auto batch = std::make_unique<ReadBatch>();
  for (double radius = 0.5; radius < 15; radius += 0.25) {
    // The block lies two cells beside the only cell with nodes; sixteen points on the near side are up to the
    // radius nearer.
    const Vec3 center(23.9, 36, 36);
    ShellBlock block = randomBlock(random, center, radius, kLanes);
    for (int i = 0; i < kLanes; ++i) {
      block.x[i] = static_cast<float>(radius * (i + 1) / kLanes);
      block.y[i] = block.z[i] = 0;
    }
    const ShellBlock* const blocks[1] = {&block};
    readKernels(Simd::Best).read(field.view(), GridPose(field.view(), Pose()), blocks, 1, *batch);
    for (int i = 0; i < kLanes; ++i)
      ASSERT_NEAR(batch->value[i], field.at(center + Vec3(static_cast<double>(block.x[i]), 0, 0)), 20.0);
  }
}

TEST(SimdKernels, AFarCellHasAsManyOuterCellsAroundAsItSays) {
  const Index3 lone(2, 4, 1);
  int most = 0;
  for (const bool is_lone : {false, true}) {
    const SteepField field(5, 1, is_lone ? &lone : nullptr);
    const VoxLayout& layout = field.layout();
    for (std::size_t i = 0; i < layout.bricks.size(); ++i) {
      int nearest = kMostFarCells + 1;  // distance to the nearest used cell, in cells on its farthest axis
      for (std::size_t k = 0; k < layout.bricks.size(); ++k)
        if (layout.bricks[k] != kOutside)
          nearest = std::min(nearest, (layout.cellAt(k) - layout.cellAt(i)).cwiseAbs().maxCoeff());
      ASSERT_EQ(layout.far_cells[i], std::max(0, nearest - 1));
      most = std::max(most, nearest - 1);
    }
  }
  EXPECT_GT(most, 3);
}

TEST(SimdKernels, SumsOfTouchingPointsHaveTheSameBitsOnEveryPath) {
  std::size_t touching = 0;
  for (unsigned seed = 0; seed < kTrials; ++seed) {
    const Trial trial(seed);
    const auto batch = trial.read(Simd::Scalar);
    const GridPose motion(trial.field.view(), trial.X_MP);
    const std::int32_t reference[3] = {static_cast<std::int32_t>(seed), -1'000'000'000, 17};
    const auto sumsBy = [&](Simd simd, std::uint32_t lost[kBatch]) {
      auto row = std::make_unique<RowSums>();
      auto sums = std::make_unique<TouchSums>();
      std::memset(static_cast<void*>(row.get()), 0, sizeof *row);
      for (int i = 0; i < kBatch; ++i)
        lost[i] = batch->least[i] < 0
                      ? readKernels(simd).touch(motion, *batch, i, trial.blocks[static_cast<std::size_t>(i)],
                                                reference, *row)
                      : 0;
      readKernels(simd).addRow(*row, *sums);
      touching += row->count;
      return std::pair(std::move(row), std::move(sums));
    };
    std::uint32_t lost[kBatch], wide_lost[kBatch];
    const auto [row, sums] = sumsBy(Simd::Scalar, lost);
    for (const Simd simd : kWider) {
      const auto [wide_row, wide_sums] = sumsBy(simd, wide_lost);
      ASSERT_TRUE(sameBits(*row, *wide_row) && sameBits(*sums, *wide_sums) && sameBits(lost, wide_lost))
          << toText(availableSimd(simd)) << ", trial " << seed;
    }
  }
  EXPECT_GT(touching, 1000u);
}

TEST(SimdKernels, BoundsOfSpheresHaveTheSameBitsOnEveryPath) {
  for (unsigned seed = 0; seed < kTrials; ++seed) {
    Trial trial(seed);
    const GridPose motion(trial.field.view(), trial.X_MP);
    for (const ShellBlock& block : trial.blocks)
      for (const float cutoff : {0.0f, 2.5f}) {
        SphereBounds plain, wide;
        readKernels(Simd::Scalar).bound(trial.field.view(), motion, block, cutoff, plain);
        for (const Simd simd : kWider) {
          readKernels(simd).bound(trial.field.view(), motion, block, cutoff, wide);
          ASSERT_TRUE(sameBits(plain, wide)) << toText(availableSimd(simd)) << ", trial " << seed;
        }
      }
  }
}

TEST(SimdKernels, ReadsAtGivenPlacesHaveTheSameBitsOnEveryPath) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> fraction(0, 1);
  const SteepField field(3, 1);
  std::int32_t whole[3][kBatchLanes];
  float t[3][kBatchLanes];
  for (const int count : {1, 5, 16, 90, kBatchLanes}) {
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < 3; ++k) {
        whole[k][i] = static_cast<std::int32_t>(random() % (3 * kExtent)) - kExtent;
        t[k][i] = fraction(random);
      }
    const std::int32_t* const wholes[3] = {whole[0], whole[1], whole[2]};
    const float* const fractions[3] = {t[0], t[1], t[2]};
    float plain[kBatchLanes] = {}, wide[kBatchLanes] = {};
    readKernels(Simd::Scalar).readAt(field.view(), wholes, fractions, count, plain);
    for (const Simd simd : kWider) {
      readKernels(simd).readAt(field.view(), wholes, fractions, count, wide);
      ASSERT_TRUE(sameBits(plain, wide)) << toText(availableSimd(simd)) << ", " << count;
    }
  }
}

TEST(SimdKernels, TheBestIsOneOfTheTwoWidest) {
  const Simd best = availableSimd(), widest = availableSimd(Simd::Avx512);
  EXPECT_EQ(best, availableSimd(Simd::Best));
  EXPECT_TRUE(best == widest || (best == Simd::Avx2 && widest == Simd::Avx512)) << toText(best);
  EXPECT_STREQ(toText(best), toText(availableSimd(best)));
}

}  // namespace
}  // namespace vps
