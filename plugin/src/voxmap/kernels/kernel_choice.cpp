// SPDX-License-Identifier: BSD-3-Clause
// Chooses the kernels that this processor has, and of the two widest the faster ones.
#include "vps/simd.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <new>
#include <vector>

#include "voxmap/kernels/read_kernel.h"
#include "voxmap/voxmap_layout.h"
#include "vps/voxmap.h"

namespace vps {

extern const ReadKernels kScalarKernels;
#ifdef VPS_HAS_X86_KERNELS
extern const ReadKernels kAvx2Kernels, kAvx512Kernels;
#endif

namespace {

constexpr int kCells = 4;  // cells of the field along each axis; the outermost cells are empty

/// A plane through the middle of a small field, and sixteen leaves of points around it. The time of a read
/// depends only on the places of the nodes, not on their values.
class Workload {
 public:
  Workload() : nodes_(kBrickStride * (kCells * kCells * kCells + 2), NodeValue{0}) {
    for (int cell = 0; cell < kCells * kCells * kCells; ++cell) {
      const int at[3] = {cell / (kCells * kCells), cell / kCells % kCells, cell % kCells};
      const bool is_rim = std::any_of(at, at + 3, [](int k) { return k == 0 || k == kCells - 1; });
      bricks_[cell] = is_rim ? kOutside : kBrickStride * static_cast<std::uint32_t>(cell + 2);
      for (int i = 0; i < kBrickNodes && !is_rim; ++i)
        nodes_[bricks_[cell] + static_cast<std::uint32_t>(i)] =
            static_cast<NodeValue>(500 * (VoxMap::kBrick * at[2] + nodeAt(i).z() - kMiddle));
    }
    std::fill_n(nodes_.begin(), kBrickStride, NodeValue{kFullBand});
    view_.nodes = nodes_.data();
    view_.bricks = bricks_;
    view_.voxel_m = view_.voxels_per_m = 1;
    for (int k = 0; k < 3; ++k) {
      view_.size[k] = kCells;
      view_.half[k] = kMiddle;
    }
    for (int i = 0; i < kBatch; ++i) addBlock(i);
  }

  /// Seconds for one batch: all its leaves are read, and the touching points of every fourth leaf are added.
  double run(const ReadKernels& kernels) {
    const GridPose motion(view_, Pose());
    const std::int32_t reference[3] = {0, 0, 0};
    RowSums sums;
    const auto start = std::chrono::steady_clock::now();
    kernels.read(view_, motion, pointers_, kBatch, batch_);
    for (int i = 0; i < kBatch; i += 4) kernels.touch(motion, batch_, i, blocks_[i], reference, sums);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  static constexpr int kMiddle = VoxMap::kBrick * kCells / 2;

  /// Leaves of four by four points on tilted planes, as far from each other as in a dense shell.
  void addBlock(int i) {
    ShellBlock& block = blocks_[i];
    const double away[3] = {i % 4 - 1.5, i / 4 - 1.5, 0.1 * (i % 3)};
    for (int k = 0; k < 3; ++k) block.center[k] = kMiddle + 3 * away[k];
    block.radius_m = 3;
    block.count = kLanes;
    block.is_leaf = 1;
    for (int lane = 0; lane < kLanes; ++lane) {
      block.x[lane] = static_cast<float>(0.7 * (lane % 4) - 1);
      block.y[lane] = static_cast<float>(0.7 * (lane / 4) - 1);
      block.z[lane] = 0.3f * block.x[lane];
      block.weight[lane] = 1;
    }
    pointers_[i] = &block;
  }

  std::vector<NodeValue> nodes_;
  std::uint32_t bricks_[kCells * kCells * kCells];
  FieldView view_{VoxMap()};
  ShellBlock blocks_[kBatch];
  const ShellBlock* pointers_[kBatch];
  ReadBatch batch_;
};

/// True if `a` reads a small field at least as fast as `b`. The kernels run alternately, and the shortest
/// time of each counts, since other programs only lengthen it. Takes about 0.1 ms. For kernels that differ by
/// less than 3 % the answer may be either; the answer changes no result of a query.
bool isFaster(const ReadKernels& a, const ReadKernels& b) {
  constexpr int kRuns = 25;  // the first runs fill the caches and wake the wide vector units
  const auto work = std::make_unique<Workload>();
  double a_s = work->run(a), b_s = work->run(b);
  for (int run = 0; run < kRuns; ++run) {
    a_s = std::min(a_s, work->run(a));
    b_s = std::min(b_s, work->run(b));
  }
  return a_s <= b_s;
}

Simd widest() noexcept {
#ifdef VPS_HAS_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return Simd::Avx512;
  if (__builtin_cpu_supports("avx2")) return Simd::Avx2;
#endif
  return Simd::Scalar;
}

/// The faster of the two widest instruction sets: on some processors AVX2 reads as fast as AVX-512 or faster,
/// and all sets give the same bits. If memory is short, the wider set is taken.
Simd fastest(Simd widest_here) noexcept {
#ifdef VPS_HAS_X86_KERNELS
  try {
    if (widest_here == Simd::Avx512 && !isFaster(kAvx512Kernels, kAvx2Kernels)) return Simd::Avx2;
  } catch (const std::bad_alloc&) {
    return widest_here;
  }
#endif
  return widest_here;
}

/// The value is determined when the program starts, so that the first query does not wait. The constructor of
/// another global object that runs earlier reads zero, which is Best and leads to the scalar kernels.
const Simd kWidest = widest();
const Simd kFastest = fastest(kWidest);

}  // namespace

Simd availableSimd(Simd wanted) noexcept {
  if (wanted == Simd::Best) return kFastest;
  const Simd widest_here = kWidest;
  return wanted > widest_here ? widest_here : wanted;
}

const char* toText(Simd simd) noexcept {
  switch (simd) {
    case Simd::Best:
      return "best";
    case Simd::Scalar:
      return "scalar";
    case Simd::Avx2:
      return "AVX2";
    case Simd::Avx512:
      return "AVX-512";
  }
  return "unknown";
}

const ReadKernels& readKernels(Simd simd) noexcept {
#ifdef VPS_HAS_X86_KERNELS
  switch (availableSimd(simd)) {
    case Simd::Avx512:
      return kAvx512Kernels;
    case Simd::Avx2:
      return kAvx2Kernels;
    default:
      break;
  }
#endif
  return kScalarKernels;
}

}  // namespace vps
