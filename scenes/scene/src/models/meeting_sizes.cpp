// SPDX-License-Identifier: BSD-3-Clause
#include "models/meeting_sizes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "text/words.h"
#include "vps/box.h"
#include "vps/mesh_distance.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kFacets =
    4096;  // assumed: greatest number of samples in a mesh; a bore needs one sampled facet
constexpr std::uint32_t kCells = 12;  // assumed: cells along each axis of the mesh
/// Greatest cosine between the normals of opposite walls, which deviate from parallel by less than 45
/// degrees. Flanks of gear teeth (2 x 20 degrees) are opposite walls; flanks of a metric thread (60 degrees)
/// are not.
constexpr double kOpposite = -0.7;
constexpr double kNearest = 1e-3;   // assumed, share of the mesh's size: facets at less distance are one wall
constexpr double kFits = 1 + 1e-3;  // factor by which a wall may exceed its gap, since both are faceted

bool isFinite(const Mesh& mesh) {
  return std::ranges::all_of(mesh.vertices, [](const Vec3& p) { return p.allFinite(); });
}

/// Measures distances between walls along normals.
class WallSearch {
 public:
  WallSearch(const Mesh& mesh, double most_m)
      : distance_(mesh), most_m_(most_m), least_m_(kNearest * bounds(mesh).size().norm()) {}

  /// Distance from p on a facet with this normal to the next facet along `way` (the normal or its opposite),
  /// if that facet is opposite.
  [[nodiscard]] std::optional<double> width(const Vec3& p, const Vec3& normal, const Vec3& way) {
    const double off_m = 0.1 * least_m_;
    const Vec3 from = p + off_m * way, to = p + most_m_ * way;
    crossings_.clear();
    distance_.appendCrossings(from, to, crossings_);
    if (crossings_.empty()) return {};
    const double width_m = off_m + std::ranges::min(crossings_) * (most_m_ - off_m);
    if (width_m < least_m_) return {};
    const MeshDistance::Closest hit = distance_.closest(p + width_m * way, least_m_);
    if (!hit.found || normal.dot(distance_.featureNormal(hit.triangle, 0)) > kOpposite) return {};
    return width_m;
  }
  [[nodiscard]] double least_m() const { return least_m_; }

 private:
  MeshDistance distance_;
  double most_m_, least_m_;
  std::vector<double> crossings_;
};

Vec3 normalTimesArea(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
}

/// A number that facets of similar place, size and direction share.
std::uint32_t kindOf(const Mesh& mesh, std::size_t t, const Box& box) {
  const Vec3 normal = normalTimesArea(mesh, t);
  const double side_m = std::max(1e-300, box.size().maxCoeff() / kCells);
  const Vec3 at = (mesh.vertices[mesh.triangles[t][0]] - box.min) / side_m;
  std::uint32_t kind = 0;
  for (const double cell : at)
    kind = kind * kCells + static_cast<std::uint32_t>(std::clamp(cell, 0.0, kCells - 1.0));
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  kind = kind * 6 + static_cast<std::uint32_t>(2 * axis + (normal[axis] > 0 ? 1 : 0));
  const double size = std::log2(std::max(1e-18, normal.norm() / (side_m * side_m))) /
                      2;  // log2 of the facet's side, in cells
  return kind * 32 + static_cast<std::uint32_t>(std::clamp(size + 30, 0.0, 31.0));
}

/// All facets of a mesh with up to kFacets facets. For a finer mesh, one facet of each kind (kindOf()),
/// beginning with the rarest kinds, so that the walls of a small bore are included.
std::vector<std::size_t> sampledFacets(const Mesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  std::vector<std::size_t> facets(count);
  std::iota(facets.begin(), facets.end(), std::size_t{0});
  if (count <= kFacets) return facets;
  const Box box = bounds(mesh);
  struct Kind {
    std::size_t first, count;
  };
  std::unordered_map<std::uint32_t, Kind> kinds;
  for (const std::size_t t : facets)
    ++kinds.try_emplace(kindOf(mesh, t, box), Kind{t, 0}).first->second.count;
  std::vector<Kind> by_count;
  for (const auto& [number, kind] : kinds) by_count.push_back(kind);
  std::ranges::sort(by_count, {}, [](const Kind& kind) { return std::pair(kind.count, kind.first); });
  facets.clear();
  for (const Kind& kind : by_count)
    if (facets.size() < kFacets) facets.push_back(kind.first);
  return facets;
}

