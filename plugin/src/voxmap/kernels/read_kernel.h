// SPDX-License-Identifier: BSD-3-Clause
// Vectorised reading of a voxmap: sixteen points of a shell at a time, or sixteen spheres.
//
// One source, read_kernel.inc, is compiled for several processors (read_kernel_*.cpp); the best version is
// chosen at run time. All versions give the same bits: each lane does the same IEEE operations in the same
// order, nothing is fused (-ffp-contract=off), and sums over lanes have a fixed order. This header uses only
// plain types and calls no inline library function, since the linker might keep the copy that was compiled
// for a newer processor.
//
// Lengths are in voxels, distances in quanta, from the corner of the map's directory.
#pragma once

#include <cstdint>

#include "vps/simd.h"

namespace vps {

/// The data of a map that kernels read. The map must outlive the view.
struct FieldView {
  const std::int16_t* nodes = nullptr;
  const std::uint32_t* bricks = nullptr;    ///< of each directory cell
  const float* centers_m = nullptr;         ///< of each directory cell, see VoxLayout
  const std::uint8_t* far_cells = nullptr;  ///< of each directory cell, see VoxLayout; may be null
  std::int32_t size[3] = {0, 0, 0};         ///< size of the directory, in cells
  alignas(32) double half[4] = {};          ///< the directory's middle, in voxels; and 0
  double low[3] = {0, 0, 0};                ///< the directory's corner from the map's origin, in voxels
  float box[2][3] = {};                     ///< of the surface, lowest and highest corner [voxels]
  double voxel_m = 0, quantum_m = 0;
  float voxels_per_m = 0, quantum = 0;  ///< quantum in voxels
  float band = 0;                       ///< in voxels
  bool prefetches = false;              ///< the nodes may not be in the L2 cache: prefetch them
  float slope = 0;                      ///< the field changes by at most this [voxels per voxel]
  float error = 0;        ///< greatest difference between the field and the distance it approximates [voxels]
  float diagonal = 0;     ///< where the distance is at least band + diagonal, the field reads as the band
  bool is_metric = true;  ///< nodes are true distances; otherwise only slope bounds the field

  explicit FieldView(const class VoxMap& map) noexcept;
};

/// A shell's pose in the form that the kernels use.
struct GridPose {
  GridPose(const FieldView& field, const struct Pose& X_MP) noexcept;

  double R[9];                      ///< row by row, voxels per metre
  alignas(32) double p[4];          ///< the shell's origin, in voxels from the directory's corner; and 0
  alignas(32) double column[3][4];  ///< R column by column; and 0
  float r[9];                       ///< R row by row, in steps per metre
};

/// Number of blocks read at once: enough to hide the latency of memory, and few enough for the L1 cache.
inline constexpr int kBatch = 16;
inline constexpr int kBatchLanes = kBatch * kLanes;

/// Positions are rounded to whole steps of 1 / kSteps voxel. A fraction of a voxel then fits half of a 32-bit
/// product, and interpolation between equal nodes gives exactly their value.
inline constexpr int kStepBits = 14, kSteps = 1 << kStepBits;

/// One entry per lane of a batch. The extra cache line makes the low 12 bits of the addresses of neighbouring
/// arrays differ. With equal bits some processors mistake a store to one array for a store to another, which
/// in some runs cost a third of a read's time.
template <typename T>
using OfLanes = T[kBatchLanes + 64 / sizeof(T)];

/// Scratch memory and result of a read; on the caller's stack.
struct alignas(64) ReadBatch {
  alignas(64) OfLanes<std::int32_t> x, y, z;  ///< of each lane's point, from its block's base [steps]
  OfLanes<std::uint32_t> cell;                ///< directory cell (clamped to the directory)
  OfLanes<std::uint32_t> element;             ///< the low node of the grid cell, as an index in its brick
  /// Two neighbours along z, at each of (x, y), (x, y + 1), (x + 1, y), (x + 1, y + 1).
  OfLanes<std::int32_t> pair[4];
  OfLanes<float> value;                      ///< trilinear distance [quanta]
  float least[kBatch];                       ///< least value of a block's lanes
  alignas(16) std::int32_t base[kBatch][4];  ///< a directory cell's corner, in voxels from the directory's
  float from[kBatch][4];                     ///< the vector from the base to the block's centre, in steps
  bool is_read[kBatch];                      ///< false: all lanes are outside, and x, pair etc. are not set
};

/// Bounds for sixteen spheres [voxels].
struct SphereBounds {
  alignas(64) float center[kLanes];  ///< the field at the sphere's centre
  float least[kLanes];               ///< lower bound of the field within the sphere
  float free[kLanes];     ///< the sphere may move this far before the field in it can reach the cutoff
  float surface[kLanes];  ///< lower bound of the distance from the sphere to the surface
};

/// Sums over the touching points of up to sixteen leaves (a row), per lane. Floats are accurate enough for so
/// few points.
struct alignas(64) RowSums {
  float f[3][kLanes] = {};    ///< area times depth times normal [m^2 quanta]
  float tau[3][kLanes] = {};  ///< that force crossed with the arm from the reference [m^2 quanta steps]
  float area_m2[kLanes] = {};
  float area_depth[kLanes] = {};  ///< [m^2 quanta]
  std::uint32_t count = 0;        ///< sum over all lanes
};

/// Sums over rows, per lane. The order of summation is the same on every processor.
struct alignas(64) TouchSums {
  double f[3][kLanes] = {};    ///< area times depth times normal [m^2 quanta]
  double tau[3][kLanes] = {};  ///< that force crossed with the arm from the reference [m^2 quanta voxels]
  double area_m2[kLanes] = {};
  double area_depth[kLanes] = {};  ///< [m^2 quanta]
  std::uint32_t count[kLanes] = {};
};

struct ReadKernels {
  /// Distances at the points (or sphere centres) of up to kBatch blocks.
  void (*read)(const FieldView&, const GridPose&, const ShellBlock* const* blocks, int count, ReadBatch&);
  /// Bounds for the spheres of an inner block, for a cutoff in voxels below the band.
  void (*bound)(const FieldView&, const GridPose&, const ShellBlock&, float cutoff, SphereBounds&);
  /// Adds the touching points of one block of a batch that has been read. Each point was rounded to a step,
  /// so its depth is extrapolated along the slope to its exact position; otherwise a stiff contact would show
  /// steps of 15 nm (at 0.25 mm voxels). Normals are the gradients of the trilinear distance. Returns the
  /// lanes without a normal as bits; the caller adds these.
  std::uint32_t (*touch)(const GridPose&, const ReadBatch&, int slot, const ShellBlock&,
                         const std::int32_t* reference, RowSums&);
  void (*addRow)(const RowSums&, TouchSums&);
  /// Distances at `count` (up to kBatchLanes) points, given per lane as whole voxels and fractions.
  void (*readAt)(const FieldView&, const std::int32_t* const whole[3], const float* const t[3], int count,
                 float* value);
};

/// The kernels for an instruction set, or for the best narrower one that this processor has.
const ReadKernels& readKernels(Simd simd) noexcept;

}  // namespace vps
