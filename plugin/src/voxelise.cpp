// SPDX-License-Identifier: BSD-3-Clause
// Mesh to voxmap: the exact distance at every node within the band.
//
// 1. Gather: for each triangle, the bricks it can reach; turned round into a list of triangles for each
// brick.
// 2. Distances: brick by brick, halved down to blocks of 4^3 nodes, each keeping only triangles that can be
// nearest
//    to one of its nodes; then node by node, skipping triangles whose bounding rectangle is too far.
// 3. Bricks: distances and the neighbours' border, and a sign for the nodes beyond the band.
// 4. Directory: exact distance at every cell's centre, which bounds the distance all around.
//
// Parallel over triangles, bricks and rows; each result has one writer and a fixed order of its own, so that
// every number of threads gives the same bits.
#include "voxelise.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cfloat>
#include <cmath>
#include <cstdio>
#include <span>

#include "triangle_distance.h"
#include "vps/load_error.h"
#include "vps/mesh_distance.h"

namespace vps {
namespace {

constexpr int kBrick = VoxMap::kBrick;
constexpr int kOwnNodes = kBrick * kBrick * kBrick;
/// Beyond the band, not signed yet.
constexpr float kFar = FLT_MAX;

/// The most memory a map may take. An assumed share of a workstation of 16 GiB, with room for several parts.
constexpr double kMemoryLimit_bytes = 4.0 * 1024 * 1024 * 1024;

constexpr int ownIndex(int x, int y, int z) {
  return (x * kBrick + y) * kBrick + z;
}

/// A triangle prepared for many questions: corners, and a rectangle around it in its plane whose distance is
/// a quick lower bound. Tight for slivers, which a sphere or an axis-aligned box is not.
struct PreparedTriangle {
  Vec3 a, b, c;
  Vec3 center, u, v, n;  // of the rectangle; u along the longest edge
  double half_u, half_v;
  std::uint32_t index;

  PreparedTriangle(const Mesh& mesh, std::uint32_t i) : index(i) {
    const auto& t = mesh.triangles[i];
    a = mesh.vertices[t[0]];
    b = mesh.vertices[t[1]];
    c = mesh.vertices[t[2]];
    Vec3 longest = b - a, other = c - a;
    if ((c - b).squaredNorm() > longest.squaredNorm()) longest = c - b, other = a - b;
    if ((a - c).squaredNorm() > longest.squaredNorm()) longest = a - c, other = b - c;
    u = longest.normalized();
    const Vec3 across = other - other.dot(u) * u;
    const double height = across.norm();
    // Collinear corners: any direction across will do, the rectangle has no width.
    v = height > 1e-12 * longest.norm() ? Vec3(across / height) : Vec3(u.unitOrthogonal());
    n = u.cross(v);
    Box in_uvn;
    for (const Vec3& p : {a, b, c}) in_uvn.add(Vec3((p - a).dot(u), (p - a).dot(v), 0));
    center = a + in_uvn.center().x() * u + in_uvn.center().y() * v;
    half_u = 0.5 * in_uvn.size().x();
    half_v = 0.5 * in_uvn.size().y();
  }

  /// Not more than the squared distance from p, but for rounding.
  [[nodiscard]] double atLeast2(const Vec3& p) const noexcept {
    const Vec3 r = p - center;
    const double du = std::max(std::abs(r.dot(u)) - half_u, 0.0);
    const double dv = std::max(std::abs(r.dot(v)) - half_v, 0.0);
    const double dn = r.dot(n);
    return du * du + dv * dv + dn * dn;
  }
};

/// The triangles that reach each brick, as one list with an offset for each cell of the directory.
struct Gathered {
  std::vector<std::size_t> cells;  ///< directory indices of bricks that some triangle may reach, ascending
  std::vector<std::size_t> first;  ///< where a cell's triangles start, one more at the end
  std::vector<std::uint32_t> triangles;
};

class Voxeliser {
 public:
  Voxeliser(const Mesh& mesh, const VoxMapSettings& settings)
      : mesh_(mesh), distance_(mesh), h_(settings.voxel_m), band_m_(bandOf(settings)) {}

  std::shared_ptr<VoxLayout> build(const Progress& progress);

