// SPDX-License-Identifier: BSD-3-Clause
#include "check/flat_faces.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes::inline v0 {

namespace {

/// Coordinates of files with six or seven digits are off by up to 1e-6 of the greatest.
constexpr double kFlatFacesRounding = 2e-6;
constexpr double kFlatFacesParallel = 1e-3;  // of the normals of facets whose corners decide more precisely

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
  for (const auto& [area, seed] : seeds) {
    if (is_taken[seed]) continue;
    FlatFace face{surface.normal(seed), surface.normal(seed).dot(surface.triangle(seed)[0]), 0, 0, {seed}};
    is_taken[seed] = true;
    for (std::size_t next = 0; next < face.facets.size(); ++next) {
      face.area_m2 += areaOf(face.facets[next]);
      for (const std::uint32_t k : surface.neighbours()[face.facets[next]]) {
        if (k == kNoFacet || is_taken[k] || surface.normal(k).dot(face.n) < 1 - kFlatFacesParallel) continue;
        double off_m = 0;
        for (const Vec3& x : surface.triangle(k))
          off_m = std::max(off_m, std::abs(face.n.dot(x) - face.offset_m));
        if (off_m > tolerance_m) continue;
        face.residual_m = std::max(face.residual_m, off_m);
        is_taken[k] = true;
        face.facets.push_back(k);
      }
    }
    std::ranges::sort(face.facets);
    faces.push_back(std::move(face));
  }
  std::ranges::stable_sort(faces, [](const FlatFace& a, const FlatFace& b) { return a.area_m2 > b.area_m2; });
  if (faces.size() > most) faces.resize(most);
  return faces;
}

}  // namespace vps::scenes::inline v0
