// SPDX-License-Identifier: BSD-3-Clause
#include "draw/coarse_mesh.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace vps::viewer::inline v0 {
namespace {

/// Which of the six sides of a cube the normal faces.
std::uint64_t side(const std::array<float, 3>& n) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0 ? 1 : 0));
}

}  // namespace

std::vector<std::uint32_t> coarseIndices(const ShadingMesh& mesh, std::size_t wanted) {
  if (mesh.indices.size() / 3 <= wanted) return mesh.indices;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e30f), high = -low;
  for (const ShadingVertex& v : mesh.vertices) {
    const Eigen::Map<const Eigen::Vector3f> p(v.p.data());
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // The surface of a cube of n cells a side has 6 n^2 cells, and twice as many triangles between them.
  const double cells = std::clamp(std::sqrt(static_cast<double>(wanted) / 12), 4.0, 1000.0);
  const float cell = (high - low).maxCoeff() / static_cast<float>(cells);
  if (!(cell > 0)) return mesh.indices;

  std::unordered_map<std::uint64_t, std::uint32_t> first_in_cell;
  std::vector<std::uint32_t> stand_in(mesh.vertices.size());
  const auto standIn = [&](std::uint32_t i) {
    std::uint64_t key = side(mesh.vertices[i].n);
    for (int k = 0; k < 3; ++k)
      key = key << 12 | static_cast<std::uint64_t>((mesh.vertices[i].p[k] - low[k]) / cell);
    stand_in[i] = first_in_cell.try_emplace(key, i).first->second;
  };
  // Vertices on creases come first, so that sharp edges stay where they are.
  std::uint32_t last = 0;
  for (const std::uint32_t source : mesh.sources) last = std::max(last, source);
  std::vector<std::uint8_t> uses(std::size_t(last) + 1, 0);
  for (const std::uint32_t source : mesh.sources)
    uses[source] = static_cast<std::uint8_t>(std::min(2, uses[source] + 1));
  for (const bool is_creased : {true, false})
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
      if ((uses[mesh.sources[i]] > 1) == is_creased) standIn(i);
  std::vector<std::uint32_t> coarse;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = stand_in[mesh.indices[i]], b = stand_in[mesh.indices[i + 1]],
                        c = stand_in[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) coarse.insert(coarse.end(), {a, b, c});
  }
  return coarse;
}

}  // namespace vps::viewer::inline v0
