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

/// Measures pairs of which one part can move and whose boxes overlap: at single instants, and along the steps
/// between them.
class BodyOverlaps {
 public:
  /// Takes the parts at their designed poses. A part's surface is prepared when another one comes near.
  /// @param centers_P  centres of mass, by part; empty: the middles of the parts' boxes
  /// @param scale  lengths of the scene, by those of the person who asks: the limit is one in the latter
  explicit BodyOverlaps(const Scene& scene, const std::vector<Vec3>& centers_P = {}, double scale = 1);
  void move(std::size_t part, const Pose& X_WP) { X_WP_[part] = X_WP; }
  /// Records the pairs that overlap by more than the limit.
  void judgeStart();
  /// The parts are where a step has brought them.
  /// @param credit  see MotionJudge::addStep()
  void endStep(double time_s, double credit, const std::atomic<bool>* stop = nullptr) {
    motions_.addStep(time_s, X_WP_, credit, stop);
  }
  /// Judges all pairs where they are, and the steps that have ended since the last time.
  void judge(double time_s);
  [[nodiscard]] JudgedOverlap result() const;
  /// Of all pairs and instants, also of those that overlapped at the start.
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
