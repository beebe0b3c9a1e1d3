// SPDX-License-Identifier: BSD-3-Clause
#include "sound/scene_voice.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include "vps/solid.h"
#include "vps/voxmap.h"
#include "vps_scenes/scene/part_mass.h"

namespace vps::viewer {

namespace {

constexpr double kCurvature_m = 5e-3;  // radius at the place of contact. assumed: edges and rounds of a part

using IsInside = std::function<bool(const Vec3& p_P)>;

/// By the part's own map. Where it has none, or one of some regions only, by a map for this use: inside is
/// asked some million times, which takes a solid ten times as long as the map and its making. Walls that are
/// thin beside such a map's voxels are left to the solid.
IsInside insideOf(const scenes::ScenePart& part, double volume_m3) {
  constexpr double kVoxelsAcross = 250;  // about as fine as the samples of bricks, of which there are ten
  constexpr double kVoxelsInWall = 3;
  if (part.model && part.model->map && !part.is_cropped)
    return [map = part.model->map](const Vec3& p_P) { return map->isInsideCoarse(p_P); };
  const Mesh& mesh = part.part.mesh;
  const double voxel_m = bounds(mesh).size().maxCoeff() / kVoxelsAcross, wall_m = 2 * volume_m3 / area(mesh);
  if (!(wall_m > kVoxelsInWall * voxel_m))
    return [solid = std::make_shared<const Solid>(mesh, part.part.name)](const Vec3& p_P) {
      return solid->isInside(p_P);
    };
  VoxMapSettings settings;
  settings.voxel_m = voxel_m;
  return [map = buildVoxMap(mesh, settings, part.part.name)](const Vec3& p_P) {
    return map.isInsideCoarse(p_P);
  };
}

}  // namespace

double planeStrain_Pa(const scenes::ScenePart& part) {
  return 0.5 * part.youngs_modulus_Pa / (1 - part.poissons_ratio * part.poissons_ratio);
}

double strokeDuration_s(double mass_kg, double plane_strain_Pa, double speed_m_s) {
  const double v = std::max(speed_m_s, 1e-4);
  return 2.87 * std::pow(mass_kg * mass_kg / (kCurvature_m * plane_strain_Pa * plane_strain_Pa * v), 0.2);
}

double Stroke::force_N(long sample, double rate_hz) const {
  constexpr double kHalfTurn = std::numbers::pi;
  const double from = static_cast<double>(sample - start), to = std::min(from + 1, length);
  if (from >= length) return 0;
  const double share = 0.5 * (std::cos(kHalfTurn * from / length) - std::cos(kHalfTurn * to / length));
  return impulse_Ns * share * rate_hz;
}

PartVoice partVoice(const scenes::ScenePart& part, const SoundSettings& settings) {
  const Material& material = part.part.material;
  const double volume_m3 = std::max(1e-12, std::abs(scenes::partMass(part).volume_m3));
  BodyModes modes;
  if (settings.has_rings) {
    modes = findModes(part.part.mesh, insideOf(part, volume_m3), material.density_kg_m3,
                      {part.youngs_modulus_Pa, part.poissons_ratio});
  }
  return {std::move(modes), volume_m3, volume_m3 * material.density_kg_m3, settings.rate_hz,
          settings.distance_m};
}

}  // namespace vps::viewer
