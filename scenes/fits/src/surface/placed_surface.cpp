// SPDX-License-Identifier: BSD-3-Clause
#include "surface/placed_surface.h"

#include <algorithm>
#include <cstdio>

#include "core/equal_meshes.h"
#include "vps/errors.h"

namespace vps::scenes {

namespace {

constexpr double kLeastPart_m = 10e-6;  // a hundred times the precision of a depth
constexpr double kGreatestPart_m = 1e3;

void requireMeasurable(const DrawnPart& part) {
  requireUsable(part.mesh, "", part.name);
  if (!part.X_WP.isFinite()) throw LoadError("", part.name, "has a pose that is not finite");
  const double size_m = bounds(part.mesh).size().maxCoeff();
  if (size_m >= kLeastPart_m && size_m <= kGreatestPart_m) return;
  char size[32];
  std::snprintf(size, sizeof size, "%.3g m", size_m);
  throw LoadError("", part.name,
                  std::string("is ").append(size).append(
                      " large; a check measures parts of 10 um to 1 km. Is the unit right?"));
}

bool isSameShape(const DrawnPart& a, const DrawnPart& b) {
  return a.chord_m == b.chord_m && isEqualGeometry(a.mesh, b.mesh);
}

}  // namespace

std::vector<PlacedSurface> placedSurfaces(const std::vector<DrawnPart>& parts, const Progress& progress,
                                          std::span<const PlacedSurface> prepared) {
  std::vector<PlacedSurface> placed(parts.size());
  std::vector<std::size_t> source(parts.size());
  std::vector<std::size_t> own;
  EqualMeshes known;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    requireMeasurable(parts[i]);
    source[i] = i;
    const auto earlier = std::ranges::find_if(
        prepared, [&](const PlacedSurface& part) { return isSameShape(*part.drawn, parts[i]); });
    if (earlier != prepared.end()) {
      placed[i].surface = earlier->surface;
      continue;
    }
    const std::size_t equal =
        known.findOrAdd(i, parts[i].mesh, [&](std::size_t k) { return isSameShape(parts[k], parts[i]); });
    if (equal == EqualMeshes::kNone)
      own.push_back(i);
    else
      source[i] = equal;
  }
  forEachOnCores(own.size(), progress, "preparing the parts", [&](std::size_t k) {
    const DrawnPart& part = parts[own[k]];
    placed[own[k]].surface = std::make_shared<const PartSurface>(
        std::make_shared<const Solid>(part.mesh, part.name), part.chord_m);
  });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    PlacedSurface& part = placed[i];
    part.name = parts[i].name;
    part.surface = placed[source[i]].surface;
    part.X_WP = parts[i].X_WP;
    part.drawn = &parts[i];
    for (const Vec3& p : part.surface->mesh().vertices) part.box_W.add(part.X_WP * p);
  }
  return placed;
}

std::vector<std::pair<std::size_t, std::size_t>> nearPairs(const std::vector<PlacedSurface>& parts,
                                                           double near_m) {
  std::vector<Box> boxes;
  for (const PlacedSurface& part : parts) boxes.push_back(part.box_W);
  const BoxTree tree(boxes);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < parts.size(); ++a) {
    const auto isNear = [&](const Box& box) { return distance2(boxes[a], box) <= near_m * near_m; };
    tree.forEach(isNear, [&](std::uint32_t b) {
      if (b > a && isNear(boxes[b])) pairs.emplace_back(a, b);
    });
  }
  std::ranges::sort(pairs);
  return pairs;
}

const PlacedSurface& named(const std::vector<PlacedSurface>& parts, const std::string& name) {
  return *std::ranges::find(parts, name, &PlacedSurface::name);
}

}  // namespace vps::scenes
