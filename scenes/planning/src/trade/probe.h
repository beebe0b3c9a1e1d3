// SPDX-License-Identifier: BSD-3-Clause
// Compares the models at given poses with the exact surfaces of the meshes.
#pragma once

#include <memory>
#include <vector>

#include "judge/overlap_judge.h"
#include "trade/surface_samples.h"
#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

/// Errors of the models of the part that a scene's first step moves, at poses near contact with the fixed
/// parts. The exact values come from the meshes alone: the depth from OverlapJudge (to half a micrometre),
/// distance and penalty wrench from surface samples that are independent of any pointshell, each at its exact
/// distance.
class Probe {
 public:
  /// Computes the exact values at every pose, which takes seconds. The models of `scene` only exclude distant
  /// samples.
  Probe(const Scene& scene, std::vector<Pose> poses, const Progress& progress);

  /// Measures the errors of the models of `scene`, the same scene at another fidelity, and times their wrench
  /// queries.
  void measure(const Scene& scene, TradeRow& row) const;

  [[nodiscard]] std::size_t poses() const { return poses_.size(); }
  [[nodiscard]] std::size_t posesInside() const;
  [[nodiscard]] double spacing_m() const { return spacing_m_; }

 private:
  /// Exact signed distance (negative: depth), and wrench on the moved part about its origin, in W.
  struct Truth {
    double distance_m = 0;
    Wrench F_W;
  };
  /// One part with its surface samples.
  struct SampledBody {
    JudgedBody body;
    Pose X_WB;  ///< pose of a fixed part
    std::vector<SurfaceSample> samples;
  };
  [[nodiscard]] Truth truthAt(const Pose& X_WP) const;

  std::size_t moving_ = 0;
  std::vector<Pose> poses_;
  std::vector<Truth> truths_;
  double spacing_m_ = 0;
  SampledBody moving_body_;
  std::vector<SampledBody> mounted_;
  OverlapJudge judge_;
};

/// Up to `count` contact poses of the run's first step, evenly spaced in time. Every second pose is displaced
/// by up to the clearance plus 20 um, so that it penetrates. Seeded: the same run gives the same poses.
std::vector<Pose> probePoses(const Scene& scene, const AssembleResult& run, std::size_t count);

}  // namespace vps::scenes
