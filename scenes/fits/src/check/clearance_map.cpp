// SPDX-License-Identifier: BSD-3-Clause
#include "check/check_placed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "rules/asked_pairs.h"
#include "surface/placed_surface.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostParts = 24;          // assumed: more pictures than a reader looks at
constexpr std::size_t kMostVertices = 120'000;  // assumed: a map of this size takes a third of a second
constexpr double kFine = 1.0 / 100;             // longest edge divided by the part's size: about four pixels

using Edge = std::array<std::uint32_t, 2>;

/// A part near the mapped one.
struct NearPart {
  const PlacedSurface* part = nullptr;
  double contact_m =
      0;  ///< an overlap up to this depth counts as contact, see CheckedPair::isBeyondContact()
};

/// Distance of a point from a part's surface, at most most_m; negative inside the part.
double distanceFrom(const PlacedSurface& part, const Vec3& p_W, double most_m) {
  return part.surface->solid().signedDistance(part.X_WP.inverse() * p_W, most_m);
}

/// Whether a point of the triangle can be nearer to the surface of another part than near_m. Farther
/// triangles have one colour, so that dividing them would add no detail.
bool reachesAnother(const Triangle& t_W, const std::vector<NearPart>& others, double near_m) {
  Box box_W;
  for (const Vec3& p_W : t_W) box_W.add(p_W);
  const Vec3 middle_W = (t_W[0] + t_W[1] + t_W[2]) / 3;
  double radius_m = 0;
  for (const Vec3& p_W : t_W) radius_m = std::max(radius_m, (p_W - middle_W).norm());
  const double reach_m = near_m + radius_m;
  return std::ranges::any_of(others, [&](const NearPart& other) {
    return overlap(box_W, grown(other.part->box_W, near_m)) &&
           std::abs(distanceFrom(*other.part, middle_W, reach_m)) < reach_m;
  });
}

/// Halves each edge that is longer than longest_m and near another part. The mesh stays closed, because both
/// facets at an edge divide it. Returns false if no edge was halved.
bool divideOnce(Mesh& mesh, double longest_m, const std::vector<NearPart>& others, double near_m) {
  std::map<Edge, std::uint32_t> middle;
  const auto divided = [&](std::uint32_t a, std::uint32_t b) -> std::uint32_t {
    const auto [low, high] = std::minmax(a, b);
    const auto known = middle.find({low, high});
    return known == middle.end() ? a : known->second;
  };
  for (const auto& t : mesh.triangles) {
    const Triangle t_W = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    const double edge_m =
        std::max({(t_W[1] - t_W[0]).norm(), (t_W[2] - t_W[1]).norm(), (t_W[0] - t_W[2]).norm()});
    if (edge_m <= longest_m || !reachesAnother(t_W, others, near_m)) continue;
    for (std::size_t e = 0; e < 3; ++e) {
      const auto [low, high] = std::minmax(t[e], t[(e + 1) % 3]);
      const Vec3 a = mesh.vertices[low], b = mesh.vertices[high];
      if ((b - a).norm() <= longest_m || middle.contains({low, high})) continue;
      middle[{low, high}] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.emplace_back(0.5 * (a + b));
    }
  }
  if (middle.empty()) return false;
  std::vector<std::array<std::uint32_t, 3>> out;
  for (auto t : mesh.triangles) {
    std::array<std::uint32_t, 3> m{};
    std::array<bool, 3> is_divided{};
    for (std::size_t e = 0; e < 3; ++e) {
      m[e] = divided(t[e], t[(e + 1) % 3]);
      is_divided[e] = m[e] != t[e];
    }
    const auto count = std::ranges::count(is_divided, true);
    if (count == 0) {
      out.push_back(t);
    } else if (count == 3) {
      out.insert(out.end(), {{t[0], m[0], m[2]}, {t[1], m[1], m[0]}, {t[2], m[2], m[1]}, {m[0], m[1], m[2]}});
    } else {
      // Rotates the triangle so that edge 0 is divided and edge 2 is not.
      while (!is_divided[0] || is_divided[2]) {
        std::rotate(t.begin(), t.begin() + 1, t.end());
        std::rotate(m.begin(), m.begin() + 1, m.end());
        std::rotate(is_divided.begin(), is_divided.begin() + 1, is_divided.end());
      }
      if (count == 1)
        out.insert(out.end(), {{t[0], m[0], t[2]}, {m[0], t[1], t[2]}});
      else
        out.insert(out.end(), {{m[0], t[1], m[1]}, {t[0], m[0], m[1]}, {t[0], m[1], t[2]}});
    }
  }
  mesh.triangles = std::move(out);
  return true;
}

