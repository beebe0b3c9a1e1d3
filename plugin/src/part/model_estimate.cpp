// SPDX-License-Identifier: BSD-3-Clause
#include "vps/model_estimate.h"

#include <algorithm>
#include <cmath>

#include "pointshell/shell_samples.h"
#include "voxmap/map_limits.h"

namespace vps {
namespace {

/// Largest extent of a piece of surface, divided by the size of a brick.
constexpr double kPiece = 0.5;
/// The greatest number of pieces into which large triangles are cut. Assumed: a hundredth of a second.
constexpr double kMostPieces = 1e4;
/// Cells that a map keeps around a box: one and a half on average.
constexpr double kKeptCells = 1.5;
/// Face points per square of spacing, and the number of these squares that a point on an edge replaces.
/// Measured: with these values, the counts of the bearing block's parts are off by up to a tenth.
constexpr double kDensity = 1.12, kTakenByEdge = 0.3;

bool isWithinAny(const Vec3& p, const std::vector<Box>& boxes) {
  return std::ranges::any_of(boxes, [&](const Box& box) { return isWithin(p, box); });
}

}  // namespace

ModelEstimate::ModelEstimate(const Mesh& mesh, const VoxMapSettings& voxels, const PointShellSettings& points,
                             Extent extent)
    : extent_(extent) {
  // The estimate of a mesh that cannot be built is zero; building it reports the reason.
  const bool is_finite = std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                                     [](const Vec3& vertex) { return vertex.allFinite(); });
  if (!is_finite) return;
  area_m2_ = area(mesh);
  cell_m_ = VoxMap::kBrick * voxels.voxel_m;
  // Bricks across a slab as thick as the band: its thickness in bricks, and one for the position of its
  // start.
  bricks_per_m2_ = (2 * voxels.band_voxels / VoxMap::kBrick + 1.2) / (cell_m_ * cell_m_);
  const Vec3 size_m = bounds(mesh).size();
  directory_bytes_ =
      directoryBytes(Vec3((size_m.array() + 2 * voxels.band_voxels * voxels.voxel_m) / cell_m_ + 3));
  face_points_per_m2_ = kDensity / (points.spacing_m * points.spacing_m);
  const std::vector<ShellSample> on_edges =
      sampleFeatures(mesh, triangleNormals(mesh), kEdgeStep * points.spacing_m,
                     kEdgeTolerance * points.spacing_m, points.edge_angle_rad);
  edge_points_ = static_cast<double>(on_edges.size());
  if (extent == Extent::WholeOnly) return;
  for (const ShellSample& sample : on_edges) edge_points_P_.push_back(sample.p);
  const double piece_m = std::max(kPiece * cell_m_, std::sqrt(area_m2_ / kMostPieces));
  pieces_.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    addPieces(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], piece_m);
}

/// Halves a triangle across its longest edge until its longest edge is short.
void ModelEstimate::addPieces(const Vec3& a, const Vec3& b, const Vec3& c, double piece_m) {
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  if (bc > ab && bc >= ca) return addPieces(b, c, a, piece_m);
  if (ca > ab) return addPieces(c, a, b, piece_m);
  const double area_m2 = 0.5 * (b - a).cross(c - a).norm();
  // A sliver's area lies along its longest edge, so it need not be halved further once it is narrow.
  if (ab <= piece_m * piece_m || area_m2 <= 1e-3 * piece_m * piece_m) {
    pieces_.push_back({(a + b + c) / 3, area_m2});
    return;
  }
  const Vec3 middle = 0.5 * (a + b);
  addPieces(a, middle, c, piece_m);
  addPieces(middle, b, c, piece_m);
}

double ModelEstimate::areaWithin(const std::vector<Box>& boxes_P) const {
  double sum_m2 = 0;
  for (const Piece& piece : pieces_)
    if (isWithinAny(piece.center_P, boxes_P)) sum_m2 += piece.area_m2;
  return sum_m2;
}

double ModelEstimate::mapBytes(const std::vector<Box>& kept_P) const {
  double kept_m2 = area_m2_;
  if (isCropped(kept_P)) {
    std::vector<Box> around_P;
    for (const Box& box : kept_P) around_P.push_back(grown(box, kKeptCells * cell_m_));
    kept_m2 = areaWithin(around_P);
  }
  return directory_bytes_ + bricks_per_m2_ * kept_m2 * VoxPool::kBytes;
}

double ModelEstimate::pointCount(const std::vector<Box>& kept_P) const {
  const double kept_m2 = isCropped(kept_P) ? areaWithin(kept_P) : area_m2_;
  double edges = edge_points_;
  if (isCropped(kept_P))
    edges = static_cast<double>(
        std::ranges::count_if(edge_points_P_, [&](const Vec3& p_P) { return isWithinAny(p_P, kept_P); }));
  return edges + std::max(0.0, face_points_per_m2_ * kept_m2 - kDensity * kTakenByEdge * edges);
}

double ModelEstimate::shellBytes(double point_count) {
  // Per point: position, normal, area, order, its lane of a block and its fraction of the nodes above.
  return sizeof(PointShell) + point_count * (2 * sizeof(Vec3) + sizeof(double) + sizeof(std::uint32_t) +
                                             (sizeof(ShellBlock) * 17.0 / 16 + 2 * sizeof(ShellNode)) / 16);
}

}  // namespace vps
