// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/check/checked_step.h"

#include <algorithm>
#include <optional>

#include "narrowphase/refinement/curved_contact.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// The facet of a curved face on which the candidate's point is.
std::optional<std::uint32_t> facetOf(const Candidate& c, const SideView& side) {
  const std::uint16_t number = c.surface[c.side];
  const Surface& surface = side.shape->models().surfaces[number];
  if (surface.sheet) return {};
  const Vec3 p = (side.X_WM * surface.X_MP).inverse() * c.p_W;
  const MeshDistance::Closest closest = surface.distance->closest(p, side.shape->models().shell->spacing_m);
  if (!closest.found || !side.shape->features().isCurved(number, closest.triangle)) return {};
  return closest.triangle;
}

// Moves the candidate to a vertex if the vertex is deeper in one of the other side's solids.
bool moveTo(const Vec3& vertex_W, const SideView& other, double reach_m, Candidate& c) {
  bool is_moved = false;
  const std::vector<Surface>& surfaces = other.shape->models().surfaces;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].sheet) continue;
    const Pose X_WP = other.X_WM * surfaces[i].X_MP;
    const Vec3 p = X_WP.inverse() * vertex_W;
    const MeshDistance::Closest closest = surfaces[i].distance->closest(p, reach_m);
    const double depth_m = closest.distance_m;
    if (!closest.found || closest.normal.dot(p - closest.q) >= 0) continue;
    if (depth_m <= kSamePlace_m || depth_m <= -c.distance_m) continue;
    c.p_W = vertex_W;
    c.n_W = (c.side == 0 ? 1 : -1) / depth_m * (X_WP.R * (closest.q - p));
    c.distance_m = -depth_m;
    c.surface[1 - c.side] = static_cast<std::uint16_t>(i);
    c.plane_of = static_cast<std::uint8_t>(1 - c.side);
    is_moved = true;
  }
  return is_moved;
}

// True if a vertex of a facet is higher than the facet's middle by height_m, along the normal of the curved
// surface. On a concave face vertices are lower.
bool protrudes(const Surface& surface, std::uint32_t triangle, double height_m) {
  if (surface.sheet) return false;
  const Mesh& mesh = surface.distance->mesh();
  const auto& t = mesh.triangles[triangle];
  const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
  const Mat3 turn_per_m = surface.distance->smoothCurvature(triangle);
  return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
    const Vec3 way = mesh.vertices[v] - middle;
    return 0.5 * way.dot(turn_per_m * way) > height_m;
  });
}

bool haveSurfaces(const PairView& pair) {
  return std::all_of(pair.shape, pair.shape + 2,
                     [](const Shape* s) { return s && !s->models().surfaces.empty(); });
}

}  // namespace

bool haveFacetCorners(const PairView& pair, double contact_margin_m, std::span<const Candidate> candidates) {
  const double height_m = kFacetCornerShare * contact_margin_m;
  return haveSurfaces(pair) && std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
           const Shape& own = *pair.shape[c.side];
           if (c.isCrossing() || own.isEdgePoint(c.id)) return false;
           const Shape::PointFace face = own.faceAt(c.id);
           return own.features().isCurved(face.surface, face.triangle) &&
                  protrudes(own.models().surfaces[face.surface], face.triangle, height_m);
         });
}

void moveToFacetCorners(const PairView& pair, double contact_margin_m, std::vector<Candidate>& candidates) {
  if (!haveSurfaces(pair)) return;
  thread_local std::vector<Vec3> taken_W;
  taken_W.clear();
  for (Candidate& c : candidates) {
    const Shape& own = *pair.shape[c.side];
    if (c.isCrossing() || own.isEdgePoint(c.id)) continue;
    const SideView side = pair.side(c.side), other = pair.side(1 - c.side);
    // A vertex is no deeper than the candidate's depth plus its distance from the candidate.
    const double reach_m = std::abs(c.distance_m) + own.models().shell->spacing_m;
    if (c.distance_m > own.models().shell->spacing_m) continue;
    const std::optional<std::uint32_t> facet = facetOf(c, side);
    if (!facet) continue;
    const Surface& surface = own.models().surfaces[c.surface[c.side]];
    if (!protrudes(surface, *facet, kFacetCornerShare * contact_margin_m)) continue;
    for (const std::uint32_t v : surface.distance->mesh().triangles[*facet]) {
      const Vec3 vertex_W = side.X_WM * (surface.X_MP * surface.distance->mesh().vertices[v]);
      if (std::find(taken_W.begin(), taken_W.end(), vertex_W) != taken_W.end()) continue;
      if (moveTo(vertex_W, other, reach_m, c)) taken_W.push_back(vertex_W);
    }
  }
}

}  // namespace vps::bullet
