// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/scene_groups.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "vps/mesh_repair.h"
#include "vps_scenes/scene/part_mass.h"

namespace vps::scenes {

ScenePart unitedPart(const std::string& name, const std::vector<ScenePart>& parts) {
  ScenePart whole = parts.front();
  whole.part.name = name;
  whole.members.clear();
  whole.fastener.clear();
  whole.part.face_colors = {};
  double mass_kg = 0, volume_m3 = 0, largest_m2 = 0;
  for (const ScenePart& part : parts) {
    if (&part != &parts.front())
      append(whole.part.mesh, transformed(part.part.mesh, whole.X_WP.inverse() * part.X_WP));
    append(whole.part.face_colors, part.part.mesh.triangles.size(), part.part.face_colors, part.part.color);
    whole.members.push_back(part.part.name);
    const double own_m3 = std::abs(partMass(part).volume_m3);
    volume_m3 += own_m3;
    mass_kg += own_m3 * part.part.material.density_kg_m3;
    if (const double own_m2 = area(part.part.mesh); own_m2 > largest_m2) {
      largest_m2 = own_m2;
      whole.part.color = part.part.color;
    }
    whole.is_fixed = whole.is_fixed || part.is_fixed;
    whole.allow_overlap = whole.allow_overlap || part.allow_overlap;
    whole.press_fit_m = std::max(whole.press_fit_m, part.press_fit_m);
    whole.rounding_m = std::max(whole.rounding_m, part.rounding_m);
    if (part.deflection_m) whole.deflection_m = std::max(*part.deflection_m, whole.deflection_m.value_or(0));
  }
  simplify(whole.part.face_colors, whole.part.color);
  // Members that overlap fill less than the sum of their volumes, which is otherwise known to rounding.
  constexpr double kRounding = 1e-9;
  const double united_m3 = solidMass(whole.part.mesh, name).volume_m3;
  if (std::abs(united_m3 - volume_m3) > kRounding * volume_m3 && united_m3 > 0) volume_m3 = united_m3;
  if (volume_m3 > 0) whole.part.material.density_kg_m3 = mass_kg / volume_m3;
  return whole;
}

void uniteGroups(Scene& scene, const std::vector<PartGroup>& groups) {
  std::map<std::string, std::size_t> group_of;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const std::string& part : groups[g].parts) group_of[part] = g;
  std::vector<std::vector<ScenePart>> members(groups.size());
  for (ScenePart& part : scene.parts)
    if (const auto in = group_of.find(part.part.name); in != group_of.end())
      members[in->second].push_back(part);
  std::vector<ScenePart> parts;
  for (ScenePart& part : scene.parts) {
    const auto in = group_of.find(part.part.name);
    if (in == group_of.end()) {
      parts.push_back(std::move(part));
    } else if (const auto& all = members[in->second]; part.part.name == all.front().part.name) {
      parts.push_back(unitedPart(groups[in->second].name, all));
    }
  }
  scene.parts = std::move(parts);
}

}  // namespace vps::scenes
