// SPDX-License-Identifier: BSD-3-Clause
// How far a part is from the others at the poses of a snapshot: exact, for whoever watches a run.
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
  Vec3 p_W = Vec3::Zero();  ///< in the middle between their nearest points
};

/// Two parts that push each other.
struct PartTouch {
  std::size_t a = 0, b = 0;  ///< indices into Scene::parts, a < b
  double force_N = 0;        ///< along the normals, of all contacts between them
};

class VPS_SCENES_API PartGaps {
 public:
  /// Copies the meshes. O(n log n).
  explicit PartGaps(const Scene& scene);
  ~PartGaps();
  PartGaps(const PartGaps&) = delete;
  PartGaps& operator=(const PartGaps&) = delete;

  /// To each other part of the snapshot that is nearer than most_m, the nearest first; parts that wait for
  /// their step are left out. Exact to rounding. Empty where the snapshot does not have the part.
  /// Thread-safe.
  [[nodiscard]] std::vector<PartGap> of(std::size_t part, const Snapshot& shot, double most_m) const;

  /// The contacts of the snapshot by the parts between which they are: the two whose surfaces are nearest to
  /// the contact, which itself names none, and nearer than kContactNear_m beside its depth. Ordered by a, b.
  [[nodiscard]] std::vector<PartTouch> touches(const Snapshot& shot) const;
  /// assumed: coarser than the voxmaps of parts of some millimetres are exact
  static constexpr double kContactNear_m = 100e-6;

 private:
  struct Surface;
  std::vector<std::unique_ptr<Surface>> surfaces_;
};

}  // namespace vps::scenes
