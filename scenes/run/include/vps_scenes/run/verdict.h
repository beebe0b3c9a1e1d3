// SPDX-License-Identifier: BSD-3-Clause
// The one place where a verdict is made. judge() turns the evidence about a part into a verdict and its
// reason; kVerdicts has the words, the severity and the exit status of each verdict.
#pragma once

#include <array>
#include <string>

#include "vps/pose.h"
#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

struct VerdictRow {
  Verdict verdict;
  const char* words;  ///< name in tables and reports; toText() is the name in JSON
  int severity;       ///< of several verdicts, the verdict of the greatest severity counts
  int exit_status;    ///< exit status of the program `vps`
};

/// The rows of all verdicts, in the order of the enumeration Verdict.
inline constexpr std::array<VerdictRow, 3> kVerdicts{{{Verdict::Fits, "fits", 0, 0},
                                                      {Verdict::Blocked, "blocked", 2, 1},
                                                      {Verdict::NotShown, "not shown", 1, 3}}};

constexpr const VerdictRow& rowOf(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}
constexpr int exitStatusOf(Verdict verdict) {
  return rowOf(verdict).exit_status;
}
constexpr Verdict worse(Verdict a, Verdict b) {
  return rowOf(a).severity < rowOf(b).severity ? b : a;
}
constexpr bool isGood(Verdict verdict) {
  return verdict == Verdict::Fits;
}

/// Greatest late drift of a released part that counts as being at rest: a part that settles within its
/// clearance has settled before the late drift is measured.
inline constexpr double kRestDriftLimit_m = 5e-6;

/// Evidence about a part and its place. The default values describe a part that fits. ({}: so that GCC
/// does not warn where an initializer names only some members.)
struct Evidence {
  std::string blocked{};    ///< geometric proof that the part cannot reach its target; empty: no proof
  bool is_in_place = true;  ///< the hand brought the part to its target, or took it off
  std::string failure{};    ///< why the part is not in place
  double depth_m = 0, depth_limit_m = 0;  ///< deepest penetration on the part's path, and the limit for it
  std::string deepest_against{};          ///< the other part at the deepest penetration
  double rest_drift_m = 0;  ///< greatest displacement after release; see StepResult for both drifts
  double late_drift_m = 0;
  bool moves_in_play = false;             ///< the late drift is a motion within the part's play
  double press_needed_N = 0, hand_N = 0;  ///< force of the press fit, and the greatest force of the hand
  bool is_taken_off = false;              ///< the step takes the part off
  std::string doubt{};  ///< why meshes and neighbours cannot show that the part fits; empty: no doubt

  [[nodiscard]] bool isWithinLimit() const { return depth_m <= depth_limit_m; }
  [[nodiscard]] bool isAtRest() const { return moves_in_play || late_drift_m <= kRestDriftLimit_m; }
};

struct Judgement {
  Verdict verdict = Verdict::Fits;
  std::string reason;  ///< reason of the verdict; empty when the part fits
};

/// The first rule that the evidence meets decides (verdict.cpp has the table of rules); the verdict is Fits
/// if the evidence meets no rule.
VPS_SCENES_API Judgement judge(const Evidence& evidence);

/// The verdict of a part that overlaps others as drawn, by the places that the check has found: Fits if the
/// parts can be brought to places without overlap, Blocked if it is proven for the part that there are none
/// near its drawn place, else NotShown. The reason is that of the places.
VPS_SCENES_API Judgement judgeOverlap(const CheckedPlaces& places, const std::string& part);

/// Evidence::blocked of a part that, as drawn, overlaps another one by more than the error of the meshes.
/// @param at_W  where the overlap is deepest
VPS_SCENES_API std::string overlapReason(const std::string& other, double depth_m, double error_m,
                                         const Vec3& at_W);

/// Evidence::blocked of a part that starts, or else has its target, in a cavity of another part that has no
/// opening.
VPS_SCENES_API std::string closedRoomReason(const std::string& other, bool starts_inside);

/// Remedy for a part that does not stay where it was put.
inline constexpr const char* kHoldsRemedy =
    "nothing holds it there; if a fixture or the next part will hold the part, set holds = true in its "
    "[[step]]";

}  // namespace vps::scenes
