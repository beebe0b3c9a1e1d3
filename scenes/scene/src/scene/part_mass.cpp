// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/part_mass.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "vps/mesh_repair.h"

namespace vps::scenes {
namespace {

using MeshKey = std::pair<std::uint64_t, std::uint64_t>;

// 128 bits of the mesh's content.
MeshKey keyOf(const Mesh& mesh) {
  const auto bytes = [](const auto& list) { return list.size() * sizeof(list[0]); };
  const std::uint64_t vertices = XXH3_64bits(mesh.vertices.data(), bytes(mesh.vertices));
  const XXH128_hash_t all = XXH3_128bits_withSeed(mesh.triangles.data(), bytes(mesh.triangles), vertices);
  return {all.low64, all.high64 ^ vertices};
}

/// Masses of meshes that have no Solid, by content: callers ask for the same parts again, some for each frame
/// that is drawn, and a repair may take seconds.
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
  static constexpr std::size_t kMost = 10000;  // more than a scene has parts
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

}  // namespace vps::scenes
