// SPDX-License-Identifier: BSD-3-Clause
// Whether a part is in place within its play: how far it may move at its target along and about each axis
// before it touches a part in place, and how much of its displacement this room explains.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "judge/overlap_judge.h"
#include "vps/pose.h"

namespace vps::scenes {

/// The room of a part at its target along or about one axis, and the part's displacement along or about it.
struct AxisRoom {
  Vec3 axis_W = Vec3::UnitX();  ///< unit
  bool is_turn = false;
  double off = 0;  ///< displacement from the target [m, or rad for a turn]
  std::array<double, 2> way = {0,
                               0};  ///< room backwards and forwards, >= 0; infinite: nothing stops the part
  /// Parts in place stop the motion on both sides, so that the part is in place anywhere between the stops.
  [[nodiscard]] bool isHeld() const { return std::isfinite(way[0]) && std::isfinite(way[1]); }
  /// Nothing stops the motion, so that only sight tells where the part belongs.
  [[nodiscard]] bool isFree() const { return std::isinf(way[0]) && std::isinf(way[1]); }
};

/// A displaced part as its play sees it. The poses at which the part counts as placed are those that its
/// play allows (held axes), widened by the step's tolerance, and by kSightTolerance_m along free axes. An
/// axis with one stop has no play: the part belongs at the stop, where it is drawn.
struct PlaceInPlay {
  Vec3 center_W = Vec3::Zero();   ///< point whose displacement is measured, and about which the part turns
  std::array<AxisRoom, 6> rooms;  ///< along three axes, then about them
  /// The displacements along and about all held axes together are free up to this share of them, from the
  /// target on: 1 if the part is within its play. (Along each axis alone, a round pin has more room.)
  double free_share = 1;
  double outside_m = 0;            ///< surface error without play and without displacements along free axes
  double outside_with_free_m = 0;  ///< surface error without play
  [[nodiscard]] bool isPlaced(double tolerance_m) const;
  /// The share of a room's displacement that the play does not explain: all of it unless the axis is held.
  [[nodiscard]] double outside(const AxisRoom& room) const {
    return (room.isHeld() ? 1 - free_share : 1) * room.off;
  }
};

/// Finds the room along and about each axis for which X_WP differs from the target. Play ends where the part
/// is deeper in a part in place than limit_m, or than at its target if that is more. Axes are along_W and
/// the normal of the part's largest area across it; the largest area alone if along_W is zero. A stop counts
/// if it is within kSightTolerance_m, or within 0.2 rad for a turn; these limits keep a part that was left at
/// the far end of a long guide from counting as placed. The turns are about the middle of the region that the
/// part shares with the parts in place, where a short fit of a long part holds it, or about the centre of a
/// ball.
/// @param along_W  direction of the insertion, unit; or zero
PlaceInPlay placeInPlay(const OverlapJudge& judge, const JudgedBody& body, const Pose& X_WP_target,
                        const Vec3& along_W, const Pose& X_WP, double limit_m);

/// Whether a part that moved from one pose to the other stayed at rest but for its play: without the motion
/// along held axes, and without a turn that maps its surface to itself (a ball that rolls in a hole), no
/// point moved by more than the depth that counts as contact (10 um).
bool movedWithinPlay(const OverlapJudge& judge, const JudgedBody& body, const Pose& X_WP_target,
                     const Vec3& along_W, const Pose& X_WP_from, const Pose& X_WP_to, double limit_m);

/// "off by 250.0 um along x, where its play is -100.0 um to 100.0 um": for each axis along which the part is
/// displaced by more than 10 um, or about which it is turned by more than 1 mrad; empty if there is none.
std::string inWords(const PlaceInPlay& place);

}  // namespace vps::scenes
