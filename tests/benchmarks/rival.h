// SPDX-License-Identifier: BSD-3-Clause
// The libraries that we compare with, each used as a careful user would.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "vps/mesh.h"
#include "vps/pointshell.h"
#include "vps/wrench.h"

namespace vps::bench {

/// Stiffness of every wrench in these benchmarks [N/m^3]; the value is arbitrary.
inline constexpr double kStiffness_N_per_m3 = 1e12;

/// The answer of either side for a pose, so that both answers can be compared.
struct Answer {
  std::size_t touching = 0;
  double least_m =
      0;          ///< least signed distance of any point; +band or more if all points are beyond the band
  Wrench F_Mo_M;  ///< wrench on the shell's part, about M's origin, in M
};

/// A field of another library: OpenVDB's, made by meshToVolume.
class RivalField {
 public:
  virtual ~RivalField() = default;
  [[nodiscard]] virtual std::size_t memoryBytes() const = 0;
  /// Signed distance stored at grid node (x, y, z) times voxel_m [m].
  [[nodiscard]] virtual double node(int x, int y, int z) const = 0;
};

/// Reads all points of a shell in a field, one after the other: transform, trilinear distance, and for
/// touching points gradient, force and torque. The rival uses no hierarchy and no temporal coherence.
class RivalQuery {
 public:
  virtual ~RivalQuery() = default;
  virtual Answer step(const Pose& X_MP) = 0;
  /// Points whose distance is below level_m.
  virtual std::size_t countBelow(const Pose& X_MP, double level_m) = 0;
};

struct RivalFieldSettings {
  double voxel_m = 0;
  double band_voxels = 4;
  /// meshToVolume renormalises the distances by default, which makes them less exact and takes longer.
  bool renormalize = true;
};

std::unique_ptr<RivalField> buildOpenVdb(const Mesh& mesh, const RivalFieldSettings& settings);
/// Reads a level set that saveVdb() wrote, with the same values as the voxmap.
std::unique_ptr<RivalField> readOpenVdb(const std::string& file);
/// A query with an accessor and tools::BoxSampler for each point. With `shared` the query reads the eight
/// values once for distance and gradient; otherwise the query reads these values again for the gradient of
/// touching points.
std::unique_ptr<RivalQuery> openVdbQuery(const RivalField& field, const PointShell& shell, bool shared);
/// A query of the same field as NanoVDB, with its cached trilinear sampler; null if NanoVDB is not installed.
std::unique_ptr<RivalQuery> nanoVdbQuery(const RivalField& field, const PointShell& shell);
/// Union with a second field at a pose with OpenVDB's tools: resample, then csgUnion. The fields are not
/// changed. Returns the number of active voxels, so that nothing is optimised away.
std::size_t mergeOpenVdb(const RivalField& base, const RivalField& mounted, const Pose& X_BM);

}  // namespace vps::bench