  static double bandOf(const VoxMapSettings& settings) {
    // As the float that saturated nodes hold, so that a saturated distance equals band_m() exactly.
    return static_cast<float>(settings.band_voxels * settings.voxel_m);
  }

 private:
  using OwnNodes = std::array<float, kOwnNodes>;
  struct Candidate {
    std::uint32_t triangle;
    double distance_m;  // from the block's centre
  };
  struct Scratch;

  void layOutDirectory();
  void gather();
  void gatherTriangle(std::uint32_t triangle, const Index3& low, const Index3& size,
                      std::vector<std::pair<std::uint32_t, std::uint32_t>>& out) const;
  void computeNodes(const Index3& cell, std::span<const std::uint32_t> triangles, OwnNodes& nodes,
                    Scratch& scratch) const;
  void computeBlock(const Index3& node_low, std::span<const std::uint32_t> candidates, const Index3& offset,
                    OwnNodes& nodes, Scratch& scratch) const;
  void finishBricks();
  void finishBrick(std::size_t i, VoxBrick& brick) const;
  void finishDirectory();

  [[nodiscard]] Index3 cellAt(std::size_t index) const {
    const auto ny = static_cast<std::size_t>(layout_->size.y()),
               nz = static_cast<std::size_t>(layout_->size.z());
    return layout_->low + Index3(static_cast<int>(index / (ny * nz)), static_cast<int>(index / nz % ny),
                                 static_cast<int>(index % nz));
  }
  [[nodiscard]] Vec3 nodePosition(const Index3& node) const { return h_ * node.cast<double>(); }

  const Mesh& mesh_;
  const MeshDistance distance_;
  const double h_, band_m_;
  std::shared_ptr<VoxLayout> layout_ = std::make_shared<VoxLayout>();
  Gathered gathered_;
  std::vector<OwnNodes> own_;         // one for each of gathered_.cells
  std::vector<std::int32_t> own_of_;  // by directory index; -1: none
  std::vector<PreparedTriangle> prepared_;
};

struct Voxeliser::Scratch {
  std::vector<Candidate> block;
};

void Voxeliser::layOutDirectory() {
  const Box box = bounds(mesh_);
  const double cell_m = kBrick * h_;
  // One cell more than the band on each side: normals look into the neighbour, and bounds get a margin.
  const Vec3 low = ((box.min.array() - band_m_) / cell_m).floor() - 1;
  const Vec3 high = ((box.max.array() + band_m_) / cell_m).floor() + 2;
  layout_->low = low.cast<int>();
  layout_->size = (high - low).cast<int>();
  layout_->cells.resize(static_cast<std::size_t>((high - low).prod()));
  layout_->parts = {{box, layout_->low, layout_->low + layout_->size}};
  layout_->constants = constantBricks(band_m_);
}

/// Halves the range of cells until few are left, dropping halves that the triangle cannot reach: a big
/// oblique triangle costs what its surface costs, not its box.
void Voxeliser::gatherTriangle(std::uint32_t triangle, const Index3& low, const Index3& size,
                               std::vector<std::pair<std::uint32_t, std::uint32_t>>& out) const {
  const PreparedTriangle& t = prepared_[triangle];
  const Vec3 half = 0.5 * kBrick * h_ * size.cast<double>();
  const Vec3 center = kBrick * h_ * low.cast<double>() + half;
  const double reach_m = half.norm() + band_m_;
  if (t.atLeast2(center) > reach_m * reach_m) return;
  if (size.prod() == 1) {
    out.emplace_back(static_cast<std::uint32_t>(layout_->cellIndex(low)), triangle);
    return;
  }
  int axis = 0;
  size.maxCoeff(&axis);
  Index3 near = size, far = size, middle = low;
  near[axis] = size[axis] / 2;
  far[axis] = size[axis] - near[axis];
  middle[axis] += near[axis];
  gatherTriangle(triangle, low, near, out);
  gatherTriangle(triangle, middle, far, out);
}

void Voxeliser::gather() {
  const std::size_t count = mesh_.triangles.size();
  prepared_.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) prepared_.emplace_back(mesh_, i);

