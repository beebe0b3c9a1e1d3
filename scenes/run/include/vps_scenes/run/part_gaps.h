// SPDX-License-Identifier: BSD-3-Clause
// Exact distances of a part from the other parts at the poses of a snapshot, for viewers of a run.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct PartGap {
  std::size_t other = 0;    ///< index into Scene::parts
  double distance_m = 0;    ///< least distance of the two meshes; 0 where they touch or cross
  Vec3 p_W = Vec3::Zero();  ///< midpoint between the nearest points of the two parts
};

/// Two parts that push each other.
struct PartTouch {
  std::size_t a = 0, b = 0;  ///< indices into Scene::parts, a < b
  double force_N = 0;        ///< sum of the normal forces of all contacts between a and b
};

class VPS_SCENES_API PartGaps {
 public:
  /// Copies the meshes of the scene. O(n log n).
  explicit PartGaps(const Scene& scene);
  ~PartGaps();
  PartGaps(const PartGaps&) = delete;
  PartGaps& operator=(const PartGaps&) = delete;

  /// Distances to each other part of the snapshot that is nearer than most_m, the nearest first. Parts that
  /// wait for their step are left out. The distances are exact to rounding. The result is empty if the
  /// snapshot does not have the part. Thread-safe.
  [[nodiscard]] std::vector<PartGap> of(std::size_t part, const Snapshot& shot, double most_m) const;

  /// The contacts of the snapshot, assigned to pairs of parts. A contact does not name its parts; its parts
  /// are the two whose surfaces are nearest to the contact, and within kContactNear_m plus the contact's
  /// depth. The pairs are ordered by a, then by b.
  [[nodiscard]] std::vector<PartTouch> touches(const Snapshot& shot) const;
  /// Greatest distance of a contact, apart from its depth, from the surfaces of its parts. assumed: greater
  /// than the error of the voxmaps of parts of some millimetres
  static constexpr double kContactNear_m = 100e-6;

 private:
  struct Surface;
  std::vector<std::unique_ptr<Surface>> surfaces_;
};

}  // namespace vps::scenes
