// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/coarse_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

namespace vps::viewer {
namespace {

/// The side of a cube (0 to 5) that the normal faces.
std::uint64_t side(const std::array<float, 3>& n) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0 ? 1 : 0));
}

/// A number for each vertex, equal for equal colours. Empty for a mesh without colours.
std::vector<std::uint32_t> colorNumbers(const ShadingMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> numbers;
  numbers.reserve(mesh.colors.size());
  for (const std::array<float, 3>& color : mesh.colors)
    numbers.push_back(known.try_emplace(color, static_cast<std::uint32_t>(known.size())).first->second);
  return numbers;
}

}  // namespace

/// For each vertex, whether it lies on a crease or an open border.
const std::vector<bool>& CoarseMesh::creased() {
  if (!is_creased_.empty()) return is_creased_;
  std::uint32_t last = 0;
  for (const std::uint32_t source : mesh_.sources) last = std::max(last, source);
  std::vector<std::uint8_t> uses(std::size_t(last) + 1, 0);
  for (const std::uint32_t source : mesh_.sources)
    uses[source] = static_cast<std::uint8_t>(std::min(2, uses[source] + 1));
  std::set<std::array<float, 3>> on_edge;
  for (const ShadingEdge& edge : mesh_.sharp_edges) on_edge.insert({edge.a, edge.b});
  is_creased_.resize(mesh_.vertices.size());
  for (std::size_t i = 0; i < is_creased_.size(); ++i)
    is_creased_[i] =
        uses[mesh_.sources[i]] > 1 || (!on_edge.empty() && on_edge.contains(mesh_.vertices[i].p));
  return is_creased_;
}

std::vector<std::uint32_t> CoarseMesh::withStandIns(const std::vector<std::uint32_t>& stand_in) const {
  std::vector<std::uint32_t> coarse;
  for (std::size_t i = 0; i + 2 < mesh_.indices.size(); i += 3) {
    const std::uint32_t a = stand_in[mesh_.indices[i]], b = stand_in[mesh_.indices[i + 1]],
                        c = stand_in[mesh_.indices[i + 2]];
    if (a != b && b != c && c != a) coarse.insert(coarse.end(), {a, b, c});
  }
  return coarse;
}

std::vector<std::uint32_t> CoarseMesh::indices(std::size_t wanted) {
  if (mesh_.indices.size() / 3 <= wanted) return mesh_.indices;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e30f), high = -low;
  for (const ShadingVertex& v : mesh_.vertices) {
    const Eigen::Map<const Eigen::Vector3f> p(v.p.data());
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // The surface of a cube of n cells a side has 6 n^2 cells, and twice as many triangles between them.
  const double cells = std::clamp(std::sqrt(static_cast<double>(wanted) / 12), 4.0, 1000.0);
  const float cell = (high - low).maxCoeff() / static_cast<float>(cells);
  if (!(cell > 0)) return mesh_.indices;

  // Bits of the 64-bit key that three cell numbers and the side leave free.
  constexpr int kColorBits = 25;
  const std::vector<std::uint32_t> color_of = colorNumbers(mesh_);
  std::unordered_map<std::uint64_t, std::uint32_t> first_in_cell;
  std::vector<std::uint32_t> stand_in(mesh_.vertices.size());
  const auto standIn = [&](std::uint32_t i) {
    std::uint64_t key = side(mesh_.vertices[i].n);
    if (!color_of.empty()) key |= std::uint64_t{color_of[i] & ((1U << kColorBits) - 1)} << 3;
    for (int k = 0; k < 3; ++k)
      key = key << 12 | static_cast<std::uint64_t>((mesh_.vertices[i].p[k] - low[k]) / cell);
    stand_in[i] = first_in_cell.try_emplace(key, i).first->second;
  };
  // Vertices on creases come first, so that they represent their cells and sharp edges do not move.
  const std::vector<bool>& is_creased = creased();
  for (const bool wanted_now : {true, false})
    for (std::uint32_t i = 0; i < mesh_.vertices.size(); ++i)
      if (is_creased[i] == wanted_now) standIn(i);
  return withStandIns(stand_in);
}

std::vector<std::uint32_t> CoarseMesh::smoothedIndices(double cell) {
  constexpr float kNormalBins = 12;  // bins per unit of a normal's coordinate: about 5 degrees each
  const std::vector<bool>& is_creased = creased();
  struct Key {
    std::array<std::int32_t, 7> at;
    bool operator==(const Key&) const = default;
  };
  const auto hash = [](const Key& key) {
    std::size_t h = 0;
    for (const std::int32_t x : key.at) h = (h ^ static_cast<std::uint32_t>(x)) * 0x9E3779B97F4A7C15ull;
    return h ^ h >> 29;
  };
  const std::vector<std::uint32_t> color_of = colorNumbers(mesh_);
  std::unordered_map<Key, std::uint32_t, decltype(hash)> first(mesh_.vertices.size(), hash);
  std::vector<std::uint32_t> stand_in(mesh_.vertices.size());
  for (std::uint32_t i = 0; i < mesh_.vertices.size(); ++i) {
    stand_in[i] = i;
    if (is_creased[i]) continue;
    Key key{};
    if (!color_of.empty()) key.at[6] = static_cast<std::int32_t>(color_of[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      key.at[k] = static_cast<std::int32_t>(std::floor(static_cast<double>(mesh_.vertices[i].p[k]) / cell));
      key.at[3 + k] = static_cast<std::int32_t>(std::floor(kNormalBins * mesh_.vertices[i].n[k] + 0.5f));
    }
    stand_in[i] = first.try_emplace(key, i).first->second;
  }
  return withStandIns(stand_in);
}

}  // namespace vps::viewer
