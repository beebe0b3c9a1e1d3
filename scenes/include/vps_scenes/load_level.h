// SPDX-License-Identifier: BSD-3-Clause
// What a run in real time gives up when it cannot hold its rate, in which order, and what it says of it.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "vps/fidelity.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// How a run goes, by what its scene asks. Force limits, passivity control and watchdogs are no part of it:
/// they are given up by none.
struct VPS_SCENES_API LoadLevel {
  double coarser = 1;    ///< spacing of points by the scene's, >= 1
  int rate_divisor = 1;  ///< of the physics rate
  int slower = 1;        ///< the clock's time by simulated time

  /// Physics periods of the scene's from one step to the next.
  [[nodiscard]] int periods() const noexcept { return rate_divisor * slower; }
};

/// The stated order: fewer points, then fewer steps, then slower time; each keeps what was given up before.
/// Spacing up to four times, as fidelity_choice.h goes. assumed: a quarter of the rate and of the clock's
/// time, beyond which nobody would call it the same task.
inline constexpr std::array<LoadLevel, 7> kLoadLevels = {
    {{1, 1, 1}, {2, 1, 1}, {4, 1, 1}, {4, 2, 1}, {4, 4, 1}, {4, 4, 2}, {4, 4, 4}}};

/// How many times as much a step may take of its period at the pace before: points go with the inverse square
/// of their spacing.
VPS_SCENES_API double dearerBefore(std::size_t level);

/// "points every 1 mm, physics at 500 Hz, time at 1/2".
VPS_SCENES_API std::string describe(const LoadLevel& pace, const Fidelity& fidelity);

/// One change of pace.
struct LoadLevelChange {
  double time_s = 0;     ///< simulated
  int from = 0, to = 0;  ///< indices of kLoadLevels
  std::string was, is;   ///< both in words
  std::string why;
  std::string cost;       ///< what it costs in error, or gives back
  double lost_share = 0;  ///< of the last quarter of a second, that had no step of its own
  /// How far what touches may be from the nearest point that is looked at: no contact can be deeper unseen.
  double unseen_bound_m = 0;
  /// Least distance with the new points less that with the old, where the part was; none if it was beyond the
  /// map's band.
  std::optional<double> misread_m;
  double k_N_per_m = 0;     ///< coupling stiffness from here on
  double build_wall_s = 0;  ///< from the decision to its effect, for points
  bool is_done = true;      ///< false: it could not be, and `why` says so
};

/// What a change costs: known beforehand, and measured where it was made.
VPS_SCENES_API std::string inWords(const LoadLevelChange& change);

}  // namespace vps::scenes