  constexpr std::size_t kGrain = 1024;
  const std::size_t chunks = (count + kGrain - 1) / kGrain;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> reached(chunks);  // cell, triangle
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kGrain; i < std::min(count, (chunk + 1) * kGrain); ++i) {
      const PreparedTriangle& t = prepared_[i];
      const double cell_m = kBrick * h_;
      const Vec3 min = ((t.a.cwiseMin(t.b).cwiseMin(t.c).array() - band_m_) / cell_m).floor();
      const Vec3 max = ((t.a.cwiseMax(t.b).cwiseMax(t.c).array() + band_m_) / cell_m).floor();
      const Index3 low = min.cast<int>(), high = max.cast<int>();
      gatherTriangle(static_cast<std::uint32_t>(i), low, high - low + Index3::Ones(), reached[chunk]);
    }
  });

  // Counting sort by cell; triangles stay ascending within each.
  std::vector<std::size_t> start(layout_->cells.size() + 1, 0);
  for (const auto& chunk : reached)
    for (const auto& [cell, triangle] : chunk) ++start[cell + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  gathered_.triangles.resize(start.back());
  own_of_.assign(layout_->cells.size(), -1);
  for (std::size_t cell = 0; cell < layout_->cells.size(); ++cell) {
    if (start[cell] == start[cell + 1]) continue;
    own_of_[cell] = static_cast<std::int32_t>(gathered_.cells.size());
    gathered_.cells.push_back(cell);
    gathered_.first.push_back(start[cell]);
  }
  gathered_.first.push_back(start.back());
  for (const auto& chunk : reached)
    for (const auto& [cell, triangle] : chunk) gathered_.triangles[start[cell]++] = triangle;
}

/// Signed distance at a brick's own nodes; kFar beyond the band.
void Voxeliser::computeNodes(const Index3& cell, std::span<const std::uint32_t> triangles, OwnNodes& nodes,
                             Scratch& scratch) const {
  nodes.fill(kFar);
  const Index3 low = kBrick * cell;
  for (int block = 0; block < 8; ++block) {
    const Index3 offset = 4 * Index3(block >> 2, block >> 1 & 1, block & 1);
    computeBlock(low + offset, triangles, offset, nodes, scratch);
  }
}

void Voxeliser::computeBlock(const Index3& node_low, std::span<const std::uint32_t> candidates,
                             const Index3& offset, OwnNodes& nodes, Scratch& scratch) const {
  // A triangle farther from the centre than the nearest one by the block's diameter is nearest to no node in
  // it.
  const double radius_m = 1.5 * std::sqrt(3.0) * h_ * (1 + 1e-9);
  const Vec3 center = h_ * (node_low.cast<double>() + Vec3::Constant(1.5));
  std::vector<Candidate>& block = scratch.block;
  block.clear();
  double limit_m = band_m_ + radius_m;
  for (const std::uint32_t i : candidates) {
    const PreparedTriangle& t = prepared_[i];
    if (t.atLeast2(center) > limit_m * limit_m * (1 + 1e-9)) continue;
    const double distance_m = (center - closestOnTriangleInline(center, t.a, t.b, t.c).q).norm();
    if (distance_m > limit_m) continue;
    limit_m = std::min(limit_m, distance_m + 2 * radius_m);
    block.push_back({i, distance_m});
  }
  // Nearest first: the search below may stop early.
  std::sort(block.begin(), block.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.triangle < b.triangle;
  });

  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) {
        const Vec3 p = nodePosition(node_low + Index3(x, y, z));
        const double from_center_m = (p - center).norm() * (1 + 1e-9);
        double best2 = band_m_ * band_m_, best_m = band_m_;
        TrianglePoint nearest;
        std::uint32_t triangle = UINT32_MAX;
        for (const Candidate& candidate : block) {
          if (candidate.distance_m - from_center_m > best_m) break;
          const PreparedTriangle& t = prepared_[candidate.triangle];
          if (t.atLeast2(p) > best2 * (1 + 1e-9)) continue;
          const TrianglePoint at = closestOnTriangleInline(p, t.a, t.b, t.c);
          const double distance2 = (p - at.q).squaredNorm();
          if (distance2 < best2) {
            best2 = distance2;
            best_m = std::sqrt(distance2);
            nearest = at;
            triangle = candidate.triangle;
          }
        }
        if (triangle == UINT32_MAX) continue;
        const bool is_inside = distance_.featureNormal(triangle, nearest.feature).dot(p - nearest.q) < 0;
        const auto distance_m = static_cast<float>(best_m);
        if (distance_m >= static_cast<float>(band_m_)) continue;
        nodes[ownIndex(offset.x() + x, offset.y() + y, offset.z() + z)] =
            is_inside ? -distance_m : distance_m;
      }
}

