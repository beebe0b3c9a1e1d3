// SPDX-License-Identifier: BSD-3-Clause
// Ergonomics: the path of the part in hand against reach and joint comfort of persons who sit or stand at a
// bench.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

enum class Posture { Seated, Standing };
inline const char* toText(Posture posture) {
  return posture == Posture::Standing ? "standing" : "seated";
}

/// A person by stature. assumed: 5th percentile of women and 95th of men, 18 to 65 years [DIN 33402-2:2005].
/// Lengths of the body are shares of the stature [Drillis and Contini 1966].
struct Body {
  std::string name;
  double stature_m = 0;
  [[nodiscard]] double upperArm_m() const { return 0.186 * stature_m; }
  /// To the middle of the closed hand.
  [[nodiscard]] double forearm_m() const { return (0.146 + 0.054) * stature_m; }
  /// From the body's middle to the joint.
  [[nodiscard]] double shoulderAside_m() const { return 0.129 * stature_m; }
  [[nodiscard]] double shoulderHeight_m(Posture posture) const {
    return posture == Posture::Standing ? 0.818 * stature_m : kSeat_m + (0.818 - 0.530) * stature_m;
  }
  /// assumed: of the seat, compressed; a desk chair [EN 1335-1: 0.40 to 0.51 m] set for a bench of 0.74 m
  static constexpr double kSeat_m = 0.46;
};
VPS_SCENES_API const std::vector<Body>& assumedBodies();

/// assumed: a table at which one sits, or stands [EN 527-1:2011].
inline constexpr double kSeatedBench_m = 0.74, kStandingBench_m = 1.05;
/// assumed: from the nearest part or place of the path to the shoulders, past the bench's edge
inline constexpr double kToShoulder_m = 0.20;

/// An arm whose hand holds a point; the elbow hangs below the line from shoulder to hand.
struct ArmPose {
  double reach_share = 0;   ///< distance of the hand from the shoulder, by the arm's length
  double raised_rad = 0;    ///< upper arm, from hanging down
  double elbow_rad = 0;     ///< flexion; 0: stretched
  bool is_reached = false;  ///< false: too far, and the angles are of a stretched arm in its direction
};
/// @param p_SH  hand from the shoulder; z is up
VPS_SCENES_API ArmPose armTo(const Body& body, const Vec3& p_SH);

/// Score of upper arm and lower arm by RULA's first two steps [McAtamney and Corlett 1993], summed: 2 (best)
/// to 6. Upper arm by its angle: up to 20 degrees 1, to 45 degrees 2, to 90 degrees 3, above 4. Lower arm:
/// elbow flexed by 60 to 100 degrees 1, else 2.
VPS_SCENES_API int rulaArm(const ArmPose& arm);
inline constexpr int kBestRula = 2, kWorstRula = 6;

/// One person at one step.
struct StepErgonomics {
  std::string part, body;
  Posture posture = Posture::Seated;
  std::string hand;           ///< "left" or "right": the one that is reached for longer, or with less strain
  double greatest_reach = 0;  ///< share of the arm's length
  double out_of_reach_share = 0;  ///< of the time in hand
  double raised_rad = 0;          ///< greatest
  double elbow_least_rad = 0, elbow_most_rad = 0;
  double rula_mean = 0;  ///< over time; what is out of reach counts as kWorstRula
  int rula_worst = 0;
};

struct Ergonomics {
  std::vector<StepErgonomics> steps;  ///< persons and postures of the first step, then of the next
  Vec3 p_WB = Vec3::Zero();  ///< the front edge's side: below the shoulders' middle, at the bench's height
};

/// Of the trace of a run. The person is at the side of the least y and looks along y; up is against gravity,
/// which must be along z (else nothing is measured). The lowest point of the parts in place stands on the
/// bench, and the person's middle is at the middle of the parts. O(samples). Rows of a part at rest do not
/// count.
VPS_SCENES_API Ergonomics measureErgonomics(const Scene& scene, const std::vector<TraceRow>& trace);

}  // namespace vps::scenes
