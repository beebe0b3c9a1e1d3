// SPDX-License-Identifier: BSD-3-Clause
// Where the parts of a CAD file or a scene belong.
#include "vps_scenes/fits/check.h"

namespace vps::scenes {

std::vector<DrawnPart> drawnParts(const ImportedCad& cad) {
  std::vector<DrawnPart> parts;
  for (const ImportedPart& part : cad.parts)
    parts.push_back({.name = part.name,
                     .mesh = part.mesh,
                     .X_WP = part.X_WP,
                     .chord_m = part.deflection_m,
                     .rounding_m = part.rounding_m});
  return parts;
}

std::vector<DrawnPart> drawnParts(const Scene& scene) {
  std::vector<DrawnPart> parts;
  for (const ScenePart& part : scene.parts)
    parts.push_back({part.part.name, part.part.mesh, part.X_WP, part.deflection_m, part.allow_overlap,
                     part.press_fit_m, part.youngs_modulus_Pa, part.poissons_ratio,
                     part.part.material.friction, part.rounding_m, part.is_fixed});
  for (const SceneStep& step : scene.steps) parts[step.part].X_WP = placeOf(step);
  return parts;
}

}  // namespace vps::scenes
