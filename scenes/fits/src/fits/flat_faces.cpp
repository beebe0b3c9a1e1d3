// SPDX-License-Identifier: BSD-3-Clause
#include "fits/faces.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace vps::scenes {

namespace {

/// Coordinates in files with six or seven digits deviate by up to 1e-6 of the greatest coordinate.
constexpr double kFlatFacesRounding = 2e-6;
constexpr double kFlatFacesParallel = 1e-3;  // greatest 1 - cosine of parallel normals

double offPlane(const FlatFace& face, const PartSurface& surface, std::uint32_t facet) {
  double off_m = 0;
  for (const Vec3& x : surface.triangle(facet))
    off_m = std::max(off_m, std::abs(face.n.dot(x) - face.offset_m));
  return off_m;
}

/// Joins adjacent faces in one plane. Adjacent faces have no common edge at a crack, or where facets are
/// divided on one side of an edge only. Only the kJoined largest faces are examined, so that fine meshes of
/// curved faces cost little: O(kJoined^2).
void joinPieces(const PartSurface& surface, double tolerance_m, std::vector<FlatFace>& faces) {
  constexpr std::size_t kJoined = 2000;
  // Greatest gap between joined pieces, as a share of the smaller piece's size. assumed: slots are wider and
  // cracks are narrower than this share.
  constexpr double kMostGap = 0.05;
  const std::size_t count = std::min(kJoined, faces.size());
  std::vector<Box> boxes(count);
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint32_t facet : faces[i].facets)
      for (const Vec3& x : surface.triangle(facet)) boxes[i].add(x);
  std::vector<bool> is_joined(faces.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (is_joined[i]) continue;
    FlatFace& face = faces[i];
    pollStop();
    std::vector<std::size_t> in_plane, members = {i};
    for (std::size_t k = i + 1; k < count; ++k)
      if (!is_joined[k] && faces[k].n.dot(face.n) > 1 - kFlatFacesParallel &&
          std::ranges::all_of(faces[k].facets, [&](std::uint32_t facet) {
            return offPlane(face, surface, facet) <= tolerance_m;
          }))
        in_plane.push_back(k);
    for (std::size_t next = 0; next < members.size(); ++next)
      for (const std::size_t k : in_plane) {
        const double gap_m = kMostGap * std::sqrt(std::min(faces[k].area_m2, faces[members[next]].area_m2));
        if (is_joined[k] || distance2(boxes[k], boxes[members[next]]) > gap_m * gap_m) continue;
        is_joined[k] = true;
        members.push_back(k);
      }
    for (const std::size_t k : std::span(members).subspan(1)) {
      for (const std::uint32_t facet : faces[k].facets) {
        face.residual_m = std::max(face.residual_m, offPlane(face, surface, facet));
        face.facets.push_back(facet);
      }
      face.area_m2 += faces[k].area_m2;
    }
    std::ranges::sort(face.facets);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (!is_joined[i]) std::swap(faces[kept++], faces[i]);
  faces.resize(kept);
}

}  // namespace

std::vector<FlatFace> flatFaces(const PartSurface& surface, const std::vector<RoundFace>& round,
                                const std::vector<ThreadFace>& threads, std::size_t most) {
  const Mesh& mesh = surface.mesh();
  std::vector<bool> is_taken(mesh.triangles.size(), false);
  for (const ThreadFace& face : threads)
    for (const std::uint32_t i : face.facets) is_taken[i] = true;
  for (const RoundFace& face : round)
    for (const std::uint32_t i : face.facets) is_taken[i] = true;
  double tolerance_m = 0;
  for (const Vec3& v : mesh.vertices)
    tolerance_m = std::max(tolerance_m, kFlatFacesRounding * v.cwiseAbs().maxCoeff());
  // The largest facets give the best normals.
  std::vector<std::pair<double, std::uint32_t>> seeds;
  const auto areaOf = [&](std::uint32_t i) {
    const Triangle t = surface.triangle(i);
    return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
  };
  for (std::uint32_t i = 0; i < is_taken.size(); ++i) seeds.emplace_back(-areaOf(i), i);
  std::ranges::sort(seeds);

  std::vector<FlatFace> faces;
  StridedPoll poll;
  for (const auto& [area, seed] : seeds) {
    poll();
    if (is_taken[seed]) continue;
    FlatFace face{surface.normal(seed), surface.normal(seed).dot(surface.triangle(seed)[0]), 0, 0, {seed}};
    is_taken[seed] = true;
    for (std::size_t next = 0; next < face.facets.size(); ++next) {
      face.area_m2 += areaOf(face.facets[next]);
      for (const std::uint32_t k : surface.neighbours()[face.facets[next]]) {
        if (k == kNoFacet || is_taken[k] || surface.normal(k).dot(face.n) < 1 - kFlatFacesParallel) continue;
        const double off_m = offPlane(face, surface, k);
        if (off_m > tolerance_m) continue;
        face.residual_m = std::max(face.residual_m, off_m);
        is_taken[k] = true;
        face.facets.push_back(k);
      }
    }
    std::ranges::sort(face.facets);
    faces.push_back(std::move(face));
  }
  const auto is_larger = [](const FlatFace& a, const FlatFace& b) { return a.area_m2 > b.area_m2; };
  std::ranges::stable_sort(faces, is_larger);
  joinPieces(surface, tolerance_m, faces);
  std::ranges::stable_sort(faces, is_larger);
  if (faces.size() > most) faces.resize(most);
  return faces;
}

}  // namespace vps::scenes
