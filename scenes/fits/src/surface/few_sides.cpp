// SPDX-License-Identifier: BSD-3-Clause
#include "surface/few_sides.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <set>
#include <vector>

#include "vps_scenes/scene/number_words.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kFewest = 7, kMost = 24;
constexpr double kOneSide_rad = 1e-4;  // facets that meet at a smaller angle belong to one flat side
constexpr double kOnCircle = 2.5e-4;   // deviation of a corner from the circle, divided by its radius

double turnBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The flat sides around an axis that one facet belongs to.
struct Ring {
  std::vector<std::uint32_t> facets;
  std::vector<Vec3> normals, corners;  ///< one normal for each side; the ends of the edges between sides
};

class SideFinder {
 public:
  explicit SideFinder(const PartSurface& surface)
      : surface_(surface), is_seen_(surface.mesh().triangles.size()) {}

  /// The whole rings of sides that meet at kCurved_rad or more, so that they are no face of round().
  std::vector<Ring> prisms() {
    std::vector<Ring> out;
    for (std::uint32_t i = 0; i < is_seen_.size(); ++i) {
      if (is_seen_[i]) continue;
      for (std::size_t e = 0; e < 3 && !is_seen_[i]; ++e) {
        const std::uint32_t k = surface_.neighbours()[i][e];
        if (k == kNoFacet || is_seen_[k] || !isBend(turnBetween(surface_.normal(i), surface_.normal(k))))
          continue;
        Ring ring = around(i, surface_.normal(i).cross(surface_.normal(k)).normalized());
        for (const std::uint32_t facet : ring.facets) is_seen_[facet] = true;
        if (isWhole(ring)) out.push_back(std::move(ring));
      }
    }
    return out;
  }

 private:
  static bool isBend(double turn_rad) {
    return turn_rad >= kCurved_rad && turn_rad <= 2 * std::numbers::pi / (kFewest - 0.5);
  }

  /// All sides that bends along the axis, and flat edges, connect with a facet.
  Ring around(std::uint32_t first, const Vec3& axis) const {
    constexpr double kAlong = 1e-3;
    Ring ring;
    ring.facets = {first};
    std::set<std::uint32_t> known{first};
    for (std::size_t next = 0; next < ring.facets.size(); ++next) {
      const std::uint32_t i = ring.facets[next];
      const Vec3 n = surface_.normal(i);
      if (std::ranges::none_of(ring.normals,
                               [&](const Vec3& other) { return turnBetween(n, other) < kOneSide_rad; }))
        ring.normals.push_back(n);
      if (ring.normals.size() > kMost) return ring;
      const Triangle t = surface_.triangle(i);
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t k = surface_.neighbours()[i][e];
        if (k == kNoFacet || std::abs(surface_.normal(k).dot(axis)) > kAlong) continue;
        const double turn_rad = turnBetween(n, surface_.normal(k));
        if (turn_rad >= kOneSide_rad && !isBend(turn_rad)) continue;
        if (turn_rad >= kOneSide_rad) ring.corners.insert(ring.corners.end(), {t[e], t[(e + 1) % 3]});
        if (known.insert(k).second) ring.facets.push_back(k);
      }
    }
    return ring;
  }

  /// Whether the sides go all around: sorted by angle, each normal is one bend away from the next one.
  static bool isWhole(const Ring& ring) {
    if (ring.normals.size() < kFewest || ring.normals.size() > kMost) return false;
    const Vec3 u = ring.normals[0], v = u.cross(ring.normals[1]).cross(u).normalized();
    std::vector<double> angles;
    for (const Vec3& n : ring.normals) angles.push_back(std::atan2(v.dot(n), u.dot(n)));
    std::ranges::sort(angles);
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const bool is_last = k + 1 == angles.size();
      if (!isBend(is_last ? angles[0] + 2 * std::numbers::pi - angles[k] : angles[k + 1] - angles[k]))
        return false;
    }
    return true;
  }

  const PartSurface& surface_;
  std::vector<bool> is_seen_;
};

/// Radius of the circle on which all corners of a prism lie; empty if they lie on none.
std::optional<double> circleOf(const Ring& ring) {
  const Vec3 axis = ring.normals[0].cross(ring.normals[1]).normalized();
  Cylinder on{axis, Vec3::Zero(), 0};
  for (const Vec3& x : ring.corners) on.p += x / static_cast<double>(ring.corners.size());
  for (const Vec3& x : ring.corners)
    on.radius_m += on.outward(x).norm() / static_cast<double>(ring.corners.size());
  if (!fitCylinder(ring.corners, on)) return std::nullopt;
  const bool is_circle = std::ranges::all_of(
      ring.corners, [&](const Vec3& x) { return std::abs(on.off(x)) < kOnCircle * on.radius_m; });
  return is_circle ? std::optional(on.radius_m) : std::nullopt;
}

/// Whether a cylindrical face covers its whole turn, apart from the loss of area by its flat sides.
bool isAllAround(const PartSurface& surface, const RoundFace& face) {
  constexpr double kWhole = 0.95;
  double area_m2 = 0;
  for (const std::uint32_t i : face.facets) {
    const Triangle t = surface.triangle(i);
    area_m2 += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
  }
  return area_m2 > kWhole * 2 * std::numbers::pi * face.radius_m * (face.to_m - face.from_m);
}

}  // namespace

std::string fewSidesWords(const PartSurface& surface) {
  std::vector<std::string> found;
  const auto add = [&](std::size_t sides, double radius_m, const char* as) {
    const std::string words = "a face of " + std::to_string(sides) +
                              " flat sides, whose corners lie on a circle of " +
                              lengthInWords(2 * radius_m, 2) + ", is read as a " + as;
    if (std::ranges::find(found, words) == found.end()) found.push_back(words);
  };
  SideFinder finder(surface);
  for (const Ring& prism : finder.prisms())
    if (const std::optional<double> radius_m = circleOf(prism))
      add(prism.normals.size(), *radius_m, "prism (16 sides and more: as a cylinder)");
  for (const RoundFace& face : surface.round()) {
    std::vector<Vec3> normals;
    for (const std::uint32_t i : face.facets) {
      const Vec3 n = surface.normal(i);
      if (normals.size() <= kMost && std::ranges::none_of(normals, [&](const Vec3& other) {
            return turnBetween(n, other) < kOneSide_rad;
          }))
        normals.push_back(n);
    }
    if (normals.size() > kMost || !isAllAround(surface, face)) continue;
    add(normals.size(), face.radius_m, "cylinder (15 sides and fewer: as a prism)");
  }
  constexpr std::size_t kNamed = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(kNamed, found.size()); ++i) out += (i == 0 ? "" : "; ") + found[i];
  return found.size() > kNamed ? out + "; and " + std::to_string(found.size() - kNamed) + " more" : out;
}

}  // namespace vps::scenes
