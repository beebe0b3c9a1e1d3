// SPDX-License-Identifier: BSD-3-Clause
// Sample points on a mesh, and pseudo-random numbers that are the same on every platform.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "vps/mesh.h"
#include "vps/pose.h"

namespace vps::scenes {

struct SurfaceSample {
  Vec3 p = Vec3::Zero();
  double area_m2 = 0;  ///< area of the sample; 0 for a vertex, which is used for distances only
};

/// Samples each triangle with about one point per spacing_m^2, at least one, and adds all vertices; in the
/// mesh's frame, only points inside `box`. The points of each triangle follow the R2 sequence, which is
/// evenly distributed. Deterministic. O(points). Source: Roberts, The unreasonable effectiveness of
/// quasirandom sequences, 2018.
std::vector<SurfaceSample> sampleSurface(const Mesh& mesh, double spacing_m, const Box& box);

/// Draws uniformly from [0, 1). std::uniform_real_distribution is not used, since its numbers depend on the
/// standard library.
class SeededDraw {
 public:
  explicit SeededDraw(std::uint64_t seed) : random_(seed) {}
  double operator()() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  /// Draws a point from the cube of size 1 around the origin, coordinate z first. Each coordinate has its own
  /// statement, because the evaluation order of arguments is unspecified; the order z, y, x keeps the results
  /// of earlier versions.
  Vec3 inUnitCube() {
    const double z = (*this)() - 0.5;
    const double y = (*this)() - 0.5;
    const double x = (*this)() - 0.5;
    return {x, y, z};
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace vps::scenes
