// SPDX-License-Identifier: BSD-3-Clause
// Queries of the models of a scene, compared with the exact surfaces of the meshes.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "judge/overlap_judge.h"
#include "trade/samples.h"
#include "vps/wrench.h"
#include "vps_scenes/planning/trade.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Stiffness of the probe's penalty contact. Its value is arbitrary, since only ratios of wrenches are
/// reported.
inline constexpr double kProbeStiffness_N_per_m3 = 1e12;

/// Contact of one part with all fixed parts, computed from the models.
struct ModelResponse {
  Wrench F_W;  ///< penalty wrench on the moving part about its origin, at kProbeStiffness_N_per_m3
  std::size_t points = 0;  ///< number of points tested, by the sides of the fidelity
};

/// Queries all fixed parts as a haptic loop would, and sums their wrenches. The argument `moving` is the
/// index of the moved part.
ModelResponse queryModels(const Scene& scene, std::size_t moving, const Pose& X_WP, bool is_exhaustive);

/// Least signed distance to any fixed part [m]; negative is depth. The distance uses the points of one or
/// both sides, as set in the scene's fidelity.
double leastDistance(const Scene& scene, std::size_t moving, const Pose& X_WP);

/// Time of one query, over the given poses; each pose is measured five times.
TickTimes timeQueries(const Scene& scene, std::size_t moving, const std::vector<Pose>& poses,
                      bool is_exhaustive);

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
/// by up to the clearance plus 20 um, so that it penetrates. The displacements are seeded: the same run gives
/// the same poses.
std::vector<Pose> probePoses(const Scene& scene, const AssembleResult& run, std::size_t count);

}  // namespace vps::scenes