/// Gives far nodes of a brick the band's distance, with the sign of the node beside them: where one of two
/// neighbours is far, the surface does not pass between, since the band is wider than a voxel.
void saturate(VoxBrick& brick, float band_m) {
  const auto take = [&](int far, int from) {
    float& d = brick.distance_m[far];
    if (d == kFar && brick.distance_m[from] != kFar) d = std::copysign(band_m, brick.distance_m[from]);
  };
  // Up and down along z fills each row that knows a sign; then along y each plane; then along x the brick.
  constexpr int kStride[3] = {nodeIndex(0, 0, 1), nodeIndex(0, 1, 0), nodeIndex(1, 0, 0)};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < kNodes; ++i)
      for (int j = 0; j < kNodes; ++j) {
        const int stride = kStride[axis];
        const int row = i * kStride[(axis + 1) % 3] + j * kStride[(axis + 2) % 3];
        for (int k = 1; k < kNodes; ++k) take(row + k * stride, row + (k - 1) * stride);
        for (int k = kNodes - 1; k > 0; --k) take(row + (k - 1) * stride, row + k * stride);
      }
}

void Voxeliser::finishBrick(std::size_t i, VoxBrick& brick) const {
  const Index3 cell = cellAt(gathered_.cells[i]);
  for (int part = 0; part < 8; ++part) {  // the brick's own nodes, and the first ones of seven neighbours
    const Index3 step(part >> 2, part >> 1 & 1, part & 1);
    const Index3 neighbour = cell + step;
    const std::int32_t own = layout_->holds(neighbour) ? own_of_[layout_->cellIndex(neighbour)] : -1;
    for (int x = 0; x < (step.x() ? 1 : kBrick); ++x)
      for (int y = 0; y < (step.y() ? 1 : kBrick); ++y)
        for (int z = 0; z < (step.z() ? 1 : kBrick); ++z)
          brick.distance_m[nodeIndex(x + kBrick * step.x(), y + kBrick * step.y(), z + kBrick * step.z())] =
              own < 0 ? kFar : own_[own][ownIndex(x, y, z)];
  }
}

void Voxeliser::finishBricks() {
  auto pool = std::make_shared<VoxPool>();
  const std::size_t count = gathered_.cells.size();
  std::vector<VoxBrick> all(count);
  std::vector<std::uint8_t> has_band(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    finishBrick(i, all[i]);
    has_band[i] =
        std::any_of(all[i].distance_m.begin(), all[i].distance_m.end(), [](float d) { return d != kFar; });
    if (has_band[i]) saturate(all[i], static_cast<float>(band_m_));
  });
  std::size_t stored = 0;
  for (const std::uint8_t has : has_band) stored += has;
  pool->bricks.reserve(stored);  // cells point into it: it must not move
  for (std::size_t i = 0; i < count; ++i) {
    if (!has_band[i]) continue;
    pool->bricks.push_back(all[i]);
    layout_->cells[gathered_.cells[i]].brick = &pool->bricks.back();
  }
  layout_->pools = {pool};
}

void Voxeliser::finishDirectory() {
  const Index3 size = layout_->size;
  tbb::parallel_for(0, size.x() * size.y(), [&](int row) {
    double last_m = 1e300;
    for (int z = 0; z < size.z(); ++z) {
      const Index3 cell = layout_->low + Index3(row / size.y(), row % size.y(), z);
      const Vec3 center = nodePosition(kBrick * cell + Index3::Constant(kBrick / 2));
      // From the centre before, the surface can be farther by the way between at most: a good start for the
      // search.
      const double limit_m = (last_m + kBrick * h_) * (1 + 1e-9);
      const double distance_m = distance_.signedDistance(center, limit_m);
      last_m = std::abs(distance_m);
      VoxCell& entry = layout_->cells[layout_->cellIndex(cell)];
      entry.center_m = static_cast<float>(distance_m);
      if (entry.brick == nullptr) entry.brick = distance_m < 0 ? layout_->inside() : layout_->outside();
    }
  });
}

