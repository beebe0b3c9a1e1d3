// SPDX-License-Identifier: BSD-3-Clause
// How deep one part is in others by exact distance between their triangles: the judge of the voxmaps' answer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps/mesh_distance.h"
#include "vps/part.h"
#include "vps/query.h"

namespace vps {

/// A part with everything the judge needs of it.
struct FitBody {
  std::string name;
  std::shared_ptr<const VoxMap> map;        ///< finds candidates; does not decide
  std::shared_ptr<const PointShell> shell;  ///< probes: corners, points along edges, points on faces
  std::shared_ptr<const MeshDistance> distance;
};

struct Penetration {
  double depth_m = 0;       ///< 0 when free
  Vec3 p_W = Vec3::Zero();  ///< the deepest probe
  std::size_t against = 0;  ///< index of the mounted body
};

/// Probes lie exactly on the triangles, at the shell's spacing, with all mesh corners of sharp edges among
/// them. The voxmap only picks the probes worth asking (within half a voxel); their depth is exact distance
/// to triangles.
class ExactFit {
 public:
  /// Mounted parts do not move while they are here.
  void mount(FitBody body, const Pose& X_WB);
  void clear() { mounted_.clear(); }
  [[nodiscard]] const std::string& name(std::size_t mounted) const { return mounted_[mounted].body.name; }

  /// Deepest probe of `moving` in any mounted part and the reverse. Allocates; not for the haptic path.
  /// O(candidate probes, log triangles).
  [[nodiscard]] Penetration deepest(const FitBody& moving, const Pose& X_WP) const;

 private:
  struct Mounted {
    FitBody body;
    Pose X_WB;
  };
  std::vector<Mounted> mounted_;
};

}  // namespace vps
