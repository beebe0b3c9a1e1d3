// SPDX-License-Identifier: BSD-3-Clause
#include "judge/overlap_judge.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "vps/mesh.h"
#include "vps/mesh_overlap.h"
#include "vps/query.h"

namespace vps::scenes {

namespace {

constexpr double kSharp_rad = 0.35;  // least angle of a sharp edge, about 20 degrees, as for pointshells
constexpr double kFlat_rad = 1e-6;   // rounding bends a flat face at its diagonal by about 1e-8

void keep(PointDepth& deepest, double depth_m, const Vec3& p_S) {
  if (depth_m > deepest.depth_m) deepest = {depth_m, p_S};
}

/// Exact signed distance of a point from a solid. The distance must be at most most_m, which bounds the
/// search.
double signedDistance(const JudgedBody& solid, const Vec3& p_S, double most_m) {
  return solid.model->solid->signedDistance(p_S, most_m * (1 + 1e-12) + 1e-12);
}

/// Whether the map's bound proves that no point of segment ab is inside the solid.
bool isSurelyOutside(const JudgedBody& solid, const Vec3& a, const Vec3& b) {
  return solid.model->map->leastDistance(0.5 * (a + b)) > 0.5 * (b - a).norm();
}

/// Indices of the boxes of a tree that may reach into the solid, in ascending order. The tree is in the other
/// body's frame.
std::vector<std::uint32_t> mayReachInto(const JudgedBody& solid, const BoxTree& tree, const Pose& X_SO) {
  std::vector<std::uint32_t> found;
  tree.forEach(
      [&](const Box& box_O) {
        return !isSurelyOutside(solid, X_SO * Vec3(box_O.min), X_SO * Vec3(box_O.max));
      },
      [&](std::uint32_t i) { found.push_back(i); });
  std::sort(found.begin(), found.end());
  return found;
}

PointDepth deepestEdge(const JudgedBody& solid, const JudgedBody& other, const Pose& X_SO) {
  std::vector<SharpEdge> near;
  for (const std::uint32_t i : mayReachInto(solid, *other.edge_tree, X_SO)) {
    const SharpEdge& edge = (*other.edges)[i];
    const SharpEdge edge_S = {X_SO * edge.a, X_SO * edge.b};
    if (!isSurelyOutside(solid, edge_S.a, edge_S.b)) near.push_back(edge_S);
  }
  std::vector<PointDepth> found(near.size());
  tbb::parallel_for(std::size_t{0}, near.size(), [&](std::size_t i) {
    found[i] = deepestOnSegment(*solid.model->solid, near[i].a, near[i].b, OverlapJudge::kCertain_m);
  });
  PointDepth deepest;
  for (const PointDepth& d : found) keep(deepest, d.depth_m, d.p_S);
  return deepest;
}

PointDepth deepestPoint(const JudgedBody& solid, const JudgedBody& other, const Pose& X_SO) {
  // For a point that is inside by exact distance, the map's distance is below the map's greatest error.
  QueryOptions options;
  options.cutoff_m = solid.model->map->sampleError_m();
  ContactSet candidates(other.model->shell->size());
  queryContacts(*solid.model->map, *other.model->shell, X_SO, options, candidates);

  std::vector<double> depths(candidates.contacts.size());
  tbb::parallel_for(std::size_t{0}, depths.size(), [&](std::size_t i) {
    const Contact& contact = candidates.contacts[i];
    // Below its band the map has no value, so that the map does not bound the search.
    const bool is_in_band = std::abs(contact.distance_m) < solid.model->map->band_m();
    const double most_m = is_in_band ? std::abs(contact.distance_m) + solid.model->map->sampleError_m() : 1e3;
    depths[i] = -signedDistance(solid, X_SO * other.model->shell->points[contact.id], most_m);
  });
  PointDepth deepest;
  for (std::size_t i = 0; i < depths.size(); ++i) keep(deepest, depths[i], candidates.contacts[i].p_M);
  return deepest;
}

PointDepth deepestVertex(const JudgedBody& solid, const JudgedBody& other, const Pose& X_SO) {
  std::vector<Vec3> near;
  for (const std::uint32_t i : mayReachInto(solid, *other.vertex_tree, X_SO))
    if (const Vec3 p_S = X_SO * (*other.vertices)[i]; !isSurelyOutside(solid, p_S, p_S)) near.push_back(p_S);
  std::vector<double> depths(near.size());
  tbb::parallel_for(std::size_t{0}, near.size(),
                    [&](std::size_t i) { depths[i] = -solid.model->solid->signedDistance(near[i]); });
  PointDepth deepest;
  for (std::size_t i = 0; i < depths.size(); ++i) keep(deepest, depths[i], near[i]);
  return deepest;
}

PointDepth deepestIn(const JudgedBody& solid, const JudgedBody& other, const Pose& X_SO) {
  PointDepth deepest = deepestPoint(solid, other, X_SO);
  for (const PointDepth& found : {deepestEdge(solid, other, X_SO), deepestVertex(solid, other, X_SO)})
    keep(deepest, found.depth_m, found.p_S);
  return deepest;
}

}  // namespace

JudgedBody makeJudgedBody(std::shared_ptr<const PartModel> model) {
  const Mesh& mesh = model->solid->mesh();
  std::vector<SharpEdge> edges;
  std::vector<bool> is_curved(mesh.vertices.size());
  for (const auto& edge : sharpEdges(mesh, kFlat_rad))
    for (const std::uint32_t end : edge) is_curved[end] = true;
  for (const auto& [a, b] : sharpEdges(mesh, kSharp_rad)) {
    edges.push_back({mesh.vertices[a], mesh.vertices[b]});
    is_curved[a] = is_curved[b] = false;  // the measure along an edge covers the edge's ends
  }
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i < is_curved.size(); ++i)
    if (is_curved[i]) vertices.push_back(mesh.vertices[i]);
  std::vector<Box> edge_boxes, vertex_boxes;
  for (const SharpEdge& e : edges) edge_boxes.push_back({e.a.cwiseMin(e.b), e.a.cwiseMax(e.b)});
  for (const Vec3& v : vertices) vertex_boxes.push_back({v, v});
  return {std::move(model), std::make_shared<const std::vector<SharpEdge>>(std::move(edges)),
          std::make_shared<const BoxTree>(edge_boxes, 2),
          std::make_shared<const std::vector<Vec3>>(std::move(vertices)),
          std::make_shared<const BoxTree>(vertex_boxes, 2)};
}

