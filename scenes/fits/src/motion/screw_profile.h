// SPDX-License-Identifier: BSD-3-Clause
// The facets of a screw that can never touch its nut, however far the screw is turned.
#pragma once

#include <cstdint>
#include <vector>

#include "motion/motion.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// The least radius of a nut around the axis of a screw motion, as a function of the phase z - lead turn. A
/// screw motion changes neither the radius nor the phase of a point, so a point below this profile passes the
/// nut for any number of turns.
///
///        r ^        nut
///          |  \          /      profile: the nut's lower envelope
///          |   \   /\   /
///          |    \ /  \ /        screw: its facets below it
///          +----------------> phase, 0 to the lead
class ScrewProfile {
 public:
  /// @param screw motion in the world; its lead must not be 0
  ScrewProfile(const PlacedSurface& nut, const Motion& screw);
  /// The profile of a nut that moves in the direction ahead_W only. Facets of the nut that are beyond the
  /// whole part in this direction never reach the part and are left out, such as the lid of a cap that is
  /// screwed off.
  ScrewProfile(const PlacedSurface& nut, const Motion& screw, const PlacedSurface& part, const Vec3& ahead_W);

  /// For each facet of a part at its pose: 1 if the whole flat triangle is below the profile. The profile is
  /// a lower bound and the facet's radius an upper bound, so a facet with 1 certainly passes. O(facets).
  [[nodiscard]] std::vector<std::uint8_t> passing(const PlacedSurface& part) const;

 private:
  ScrewProfile(const PlacedSurface& nut, const Motion& screw, const Vec3& ahead_W, double end_m);

  struct Facet;
  template <class Visit>
  bool forEachBin(const Facet& facet, Visit visit) const;
  template <class Visit>
  bool forEachBin(const Triangle& triangle_W, Visit visit, int halvings = 0) const;
  [[nodiscard]] Facet seen(const Triangle& triangle_W) const;

  Motion screw_;
  Vec3 x_, y_;
  double lead_m_;
  std::vector<double> least_m_;  // least radius for each bin of the phase
};

}  // namespace vps::scenes
