// SPDX-License-Identifier: BSD-3-Clause
// The vectorised reading of a voxmap: sixteen points of a shell at a time, or sixteen spheres.
//
// One source, read_kernel.inc, is compiled for several processors (read_kernel_*.cpp); at run time the best
// one is taken. All give the same bits: each lane does the same IEEE operations in the same order, nothing is
// fused (-ffp-contract=off), and sums over lanes have a fixed order. Only plain types in here, and no call to
// anything inline of a library: its code for a newer processor could be linked for all.
//
// Lengths are in voxels, distances in quanta, from the corner of the map's directory.
#pragma once

#include <cstdint>

#include "vps/shell_block.h"
#include "vps/simd.h"

namespace vps {

/// What the kernels need of a map. It must outlive the view.
struct FieldView {
  const std::int16_t* nodes = nullptr;
  const std::uint32_t* bricks = nullptr;  ///< of each directory cell
  const float* centers_m = nullptr;       ///< of each directory cell, see VoxLayout
  const std::uint8_t* is_far = nullptr;   ///< of each directory cell, see VoxLayout; null: not known
  std::int32_t size[3] = {0, 0, 0};       ///< of the directory, in cells
  alignas(32) double half[4] = {};        ///< the directory's middle, in voxels; and 0
  double low[3] = {0, 0, 0};              ///< the directory's corner from the map's origin, in voxels
  float box[2][3] = {};                   ///< of the surface, lowest and highest corner [voxels]
  double voxel_m = 0, quantum_m = 0;
  float voxels_per_m = 0, quantum = 0;  ///< quantum in voxels
  float band = 0;                       ///< in voxels
  bool asks_ahead = false;              ///< nodes may come from beyond the second cache: ask for them early
  float slope = 0;        ///< the field changes by no more than this, in voxels per voxel of way
  float error = 0;        ///< the field differs from the distance it stands for by no more, in voxels
  float diagonal = 0;     ///< a distance of the band and this more reads as the band
  bool is_metric = true;  ///< nodes are true distances; else only slope is known of the field

  explicit FieldView(const class VoxMap& map) noexcept;
};

/// A shell's pose, as the kernels take it.
struct Motion {
  Motion(const FieldView& field, const struct Pose& X_MP) noexcept;

  double R[9];                      ///< row by row, voxels per metre
  alignas(32) double p[4];          ///< of the shell's origin, in voxels from the directory's corner; and 0
  alignas(32) double column[3][4];  ///< R again, column by column; and 0
  float r[9];                       ///< R again, steps per metre
};

/// How many blocks are read at once: enough to hide memory's latency, few enough to stay in the first cache.
inline constexpr int kBatch = 16;
inline constexpr int kBatchLanes = kBatch * kLanes;

/// Points are placed to whole steps, which are this part of a voxel. Then a fraction of a voxel fits the half
/// of a 32-bit product, and interpolation between nodes that are the same gives just that.
inline constexpr int kStepBits = 14, kSteps = 1 << kStepBits;

/// Of a batch's lanes. A cache line more keeps arrays side by side from agreeing in the low 12 bits of their
/// addresses: processors that go by those take a store to one for a store to another (a third of a read's
/// time, in some runs and not in others).
template <typename T>
using OfLanes = T[kBatchLanes + 64 / sizeof(T)];

/// Scratch and result of a read; on the caller's stack.
struct alignas(64) ReadBatch {
  alignas(64) OfLanes<std::int32_t> x, y, z;  ///< of each lane's point, from its block's base [steps]
  OfLanes<std::uint32_t> cell;                ///< directory cell (clamped to the directory)
  OfLanes<std::uint32_t> element;             ///< the low node of the grid cell, in its brick
  /// Two neighbours along z each: of (x, y), (x, y + 1), (x + 1, y), (x + 1, y + 1).
  OfLanes<std::int32_t> pair[4];
  OfLanes<float> value;                      ///< trilinear distance [quanta]
  float least[kBatch];                       ///< over a block's lanes
  alignas(16) std::int32_t base[kBatch][4];  ///< a directory cell's corner, in voxels from the directory's
  float from[kBatch][4];                     ///< the base to the block's centre, in steps
  bool is_read[kBatch];  ///< false: all lanes lie outside, and x, pair and such hold nothing
};

/// Bounds for sixteen spheres [voxels].
struct SphereBounds {
  alignas(64) float center[kLanes];  ///< the field at the sphere's centre
  float least[kLanes];               ///< the field is not below this within the sphere
  float free[kLanes];     ///< the sphere may move so far before the field in it can come down to the cutoff
  float surface[kLanes];  ///< the distance from the sphere to the surface is not below this
};

/// Sums over the touching points of the up to sixteen leaves of a row, lane by lane: floats do for so few.
struct alignas(64) RowSums {
  float f[3][kLanes] = {};    ///< area times depth times normal [m^2 quanta]
  float tau[3][kLanes] = {};  ///< the same, crossed with the arm from the reference [m^2 quanta steps]
  float area_m2[kLanes] = {};
  float area_depth[kLanes] = {};  ///< [m^2 quanta]
  std::uint32_t count = 0;        ///< over all lanes
};

/// Sums over rows, lane by lane: the order is the same for every processor.
struct alignas(64) TouchSums {
  double f[3][kLanes] = {};    ///< area times depth times normal [m^2 quanta]
  double tau[3][kLanes] = {};  ///< the same, crossed with the arm from the reference [m^2 quanta voxels]
  double area_m2[kLanes] = {};
  double area_depth[kLanes] = {};  ///< [m^2 quanta]
  std::uint32_t count[kLanes] = {};
};

struct ReadKernels {
  /// Distances at the points (or sphere centres) of up to kBatch blocks.
  void (*read)(const FieldView&, const Motion&, const ShellBlock* const* blocks, int count, ReadBatch&);
  /// Bounds for the spheres of an inner block, for a cutoff in voxels below the band.
  void (*bound)(const FieldView&, const Motion&, const ShellBlock&, float cutoff, SphereBounds&);
  /// Adds one block of a batch that has been read. Depths are carried from the whole step where a point was
  /// placed to where it is, along the slope: steps of 15 nm (at 0.25 mm) are felt. Normals are those of the
  /// trilinear distance; lanes where it has none are left to the caller: bits of the result.
  std::uint32_t (*touch)(const Motion&, const ReadBatch&, int slot, const ShellBlock&,
                         const std::int32_t* reference, RowSums&);
  void (*addRow)(const RowSums&, TouchSums&);
  /// Distance at `count` (up to kBatchLanes) grid cells with fractions: whole voxels and fraction per lane.
  void (*readAt)(const FieldView&, const std::int32_t* const whole[3], const float* const t[3], int count,
                 float* value);
};

/// The kernels for a path, or for the best one below it that this processor has.
const ReadKernels& readKernels(Simd simd) noexcept;

}  // namespace vps
