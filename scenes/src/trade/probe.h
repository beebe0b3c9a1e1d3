// SPDX-License-Identifier: BSD-3-Clause
// What models say at fixed poses, beside what the exact surfaces say there.
#pragma once

#include <memory>
#include <vector>

#include "judge/overlap_judge.h"
#include "trade/surface_samples.h"
#include "vps_scenes/trade.h"

namespace vps::scenes {

/// The part that a scene's first step moves, at poses near contact, against all fixed parts. The truth comes
/// from the meshes alone: depth by OverlapJudge (certain to half a micrometre), distance and penalty wrench
/// by samples of the surfaces that no pointshell has a hand in, each at its exact distance.
class Probe {
 public:
  /// Works out the truth at every pose. `scene` has its models: they say what is surely far away. Takes
  /// seconds.
  Probe(const Scene& scene, std::vector<Pose> poses, const Progress& progress);

  /// Compares the models of `scene`, which is the same scene at another fidelity, and times the wrench query.
  void measure(const Scene& scene, TradeRow& row) const;

  [[nodiscard]] std::size_t poses() const { return poses_.size(); }
  [[nodiscard]] std::size_t posesInside() const;
  [[nodiscard]] double spacing_m() const { return spacing_m_; }

 private:
  /// Signed: negative is the depth. Wrench on the moving part about its origin, in W.
  struct Truth {
    double distance_m = 0;
    Wrench F_W;
  };
  /// One part as the truth sees it.
  struct Side {
    JudgedBody body;
    Pose X_WB;  ///< of a fixed part
    std::vector<SurfaceSample> samples;
  };
  [[nodiscard]] Truth truthAt(const Pose& X_WP) const;

  std::size_t moving_ = 0;
  std::vector<Pose> poses_;
  std::vector<Truth> truths_;
  double spacing_m_ = 0;
  Side held_;
  std::vector<Side> mounted_;
  OverlapJudge fit_;
};

/// Up to `count` poses of the run's first step at which it touched, evenly in time, every second one pushed
/// aside by up to its clearance and 20 um, so that it is inside. Seeded: the same run gives the same poses.
std::vector<Pose> probePoses(const Scene& scene, const AssembleResult& run, std::size_t count);

}  // namespace vps::scenes
