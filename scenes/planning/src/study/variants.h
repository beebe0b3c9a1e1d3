// SPDX-License-Identifier: BSD-3-Clause
// Variants of a scene: parts that deviate in size or placement, one step alone; and whether their parts fit.
#pragma once

#include <string>
#include <vector>

#include "surface/placed_surface.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Moves every face of one part outwards by `by_m`, or inwards if by_m is negative, and removes the part's
/// models.
void growPart(ScenePart& part, double by_m);

/// The scene with the step's part larger by `by_m` on every face. A part that stands on a seat then stands
/// higher by `by_m`, so its path and its target are moved back by `by_m`, against the last leg of the path.
Scene withGrownStep(const Scene& scene, std::size_t step, double by_m);

/// Deviation of one part from the drawing.
struct PartDeviation {
  double growth_m = 0;             ///< outward offset of every face
  double friction = 0;             ///< friction added to that of the part's material
  Vec3 move_P_m = Vec3::Zero();    ///< displacement, in its own frame
  Vec3 turn_P_rad = Vec3::Zero();  ///< rotation about its origin, in its own frame
  [[nodiscard]] bool isDisplaced() const { return !move_P_m.isZero() || !turn_P_rad.isZero(); }
  [[nodiscard]] Pose X_PE() const;
};

/// The scene with each part changed by its deviation. For a fixed part the displacement applies to its pose,
/// for a moved part to its target. Along the last leg of its path a part stops at its seat: along this leg
/// its target follows the size, displacement and tilt of the highest part in place, so that only deviations
/// across the path can block the part.
Scene withDeviations(const Scene& scene, const std::vector<PartDeviation>& deviations);

/// A scene with one step and the parts in place before it: the fixed parts, and the parts of earlier steps,
/// fixed at their targets. Parts of later steps are left out. The virtual operator aims as in the whole
/// scene.
Scene excerptOf(const Scene& scene, std::size_t step);

/// Whether a moved part can be at its target or near it, by exact distance.
struct DrawnMisfit {
  Verdict verdict = Verdict::Fits;  ///< Blocked: proven; NotShown: neither places nor a proof were found
  std::string part, other, reason;  ///< empty if the verdict is Fits
  [[nodiscard]] bool isFound() const { return verdict != Verdict::Fits; }
};

/// Finds misfits in variants of one scene. The parts of the scene are prepared once.
class DrawnFit {
 public:
  explicit DrawnFit(const Scene& scene);

  /// A misfit is an overlap, by more than its error of measurement, from which the check finds no places
  /// without overlap near the drawn ones (CheckedPlaces), or a shaft that is larger than its bore, measured
  /// on the cylinders that the meshes approximate. A shaft that is larger only because the axes are drawn
  /// apart is not shown to fit, since the meshes do not show this overlap. Overlaps that the scene allows or
  /// declares are not misfits.
  [[nodiscard]] DrawnMisfit findMisfit(const Scene& variant) const;

  /// Checks the variant; parts that equal those of the prepared scene are not prepared again.
  [[nodiscard]] CheckResult check(const Scene& variant, const CheckSettings& settings) const;

 private:
  std::vector<DrawnPart> parts_;
  std::vector<PlacedSurface> placed_;  // surfaces, which refer to parts_
};

}  // namespace vps::scenes