/// Calls visit(point, normal) for the centre of each sampled facet, and in a coarse mesh for three more
/// points of the facet.
template <class Visit>
void forEachSample(const Mesh& mesh, const Visit& visit) {
  const bool is_coarse = 4 * mesh.triangles.size() <= kFacets;
  for (const std::size_t t : sampledFacets(mesh)) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Vec3 normal = normalTimesArea(mesh, t);
    if (!(normal.norm() > 0)) continue;
    const Vec3 middle = (p + q + r) / 3;
    visit(middle, Vec3(normal.normalized()));
    if (!is_coarse) continue;
    for (const Vec3* corner : {&p, &q, &r})
      visit(Vec3(middle + 0.6 * (*corner - middle)), Vec3(normal.normalized()));
  }
}

bool moves(const Scene& scene, std::size_t part) {
  if (scene.steps.empty()) return !scene.parts[part].is_fixed;
  return std::ranges::any_of(scene.steps, [part](const SceneStep& step) { return step.part == part; });
}

void keepLess(MeetingSize& size, double length_m, double most_m, const std::string& words) {
  if (!(length_m < std::min(size.least_m, most_m))) return;
  size.least_m = length_m;
  size.words = words + " of " + lengthInWords(length_m);
}

std::string quoted(const ScenePart& part) {
  return "'" + part.part.name + "'";
}

}  // namespace

double across_m(const Mesh& mesh) {
  constexpr double kFlat = 1e-6;  // share of the greatest dimension; a smaller dimension counts as zero
  const Vec3 size = bounds(mesh).size();
  double across_m = std::numeric_limits<double>::infinity();
  for (const double length_m : size)
    if (length_m > kFlat * size.maxCoeff()) across_m = std::min(across_m, length_m);
  return across_m;
}

WallSizes wallSizes(const Mesh& mesh, double most_m) {
  WallSizes sizes;
  if (mesh.triangles.empty() || !isFinite(mesh)) return sizes;
  WallSearch search(mesh, most_m);
  if (!(search.least_m() < most_m))
    return sizes;  // no distance between facets is both above least_m() and below most_m
  forEachSample(mesh, [&](const Vec3& p, const Vec3& normal) {
    pollStop();
    if (const auto gap_m = search.width(p, normal, normal)) sizes.gaps_m.push_back(*gap_m);
    if (const auto wall_m = search.width(p, normal, -normal))
      sizes.thinnest_m = std::min(sizes.thinnest_m, *wall_m);
  });
  std::ranges::sort(sizes.gaps_m);
  return sizes;
}

std::vector<MeetingSize> meetingSizes(const Scene& scene, double most_m) {
  const std::size_t count = scene.parts.size();
  std::vector<MeetingSize> sizes(count);
  std::vector<WallSizes> walls(count);
  std::vector<double> wall_m(count);
  std::vector<char> is_moved(count);
  for (std::size_t i = 0; i < count; ++i) is_moved[i] = moves(scene, i);
  const auto takesPart = [&](std::size_t i) { return is_moved[i] || scene.parts[i].is_fixed; };
  onAllCores(count, [&](std::size_t i) {
    if (!takesPart(i)) return;
    const Mesh& mesh = scene.parts[i].part.mesh;
    walls[i] = wallSizes(mesh, most_m);
    wall_m[i] = std::min(walls[i].thinnest_m, across_m(mesh));
  });
  for (std::size_t i = 0; i < count; ++i) {
    if (!takesPart(i)) continue;
    const ScenePart& part = scene.parts[i];
    if (is_moved[i] || scene.steps.empty())
      keepLess(sizes[i], across_m(part.part.mesh), most_m, quoted(part) + ", with a size");
    for (std::size_t k = 0; k < count && !walls[i].gaps_m.empty(); ++k) {
      if (k == i || !takesPart(k) || !(is_moved[i] || is_moved[k])) continue;
      const auto gap = std::ranges::lower_bound(walls[i].gaps_m, wall_m[k] / kFits);
      if (gap == walls[i].gaps_m.end()) continue;
      keepLess(sizes[i], *gap, most_m, "the gap in " + quoted(part));
      keepLess(sizes[k], wall_m[k], most_m, "the wall in " + quoted(scene.parts[k]));
    }
  }
  return sizes;
}

}  // namespace vps::scenes
