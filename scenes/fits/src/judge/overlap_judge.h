// SPDX-License-Identifier: BSD-3-Clause
// The depth of one part in other parts, by exact distance to their triangles. It checks the results of the
// voxmaps.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/part_model.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// A sharp edge of a part, in the part's frame.
struct SharpEdge {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};

/// A part as the judge uses it. The solid decides whether a point is inside; the map only proves that regions
/// are outside, and the shell gives sample points on faces. The model must have solid, map and shell.
struct JudgedBody {
  std::shared_ptr<const PartModel> model;
  std::shared_ptr<const std::vector<SharpEdge>> edges;  ///< edges at which faces meet at more than 20 degrees
  std::shared_ptr<const BoxTree> edge_tree;
  /// Vertices of curved faces, which protrude from the chords between the shell's points.
  std::shared_ptr<const std::vector<Vec3>> vertices;
  std::shared_ptr<const BoxTree> vertex_tree;
};

/// Finds the part's sharp edges and the vertices of its curved faces. O(n log n).
JudgedBody makeJudgedBody(std::shared_ptr<const PartModel> model);

/// The deepest point of one part in another.
struct Penetration {
  double depth_m = 0;       ///< 0 if no parts overlap
  Vec3 p_W = Vec3::Zero();  ///< the deepest point found
  std::size_t against = 0;  ///< index of the mounted body
};

/// Measures the depth along every sharp edge of both parts (deepestOnSegment(), to kCertain_m), at the
/// vertices of curved faces and at the shells' points on faces. Two surfaces always cross at an edge of one
/// of them. An overlap can therefore be missed only between smooth faces, where edges of less than 20 degrees
/// cross each other; its depth is at most the deviation of the facets from the curved face. For a faulty
/// mesh, Solid decides which points are inside. In the middle of a hole, where the signed distance jumps, a
/// point may be missed.
class OverlapJudge {
 public:
  /// Precision of a depth.
  static constexpr double kCertain_m = kContactDepth_m;

  /// Adds a part that does not move.
  void mount(JudgedBody body, const Pose& X_WB);
  [[nodiscard]] const std::string& name(std::size_t mounted) const {
    return mounted_[mounted].body.model->name;
  }
  struct Mounted {
    JudgedBody body;
    Pose X_WB;
  };
  [[nodiscard]] const std::vector<Mounted>& mounted() const { return mounted_; }

  /// The deepest point of `moving` in any mounted part, or of a mounted part in `moving`. The same input
  /// gives the same bits on any number of threads. Allocates memory, so the haptic loop must not call it.
  [[nodiscard]] Penetration deepest(const JudgedBody& moving, const Pose& X_WP) const;

  /// The depth by the voxmaps, at the shell points of both parts [m]; 0 if no point is inside. At sharp edges
  /// this depth can be wrong by a voxel, so it serves only to rank poses. O(points visited).
  [[nodiscard]] double fieldDepth_m(const JudgedBody& moving, const Pose& X_WP) const;

 private:
  std::vector<Mounted> mounted_;
};

}  // namespace vps::scenes