std::shared_ptr<VoxLayout> Voxeliser::build(const Progress& progress) {
  const auto tell = [&](double share) {
    if (progress) progress("voxelising", share);
  };
  tell(0);
  layOutDirectory();
  gather();
  tell(0.2);
  own_.resize(gathered_.cells.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, own_.size()), [&](const auto& range) {
    Scratch scratch;
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      computeNodes(cellAt(gathered_.cells[i]),
                   std::span(gathered_.triangles)
                       .subspan(gathered_.first[i], gathered_.first[i + 1] - gathered_.first[i]),
                   own_[i], scratch);
  });
  tell(0.7);
  finishBricks();
  tell(0.8);
  finishDirectory();
  tell(1);
  return layout_;
}

/// Bytes for a map of this surface: bricks that meet a slab as thick as the band and a brick's own slant, and
/// the directory.
double estimatedBytes(double area_m2, const Vec3& size_m, double h, double band_voxels) {
  const double cell_m = VoxMap::kBrick * h;
  const double bricks = area_m2 / (cell_m * cell_m) * (2 * band_voxels / VoxMap::kBrick + 1.5);
  const double cells = ((size_m.array() + 2 * band_voxels * h) / cell_m + 3).prod();
  return bricks * 2 * sizeof(VoxBrick) +
         cells * (sizeof(VoxCell) + 16);  // twice: bricks are built, then packed
}

void requireSettings(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part) {
  if (!(settings.voxel_m > 0) || !std::isfinite(settings.voxel_m))
    throw LoadError("", part, "voxel size must be above 0; 0.25 mm suits fits of 20 um and more");
  if (!(settings.band_voxels >= 3) || !(settings.band_voxels <= 64))
    throw LoadError("", part, "band must be 3 to 64 voxels wide on each side; 4 is usual");
  const double area_m2 = area(mesh);
  const Vec3 size_m = bounds(mesh).size();
  const auto fits = [&](double h) {
    return estimatedBytes(area_m2, size_m, h, settings.band_voxels) <= kMemoryLimit_bytes &&
           bounds(mesh).max.cwiseAbs().cwiseMax(bounds(mesh).min.cwiseAbs()).maxCoeff() / h < 1e9;
  };
  if (fits(settings.voxel_m)) return;
  double h = settings.voxel_m;
  while (!fits(h)) h *= 1.05;
  char text[160];
  std::snprintf(
      text, sizeof text, "needs %.0f GiB at %.3g mm voxels, the limit is %.0f; %.2g mm would fit",
      estimatedBytes(area_m2, size_m, settings.voxel_m, settings.band_voxels) / (1024.0 * 1024 * 1024),
      settings.voxel_m * 1e3, kMemoryLimit_bytes / (1024.0 * 1024 * 1024), h * 1.05e3);
  throw LoadError("", part, text);
}

}  // namespace

std::shared_ptr<const VoxPool> constantBricks(double band_m) {
  auto pool = std::make_shared<VoxPool>();
  pool->bricks.resize(2);
  pool->bricks[0].distance_m.fill(static_cast<float>(band_m));
  pool->bricks[1].distance_m.fill(-static_cast<float>(band_m));
  return pool;
}

VoxMap VoxMapBuilder::build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                            const Progress& progress) {
  requireUsable(mesh, "", part);
  requireSettings(mesh, settings, part);
  const Mesh shared = welded(mesh);  // signs need shared vertices
  VoxMap map;
  map.voxel_m_ = settings.voxel_m;
  map.band_m_ = Voxeliser::bandOf(settings);
  map.bounds_ = bounds(mesh);
  map.layout_ = Voxeliser(shared, settings).build(progress);
  return map;
}

VoxMap buildVoxMap(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                   const Progress& progress) {
  return VoxMapBuilder::build(mesh, settings, part, progress);
}

}  // namespace vps