ClearanceMap mapOf(const PlacedSurface& part, const std::vector<NearPart>& others, double near_m) {
  ClearanceMap map{part.name, transformed(part.surface->mesh(), part.X_WP), {}};
  const double longest_m = kFine * part.box_W.size().norm();
  while (map.mesh_W.vertices.size() < kMostVertices && divideOnce(map.mesh_W, longest_m, others, near_m))
    pollStop();
  map.distance_m.assign(map.mesh_W.vertices.size(), near_m);
  for (std::size_t i = 0; i < map.distance_m.size(); ++i) {
    pollStop();
    const Vec3& p_W = map.mesh_W.vertices[i];
    double& least_m = map.distance_m[i];
    for (const auto& [other, contact_m] : others) {
      const Vec3 out = (other->box_W.min - p_W).cwiseMax(p_W - other->box_W.max).cwiseMax(0);
      const double apart_m = out.norm();
      if (apart_m >= std::max(least_m, 1e-300)) continue;
      // A point outside a part's box is outside the part. Within the box, the point can be inside although
      // the surface is far away.
      const double most_m = apart_m > 0 ? least_m : near_m;
      const double distance_m = distanceFrom(*other, p_W, most_m);
      // Touching faces cross each other by rounding and by their facets' error, which is no overlap.
      least_m = std::min(least_m, distance_m < 0 && distance_m >= -contact_m ? 0 : distance_m);
    }
  }
  return map;
}

}  // namespace

std::vector<ClearanceMap> clearanceMaps(const std::vector<PlacedSurface>& parts, const CheckResult& result,
                                        double near_m, const Progress& progress) {
  // The pairs are sorted: the least clearance comes first.
  std::vector<std::size_t> wanted;
  for (const CheckedPair& pair : result.pairs)
    for (const std::string& name : {pair.a, pair.b}) {
      const auto i =
          static_cast<std::size_t>(std::ranges::find(parts, name, &PlacedSurface::name) - parts.begin());
      if (wanted.size() < kMostParts && std::ranges::find(wanted, i) == wanted.end()) wanted.push_back(i);
    }
  const PairChoice choice = choiceOf(parts, result);
  auto near = nearPairs(parts, near_m);
  std::erase_if(near, [&](const auto& pair) { return !choice.has(pair.first, pair.second); });
  std::vector<ClearanceMap> maps(wanted.size());
  forEachOnCores(wanted.size(), progress, "mapping the clearance", [&](std::size_t k) {
    std::vector<NearPart> others;
    for (const auto& [a, b] : near) {
      if (a != wanted[k] && b != wanted[k]) continue;
      const auto isPair = [&](const CheckedPair& pair) {
        return (pair.a == parts[a].name && pair.b == parts[b].name) ||
               (pair.a == parts[b].name && pair.b == parts[a].name);
      };
      const auto pair = std::ranges::find_if(result.pairs, isPair);
      const double error_m = pair == result.pairs.end() ? 0 : pair->error_m;
      others.push_back({&parts[a == wanted[k] ? b : a], error_m + kContactDepth_m});
    }
    maps[k] = mapOf(parts[wanted[k]], others, near_m);
  });
  return maps;
}

}  // namespace vps::scenes
