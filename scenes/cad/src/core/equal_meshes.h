// SPDX-License-Identifier: BSD-3-Clause
// Finds meshes of equal geometry among many.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <unordered_map>

#include "vps/mesh.h"

namespace vps::scenes {

/// True for meshes with the same vertices and triangles, to the bit.
inline bool isEqualGeometry(const Mesh& a, const Mesh& b) {
  return a.vertices.size() == b.vertices.size() && a.triangles.size() == b.triangles.size() &&
         a.vertices == b.vertices && a.triangles == b.triangles;
}

/// Indices of meshes by a hash of their vertices, so that each mesh is compared with few others. Triangles
/// alone do not tell meshes apart: bolts that differ only in length have equal triangles.
class EqualMeshes {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// The first index that was added with an equal hash and for which isEqual(index) is true. If there is
  /// none, adds `index` and returns kNone. O(vertices), without the cost of isEqual().
  template <class IsEqual>
  std::size_t findOrAdd(std::size_t index, const Mesh& mesh, IsEqual isEqual) {
    const std::size_t hash = hashOf(mesh);
    const auto [first, last] = known_.equal_range(hash);
    std::size_t found = kNone;
    for (auto it = first; it != last; ++it)
      if (it->second < found && isEqual(it->second)) found = it->second;
    if (found == kNone) known_.emplace(hash, index);
    return found;
  }

 private:
  static std::size_t hashOf(const Mesh& mesh) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(mesh.vertices.data()), mesh.vertices.size() * sizeof(Vec3)});
  }
  std::unordered_multimap<std::size_t, std::size_t> known_;
};

}  // namespace vps::scenes
