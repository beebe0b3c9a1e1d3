// SPDX-License-Identifier: BSD-3-Clause
#include "surface/part_surface.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

/// Angle below which facets are coplanar. Rounding bends a flat face at its diagonal by about 1e-8; facets of
/// curved faces meet at more than 1e-3.
constexpr double kFlat_rad = 1e-6;
constexpr double kPartSurfaceParallel = 1e-12;  // greatest 1 - cosine of parallel normals

double angleBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Distance of a triangle's corner from the line through the opposite edge.
double heightAcross(const Triangle& t, int edge) {
  const Vec3 along = t[(edge + 1) % 3] - t[edge];
  return along.cross(t[(edge + 2) % 3] - t[edge]).norm() / std::max(along.norm(), 1e-300);
}

int edgeTowards(const std::array<std::uint32_t, 3>& neighbours, std::uint32_t other) {
  return static_cast<int>(std::find(neighbours.begin(), neighbours.end(), other) - neighbours.begin());
}

}  // namespace

PartSurface::PartSurface(std::shared_ptr<const Solid> solid, std::optional<double> chord_m)
    : overlap_(std::move(solid)),
      tree_(triangleBoxes(overlap_.mesh()), 2),
      neighbours_(neighboursOf(overlap_.mesh())),
      most_chord_m_(chord_m) {
  estimateChords();
  round_ = roundFaces(*this);
  measureRoundChords();
  for (std::uint32_t i = 0; i < chord_m_.size(); ++i)
    most_bound_m_ = std::max(most_bound_m_, chordBound_m(i));
  cracks_ = cracksOf(mesh(), neighbours_, tree_);
  findPlanes();
  findPatches();
  gatherNormals();
  tellInside();
  is_balanced_ = isBalanced(mesh());
}

// A plate must be thicker than 1 um, since a depth in a plate of thickness t is at most t / 2.
void PartSurface::tellInside() {
  constexpr double kThinnest_m = 10 * kOverlapCertain_m;
  const std::size_t sheets = solid().report().sheet_facets;
  const double thickness_m = 2 * massProperties(mesh()).volume_m3 / area(mesh());
  if (sheets > 0)
    no_inside_ = std::to_string(sheets)
                     .append(" of ")
                     .append(std::to_string(mesh().triangles.size()))
                     .append(" facets belong to surfaces without an inside");
  else if (!(thickness_m > kThinnest_m))
    no_inside_ = "the part is thinner than 1 um";
}

void PartSurface::gatherNormals() {
  std::vector<std::vector<std::uint32_t>> facets(mesh().vertices.size());
  for (std::uint32_t i = 0; i < mesh().triangles.size(); ++i)
    for (const std::uint32_t v : mesh().triangles[i]) facets[v].push_back(i);
  StridedPoll poll;
  for (const std::vector<std::uint32_t>& of_vertex : facets) {
    poll();
    const std::size_t first = around_.size();
    first_around_.push_back(static_cast<std::uint32_t>(first));
    for (const std::uint32_t i : of_vertex) {
      const Vec3 n = normal(i);
      const bool is_known =
          std::any_of(around_.begin() + static_cast<std::ptrdiff_t>(first), around_.end(),
                      [&](const Vec3& other) { return other.dot(n) > 1 - kPartSurfaceParallel; });
      if (!is_known) around_.push_back(n);
    }
  }
  first_around_.push_back(static_cast<std::uint32_t>(around_.size()));
}

void PartSurface::findPlanes() {
  planes_.resize(tree_.nodes().size());
  StridedPoll poll;
  for (std::size_t node = 0; node < planes_.size(); ++node) {
    poll();
    const std::uint32_t first = tree_.nodes()[node].first, end = tree_.nodes()[node].end;
    const auto facets = std::span(tree_.order()).subspan(first, end - first);
    const Vec3 n = normal(facets[0]);
    if (!std::ranges::all_of(facets,
                             [&](std::uint32_t i) { return normal(i).dot(n) > 1 - kPartSurfaceParallel; }))
      continue;
    NodePlane& plane = planes_[node];
    plane = {n, -1e300};
    for (const std::uint32_t i : facets)
      for (const Vec3& p : triangle(i)) plane.highest_m = std::max(plane.highest_m, n.dot(p));
  }
}

void PartSurface::findPatches() {
  // Least |sum of vector areas| / area of a patch, about 25 degrees on average; assumed.
  constexpr double kOneWay = 0.9;
  patches_.assign(tree_.nodes().size(), Vec3::Zero());
  for (std::size_t node = 0; node < patches_.size(); ++node) {
    const auto [first, end] = std::pair(tree_.nodes()[node].first, tree_.nodes()[node].end);
    if (end - first > kFacetsOfPatch) continue;
    Vec3 sum_m2 = Vec3::Zero();
    double total_m2 = 0;
    for (std::uint32_t i = first; i < end; ++i) {
      const Triangle t = triangle(tree_.order()[i]);
      const double area_m2 = (t[1] - t[0]).cross(t[2] - t[0]).norm();
      sum_m2 += area_m2 * normal(tree_.order()[i]);
      total_m2 += area_m2;
    }
    if (sum_m2.norm() > kOneWay * total_m2) patches_[node] = sum_m2.normalized();
  }
}

