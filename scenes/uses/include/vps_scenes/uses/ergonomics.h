// SPDX-License-Identifier: BSD-3-Clause
// Ergonomics: the path of the part in hand against reach and joint comfort of persons who sit or stand at a
// bench.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/fields.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

enum class Posture { Seated, Standing };
inline const char* toText(Posture posture) {
  return posture == Posture::Standing ? "standing" : "seated";
}

/// A person, described by stature. assumed: the 5th percentile of women and the 95th percentile of men, 18 to
/// 65 years [DIN 33402-2:2005]. Lengths of the body are fractions of the stature [Drillis and Contini 1966].
struct Body {
  std::string name;
  double stature_m = 0;
  [[nodiscard]] double upperArm_m() const { return 0.186 * stature_m; }
  /// Length from the elbow to the middle of the closed hand.
  [[nodiscard]] double forearm_m() const { return (0.146 + 0.054) * stature_m; }
  /// Distance of the shoulder joint from the body's middle plane.
  [[nodiscard]] double shoulderAside_m() const { return 0.129 * stature_m; }
  [[nodiscard]] double shoulderHeight_m(Posture posture) const {
    return posture == Posture::Standing ? 0.818 * stature_m : kSeat_m + (0.818 - 0.530) * stature_m;
  }
  /// Height of the compressed seat. assumed: a desk chair [EN 1335-1: 0.40 to 0.51 m] that is set for a bench
  /// of 0.74 m.
  static constexpr double kSeat_m = 0.46;
};
VPS_SCENES_API const std::vector<Body>& assumedBodies();

/// Heights of the bench at which a person sits or stands. assumed: tables by EN 527-1:2011.
inline constexpr double kSeatedBench_m = 0.74, kStandingBench_m = 1.05;
/// Horizontal distance of the shoulders from the nearest part or point of the hand's path; the bench's edge
/// lies between the shoulders and this nearest point. assumed
inline constexpr double kToShoulder_m = 0.20;

/// An arm whose hand holds a point; the elbow hangs below the line from shoulder to hand.
struct ArmPose {
  double reach_share = 0;  ///< distance of the hand from the shoulder, divided by the arm's length
  double raised_rad = 0;   ///< angle of the upper arm from hanging down
  double elbow_rad = 0;    ///< flexion of the elbow; 0: stretched
  /// False if the point is too far. If the point is too far, the angles are those of an arm that is stretched
  /// towards the point.
  bool is_reached = false;
};
/// @param p_SH  position of the hand relative to the shoulder; z is up
VPS_SCENES_API ArmPose armTo(const Body& body, const Vec3& p_SH);

/// Sum of the scores of upper arm and lower arm by RULA's first two steps [McAtamney and Corlett 1993]: 2
/// (best) to 6. The upper arm scores 1 up to 20 degrees, 2 up to 45 degrees, 3 up to 90 degrees and 4 above.
/// The lower arm scores 1 for an elbow flexed by 60 to 100 degrees, else 2.
VPS_SCENES_API int rulaArm(const ArmPose& arm);
inline constexpr int kBestRula = 2, kWorstRula = 6;

/// One person at one step.
struct StepErgonomics {
  std::string part, body;
  Posture posture = Posture::Seated;
  /// "left" or "right": the hand that reaches the part for a longer time than the other hand, or with less
  /// strain.
  std::string hand;
  double greatest_reach = 0;      ///< greatest distance of the hand from the shoulder / arm's length
  double out_of_reach_share = 0;  ///< share of the time in hand with the part out of the arm's reach
  double raised_rad = 0;          ///< greatest angle of the upper arm from hanging down
  double elbow_least_rad = 0, elbow_most_rad = 0;
  double rula_mean = 0;  ///< mean of rulaArm() over time; a point out of reach counts as kWorstRula
  int rula_worst = 0;
};

struct Ergonomics {
  std::vector<StepErgonomics> steps;  ///< all persons and postures for the first step, then for the next step
  Vec3 p_WB = Vec3::Zero();           ///< point below the middle of the shoulders, at the bench's height
};

/// Measures ergonomics on the trace of a run. The person is on the parts' side of the least y and looks along
/// +y. Gravity must point along -z, else the result is empty. The lowest point of the assembled parts touches
/// the bench, and the person's middle is at the middle of the parts. Rows of the trace with the part at rest
/// do not count. O(samples).
VPS_SCENES_API Ergonomics measureErgonomics(const Scene& scene, const std::vector<TraceRow>& trace);

inline constexpr auto kStepErgonomicsFields =
    std::make_tuple(field("part", &StepErgonomics::part, "part of the step"),
                    field("body", &StepErgonomics::body, "`small woman` or `large man` (assumed sizes)"),
                    field("posture", &StepErgonomics::posture, "`seated` or `standing`"),
                    field("hand", &StepErgonomics::hand, "`left` or `right`: the hand with less strain"),
                    field("greatest_reach", &StepErgonomics::greatest_reach,
                          "greatest distance of the hand from the shoulder, as a share of the arm's length"),
                    field("out_of_reach_share", &StepErgonomics::out_of_reach_share,
                          "share of the time in which the hand holds the part out of the arm's reach"),
                    field("raised_rad", &StepErgonomics::raised_rad,
                          "greatest angle between the upper arm and the vertical, 0 when the arm hangs down"),
                    field("elbow_least_rad", &StepErgonomics::elbow_least_rad,
                          "least flexion of the elbow; 0: the arm is stretched"),
                    field("elbow_most_rad", &StepErgonomics::elbow_most_rad, "greatest flexion of the elbow"),
                    field("rula_mean", &StepErgonomics::rula_mean,
                          "mean over time of RULA's score of upper and lower arm, 2 (best) to 6"),
                    field("rula_worst", &StepErgonomics::rula_worst,
                          "greatest RULA score of upper and lower arm in the step"));
static_assert(coversAllMembers<StepErgonomics>(kStepErgonomicsFields));

}  // namespace vps::scenes
