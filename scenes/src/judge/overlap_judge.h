// SPDX-License-Identifier: BSD-3-Clause
// How deep one part is in others by exact distance between their triangles: the judge of the voxmaps' answer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps/mesh_distance.h"
#include "vps/part.h"

namespace vps::scenes {

/// A sharp edge of a part, in its frame.
struct FitEdge {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};

/// A part with everything the judge needs of it.
struct JudgedBody {
  std::string name;
  std::shared_ptr<const VoxMap> map;        ///< says what is surely outside; does not decide
  std::shared_ptr<const PointShell> shell;  ///< probes on faces
  std::shared_ptr<const MeshDistance> distance;
  std::shared_ptr<const std::vector<FitEdge>> edges;
};

/// With the part's sharp edges (more than 20 degrees). O(n log n).
JudgedBody makeJudgedBody(const Part& part, std::shared_ptr<const MeshDistance> distance);

struct Penetration {
  double depth_m = 0;       ///< 0 when free
  Vec3 p_W = Vec3::Zero();  ///< the deepest point found
  std::size_t against = 0;  ///< index of the mounted body
};

/// Measures along every sharp edge of both sides, halving it until no point between can be deeper than what
/// was found by kCertain_m (a signed distance changes by no more than the way along the edge), and at the
/// shell's points on faces. Surfaces that cross do so at an edge of one of them, so only what bulges by less
/// than the mesh's own facets, or between face points of a smooth body, can hide. For closed meshes.
class OverlapJudge {
 public:
  static constexpr double kCertain_m = 0.5e-6;

  /// Mounted parts do not move while they are here.
  void mount(JudgedBody body, const Pose& X_WB);
  [[nodiscard]] const std::string& name(std::size_t mounted) const { return mounted_[mounted].body.name; }

  /// Deepest point of `moving` in any mounted part and the reverse. Same input, same bits, on any number of
  /// threads. Allocates; not for the haptic path.
  [[nodiscard]] Penetration deepest(const JudgedBody& moving, const Pose& X_WP) const;

  /// The same as the fields read it at the points of both sides [m]; 0 when free. Off by a voxel at sharp
  /// edges: tells poses apart, no more. O(points visited).
  [[nodiscard]] double fieldDepth_m(const JudgedBody& moving, const Pose& X_WP) const;

 private:
  struct Mounted {
    JudgedBody body;
    Pose X_WB;
  };
  std::vector<Mounted> mounted_;
};

}  // namespace vps::scenes
