// SPDX-License-Identifier: BSD-3-Clause
// Which facets of a screw can never touch its nut, however far it is turned.
#pragma once

#include <cstdint>
#include <vector>

#include "motion/motion.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// The least radius of a nut around the axis of a screw motion, by phase z - lead turn. A screw motion
/// changes neither the radius nor the phase of a point, so what is below this profile passes the nut for any
/// number of turns.
///
///        r ^        nut
///          |  \          /      profile: the nut's lower envelope
///          |   \   /\   /
///          |    \ /  \ /        screw: its facets below it
///          +----------------> phase, 0 to the lead
class ScrewProfile {
 public:
  /// @param screw in the world, with a lead
  ScrewProfile(const PlacedSurface& nut, const Motion& screw);
  /// For a nut that moves in this direction along the axis only: without its facets beyond all of the part in
  /// that direction, which never come to it, as the lid of a cap that is screwed off.
  ScrewProfile(const PlacedSurface& nut, const Motion& screw, const PlacedSurface& part, const Vec3& ahead_W);

  /// By facet of a part in place: 1 if all of it is below the profile, facets as flat triangles. Bounds from
  /// both sides: what is said to pass does pass. O(facets).
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
  std::vector<double> least_m_;  // by bin of phase
};

}  // namespace vps::scenes
