// SPDX-License-Identifier: BSD-3-Clause
// The overlap of all pairs of bodies of a simulation, by exact distance.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "judge/motion_judge.h"
#include "vps_scenes/run/simulate.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Measures pairs with at least one movable part whose boxes overlap, at single instants and along the steps
/// between them.
class BodyOverlaps {
 public:
  /// Starts with the parts at their designed poses. A part's surface is prepared when another part comes
  /// near.
  /// @param centers_P  centres of mass, by part; empty: the middles of the parts' boxes
  /// @param scale  lengths of the scene divided by the lengths as drawn; the limit of overlap applies to
  /// lengths as drawn
  explicit BodyOverlaps(const Scene& scene, const std::vector<Vec3>& centers_P = {}, double scale = 1);
  void move(std::size_t part, const Pose& X_WP) { X_WP_[part] = X_WP; }
  /// Records the pairs that overlap by more than the limit.
  void judgeStart();
  /// Ends a step whose final poses move() has set.
  /// @param credit  see MotionJudge::addStep()
  void endStep(double time_s, double credit, const std::atomic<bool>* stop = nullptr) {
    motions_.addStep(time_s, X_WP_, credit, stop);
  }
  /// Judges all pairs at their present poses, and the steps that have ended since the last call.
  void judge(double time_s);
  [[nodiscard]] JudgedOverlap result() const;
  /// Deepest overlap of all pairs and instants, including pairs that overlapped at the start.
  [[nodiscard]] JudgedDepth deepest() const;

 private:
  using Pair = MotionJudge::Pair;
  /// Calls visit(pair, overlap) for each pair that overlaps.
  template <typename Visit>
  void forEachOverlap(Visit visit);
  [[nodiscard]] PairOverlap describe(const Pair& pair, double depth_m, const Vec3& p_W, double time_s) const;
  [[nodiscard]] PairOverlap describe(const DeepestOverlap& deepest) const;

  const Scene& scene_;
  std::vector<Box> boxes_P_;
  std::vector<Pose> X_WP_;
  MotionJudge motions_;
  JudgedOverlap judged_;
  std::map<Pair, OverlappingStart> starts_;
};

}  // namespace vps::scenes