void OverlapJudge::mount(JudgedBody body, const Pose& X_WB) {
  mounted_.push_back({std::move(body), X_WB});
}

Penetration OverlapJudge::deepest(const JudgedBody& moving, const Pose& X_WP) const {
  Penetration worst;
  const auto consider = [&](const PointDepth& found, const Pose& X_WS, std::size_t mounted) {
    if (found.depth_m > worst.depth_m) worst = {found.depth_m, X_WS * found.p_S, mounted};
  };
  for (std::size_t i = 0; i < mounted_.size(); ++i) {
    const auto& [body, X_WB] = mounted_[i];
    const Pose X_BP = X_WB.inverse() * X_WP;
    consider(deepestIn(body, moving, X_BP), X_WB, i);
    consider(deepestIn(moving, body, X_BP.inverse()), X_WP, i);
  }
  return worst;
}

double OverlapJudge::fieldDepth_m(const JudgedBody& moving, const Pose& X_WP) const {
  double least_m = 0;
  for (const auto& [body, X_WB] : mounted_) {
    const Pose X_BP = X_WB.inverse() * X_WP;
    for (const QueryResult& result : {queryDistance(*body.model->map, *moving.model->shell, X_BP),
                                      queryDistance(*moving.model->map, *body.model->shell, X_BP.inverse())})
      if (result.status == Status::Ok) least_m = std::min(least_m, result.min_distance_m);
  }
  return -least_m;
}

}  // namespace vps::scenes
