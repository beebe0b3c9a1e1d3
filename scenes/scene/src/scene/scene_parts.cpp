// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/scene_parts.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "vps/mesh_repair.h"

namespace vps::scenes {
namespace {

using MeshKey = std::pair<std::uint64_t, std::uint64_t>;

/// A hash of 128 bits of the mesh's content.
MeshKey keyOf(const Mesh& mesh) {
  const auto bytes = [](const auto& list) { return list.size() * sizeof(list[0]); };
  const std::uint64_t vertices = XXH3_64bits(mesh.vertices.data(), bytes(mesh.vertices));
  const XXH128_hash_t all = XXH3_128bits_withSeed(mesh.triangles.data(), bytes(mesh.triangles), vertices);
  return {all.low64, all.high64 ^ vertices};
}

/// Cache of the masses of meshes that have no Solid, by content: callers request the same parts repeatedly,
/// some callers for each frame, and the repair of a mesh may take seconds.
class KnownMasses {
 public:
  MassProperties of(const Mesh& mesh, const std::string& part) {
    const MeshKey key = keyOf(mesh);
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = known_.find(key); found != known_.end()) return found->second;
    }
    const MassProperties mass = solidMass(mesh, part);
    const std::scoped_lock lock(mutex_);
    if (known_.size() >= kMost) known_.clear();
    known_.emplace(key, mass);
    return mass;
  }

 private:
  static constexpr std::size_t kMost = 10000;  // greater than the number of parts of a scene
  std::mutex mutex_;
  std::map<MeshKey, MassProperties> known_;
};

}  // namespace

MassProperties partMass(const ScenePart& part) {
  static KnownMasses known;
  // The solid of a part that is pressed in is smaller than the part.
  const bool has_own_solid = part.model && part.model->solid && !(part.press_fit_m > 0);
  return has_own_solid ? part.model->solid->mass() : known.of(part.part.mesh, part.part.name);
}

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
    std::erase_if(whole.within, [&](const std::string& assembly) {
      return std::ranges::find(part.within, assembly) == part.within.end();
    });
    if (part.deflection_m) whole.deflection_m = std::max(*part.deflection_m, whole.deflection_m.value_or(0));
  }
  simplify(whole.part.face_colors, whole.part.color);
  // Overlapping members fill less than the sum of their volumes. Without overlap both volumes agree up to
  // rounding.
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
