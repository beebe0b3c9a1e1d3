// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <map>

#include "mesh/mesh_edges.h"
#include "pointshell/shell_samples.h"

namespace vps {
namespace {

/// Appends samples of the border. A sample at a corner faces the mean of the directions out of its edges.
/// Each sample represents a square of step_m.
void addBorder(const Mesh& mesh, double step_m, std::vector<ShellSample>& samples) {
  std::map<std::uint32_t, Vec3> corners;
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    if (same.size() != 1) return;
    const HalfEdge& e = same[0];
    const Vec3 &a = mesh.vertices[e.low], way = mesh.vertices[e.high] - a;
    const Vec3 to_apex = mesh.vertices[mesh.triangles[e.triangle][(e.side + 2U) % 3]] - a;
    const Vec3 into = to_apex - way * (to_apex.dot(way) / way.squaredNorm());
    if (!(into.norm() > 0)) return;
    const Vec3 outward = -into.normalized();
    const int pieces = static_cast<int>(std::ceil(way.norm() / step_m));
    for (int k = 1; k < pieces; ++k)
      samples.push_back({a + (double(k) / pieces) * way, outward, step_m * step_m});
    for (const std::uint32_t v : {e.low, e.high})
      corners.try_emplace(v, Vec3::Zero()).first->second += outward;
  });
  for (const auto& [v, sum] : corners)
    if (sum.norm() > 1e-6) samples.push_back({mesh.vertices[v], sum.normalized(), step_m * step_m});
}

}  // namespace

void addOtherSides(const Mesh& mesh, double step_m, std::vector<ShellSample>& samples) {
  const std::size_t count = samples.size();
  for (std::size_t i = 0; i < count; ++i)
    samples.push_back({samples[i].p, -samples[i].outward, samples[i].area_m2});
  addBorder(welded(mesh), step_m, samples);
}

}  // namespace vps