double PartSurface::highest_m(std::uint32_t node, const Vec3& n) const {
  double highest_m = -1e300;
  for (std::uint32_t i = tree_.nodes()[node].first; i < tree_.nodes()[node].end; ++i)
    for (const std::uint32_t v : mesh().triangles[tree_.order()[i]])
      highest_m = std::max(highest_m, n.dot(mesh().vertices[v]));
  return highest_m;
}

Triangle PartSurface::triangle(std::uint32_t i) const {
  const auto& t = mesh().triangles[i];
  return {mesh().vertices[t[0]], mesh().vertices[t[1]], mesh().vertices[t[2]]};
}

// Estimates chord errors. If a strip of width w across a curve meets its neighbours at the angle theta, the
// radius is w / theta, and the middle of the strip is w theta / 8 inside the curve through its edges. A
// triangle of a ball has three edges to curved neighbours, and their sum exceeds the triangle's depth below
// the ball. A flat face next to a curved one is wider, so the smaller of both widths counts. A bevel of less
// than kCurved_rad is taken for a curve, and the estimate is then too large.
void PartSurface::estimateChords() {
  chord_m_.assign(mesh().triangles.size(), 0);
  StridedPoll poll;
  for (std::uint32_t i = 0; i < chord_m_.size(); ++i)
    for (int e = 0; e < 3; ++e) {
      poll();
      const std::uint32_t other = neighbours_[i][e];
      if (other == kNoFacet) continue;
      const double turn_rad = angleBetween(normal(i), normal(other));
      if (turn_rad < kFlat_rad || turn_rad > kCurved_rad) continue;
      const double width_m = std::min(heightAcross(triangle(i), e),
                                      heightAcross(triangle(other), edgeTowards(neighbours_[other], i)));
      chord_m_[i] += width_m * turn_rad / 8;
    }
  if (most_chord_m_)
    for (double& chord_m : chord_m_) chord_m = std::min(chord_m, *most_chord_m_);
}

// The fitted cylinder tells how far a facet is inside it, however its neighbours are divided.
void PartSurface::measureRoundChords() {
  is_round_.assign(mesh().triangles.size(), false);
  for (const RoundFace& face : round_) {
    const Vec3 u = face.axis.unitOrthogonal(), v = face.axis.cross(u);
    for (const std::uint32_t i : face.facets) {
      std::array<Eigen::Vector2d, 3> across;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 r = triangle(i)[k] - face.p;
        across[k] = {u.dot(r), v.dot(r)};
      }
      const double chord_m = face.residual_m + std::max(0.0, face.radius_m - distanceOfOrigin(across));
      chord_m_[i] = most_chord_m_ ? std::min(chord_m, *most_chord_m_) : chord_m;
      is_round_[i] = true;
    }
  }
}

// A strip of width w covers at most twice the angle theta to its neighbour, which may be much narrower. The
// strip is therefore at most w theta / 4 inside the curve.
double PartSurface::chordBound_m(std::uint32_t i) const {
  if (chord_m_[i] == 0) return 0;
  if (is_round_[i]) return chord_m_[i];
  if (most_chord_m_) return *most_chord_m_;
  double bound_m = 0;
  for (int e = 0; e < 3; ++e) {
    const std::uint32_t other = neighbours_[i][e];
    if (other == kNoFacet) continue;
    const double turn_rad = angleBetween(normal(i), normal(other));
    if (turn_rad <= kCurved_rad) bound_m += heightAcross(triangle(i), e) * turn_rad / 4;
  }
  return bound_m;
}

double PartSurface::crackIn(const Box& box_P) const {
  double most_m = 0;
  for (const Crack& crack : cracks_)
    if (distance2(box_P, Box{crack.p_P, crack.p_P}) == 0) most_m = std::max(most_m, crack.width_m);
  return most_m;
}

double PartSurface::chordIn(const Box& box_P) const {
  double most_m = 0;
  tree_.forEach([&](const Box& node) { return distance2(node, box_P) == 0; },
                [&](std::uint32_t i) {
                  if (chord_m_[i] <= most_m) return;
                  Box box;
                  for (const Vec3& p : triangle(i)) box.add(p);
                  if (distance2(box, box_P) == 0) most_m = chord_m_[i];
                });
  return most_m;
}

}  // namespace vps::scenes
