// SPDX-License-Identifier: BSD-3-Clause
// How deep one part is in others, by exact distance between their triangles. It checks the voxmaps' results.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/part_model.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// A sharp edge of a part, in its frame.
struct SharpEdge {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};

/// A part as the judge sees it. The solid decides; the map only proves what is outside, and the shell gives
/// probes on faces. All three are needed.
struct JudgedBody {
  std::shared_ptr<const PartModel> model;
  std::shared_ptr<const std::vector<SharpEdge>> edges;  ///< where faces meet at more than 20 degrees
  std::shared_ptr<const BoxTree> edge_tree;
  /// Vertices of curved faces, which protrude from the chords between the shell's points.
  std::shared_ptr<const std::vector<Vec3>> vertices;
  std::shared_ptr<const BoxTree> vertex_tree;
};

/// Finds the part's sharp edges and the vertices of its curved faces. O(n log n).
JudgedBody makeJudgedBody(std::shared_ptr<const PartModel> model);

struct Penetration {
  double depth_m = 0;       ///< 0 when free
  Vec3 p_W = Vec3::Zero();  ///< the deepest point found
  std::size_t against = 0;  ///< index of the mounted body
};

/// Measures along every sharp edge of both parts (deepestOnSegment(), to kCertain_m), at the vertices of
/// curved faces and at the shells' points on faces. Two surfaces that cross do so at an edge of one of them.
/// So only overlaps of smooth faces can be missed where edges that meet at less than 20 degrees cross each
/// other: by at most the deviation of the facets from the curved face. What is inside of a faulty mesh is its
/// Solid's answer; in the middle of a hole, where the signed distance jumps, a point may be missed.
class OverlapJudge {
 public:
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

  /// Deepest point of `moving` in any mounted part and the reverse. Same input, same bits, on any number of
  /// threads. Allocates; not for the haptic path.
  [[nodiscard]] Penetration deepest(const JudgedBody& moving, const Pose& X_WP) const;

  /// The same by the voxmaps, at the points of both parts [m]; 0 when free. It can be wrong by a voxel at
  /// sharp edges, so it serves only to rank poses. O(points visited).
  [[nodiscard]] double fieldDepth_m(const JudgedBody& moving, const Pose& X_WP) const;

 private:
  std::vector<Mounted> mounted_;
};

}  // namespace vps::scenes
