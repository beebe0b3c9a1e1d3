// SPDX-License-Identifier: BSD-3-Clause
// Mesh to voxmap: the exact distance at every node within the band.
//
// 1. Gather: for each triangle, the bricks it can reach; turned round into a list of triangles for each
// brick.
// 2. Distances: a brick is halved into blocks of 4^3, 2^3 nodes and then one, each block keeping only the
// triangles
//    that can be nearest to one of its nodes.
// 3. Bricks: distances and the neighbours' border, and a sign for the nodes beyond the band.
// 4. Directory: a sign and a bound of the distance at every cell's centre.
//
// Parallel over triangles, bricks and rows; each result has one writer and a fixed order of its own, so that
// every number of threads gives the same bits.
#include "voxelise.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <span>

#include "brick_assembly.h"
#include "triangle_bounds.h"
#include "triangle_distance.h"
#include "vps/load_error.h"
#include "vps/mesh_distance.h"
#include "vps/mesh_repair.h"
#include "winding_signs.h"

namespace vps {
namespace {

constexpr int kBrick = VoxMap::kBrick;
/// The most memory a map may take. An assumed share of a workstation of 16 GiB, with room for several parts.
constexpr double kMemoryLimit_bytes = 4.0 * 1024 * 1024 * 1024;

/// How far the bound at a cell's centre may fall short, as a share: the cell's own size costs more, and an
/// exact search is slow amid a round part, where everything is equally far.
constexpr double kCenterSlack = 0.1;

constexpr int ownIndex(int x, int y, int z) {
  return (x * kBrick + y) * kBrick + z;
}

/// The triangles that may reach each block of nodes, as one list.
struct Gathered {
  std::vector<std::size_t> first;  ///< where a block's triangles start, and one more for the end
  std::vector<std::uint32_t> triangles;
};

class Voxeliser {
 public:
  /// @param signer signs nodes by winding number; null: by pseudonormals
  Voxeliser(const Mesh& mesh, const VoxMapSettings& settings, WindingSigner* signer)
      : mesh_(mesh), distance_(mesh), h_(settings.voxel_m), band_m_(bandOf(settings)), signer_(signer) {}

  std::shared_ptr<VoxLayout> build(const Progress& progress);
  /// False if pseudonormals turned out to contradict each other.
  [[nodiscard]] bool areSignsSound() const { return are_signs_sound_; }

  static double bandOf(const VoxMapSettings& settings) {
    // As the float that saturated nodes hold, so that a saturated distance equals band_m() exactly.
    return static_cast<float>(settings.band_voxels * settings.voxel_m);
  }

 private:
  struct Nearest {
    TrianglePoint at;
    std::uint32_t triangle = UINT32_MAX;
    double distance_m;
  };
  /// One brick being computed; a list for each level of blocks.
  struct Work {
    Vec3 center;
    Index3 low;
    TriangleBounds lists[4];
    OwnNodes* nodes;
  };

  void layOutDirectory();
  void gather();
  void gatherTriangle(std::uint32_t triangle, const Index3& low, const Index3& size,
                      std::vector<std::pair<std::uint32_t, std::uint32_t>>& out) const;
  void computeNodes(std::size_t i, Work& work);
  void computeBlock(const Index3& low, int level, Work& work) const;
  Nearest nearest(const Vec3& p, double limit_m, Work& work, int level) const;
  void boundCenters();

  [[nodiscard]] Vec3 nodePosition(const Index3& node) const { return h_ * node.cast<double>(); }

  const Mesh& mesh_;
  const MeshDistance distance_;
  const double h_, band_m_;
  WindingSigner* const signer_;
  bool are_signs_sound_ = true;
  std::shared_ptr<VoxLayout> layout_ = std::make_shared<VoxLayout>();
  Gathered gathered_;
  NodeBlocks blocks_;  // of gathered bricks
  std::vector<BoundedTriangle> bounded_;
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
  const BoundedTriangle& t = bounded_[triangle];
  const Vec3 half = 0.5 * kBrick * h_ * size.cast<double>();
  const Vec3 center = kBrick * h_ * low.cast<double>() + half;
  const double reach_m = half.norm() + band_m_;
  if (t.bound2(center) > reach_m * reach_m) return;
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
  bounded_.reserve(count);
  for (const auto& t : mesh_.triangles) bounded_.emplace_back(mesh_, t);

  constexpr std::size_t kGrain = 1024;
  const std::size_t chunks = (count + kGrain - 1) / kGrain;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> reached(chunks);  // cell, triangle
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kGrain; i < std::min(count, (chunk + 1) * kGrain); ++i) {
      const BoundedTriangle& t = bounded_[i];
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
  for (std::size_t cell = 0; cell < layout_->cells.size(); ++cell) {
    if (start[cell] == start[cell + 1]) continue;
    blocks_.cells.push_back(cell);
    gathered_.first.push_back(start[cell]);
  }
  gathered_.first.push_back(start.back());
  for (const auto& chunk : reached)
    for (const auto& [cell, triangle] : chunk) gathered_.triangles[start[cell]++] = triangle;
}

/// Signed distance at a brick's own nodes; kFar beyond the band.
void Voxeliser::computeNodes(std::size_t i, Work& work) {
  work.nodes = &blocks_.nodes[i];
  work.nodes->fill(kFar);
  work.low = kBrick * layout_->cellAt(blocks_.cells[i]);
  work.center = h_ * (work.low.cast<double>() + Vec3::Constant(0.5 * (kBrick - 1)));
  const std::size_t count = gathered_.first[i + 1] - gathered_.first[i];
  work.lists[0].reset(count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t triangle = gathered_.triangles[gathered_.first[i] + k];
    work.lists[0].add(triangle, bounded_[triangle], work.center, 1 / h_, kBrick);
  }
  computeBlock(Index3::Zero(), 0, work);
}

/// The nearest triangle of a level's list within limit_m of p, if any.
Voxeliser::Nearest Voxeliser::nearest(const Vec3& p, double limit_m, Work& work, int level) const {
  TriangleBounds& list = work.lists[level];
  const std::size_t first = list.ask(((p - work.center) / h_).cast<float>());
  const std::span<const float> bound2 = list.bounds2();
  Nearest best;
  best.distance_m = limit_m;
  double best2 = limit_m * limit_m;
  float reach2 = 0;  // skip what is farther than the best, in the list's unit
  const auto updateReach = [&] {
    const float reach = static_cast<float>(best.distance_m / h_) * (1 + 1e-5f) + list.slack();
    reach2 = reach * reach;
  };
  const auto attempt = [&](std::size_t i) {
    const BoundedTriangle& t = bounded_[list.triangle(i)];
    const TrianglePoint at = closestOnTriangleInline(p, t.a, t.b, t.c);
    const double distance2 = (p - at.q).squaredNorm();
    if (distance2 >= best2) return;
    best2 = distance2;
    best = {at, list.triangle(i), std::sqrt(distance2)};
    updateReach();
  };
  updateReach();
  // The one with the least bound first: most often it is the nearest, and the rest is skipped.
  if (bound2.empty() || bound2[first] > reach2) return best;
  attempt(first);
  for (std::size_t i = 0; i < bound2.size(); ++i)
    if (bound2[i] <= reach2 && i != first) attempt(i);
  return best;
}

/// A block of (8 >> level)^3 nodes at `low` in the brick.
void Voxeliser::computeBlock(const Index3& low, int level, Work& work) const {
  const int size = kBrick >> level;
  const Vec3 middle = (work.low + low).cast<double>() + Vec3::Constant(0.5 * (size - 1));
  const Vec3 center = h_ * middle;  // for a single node exactly its position
  const double radius_m = 0.5 * (size - 1) * std::sqrt(3.0) * h_;
  const Nearest best = nearest(center, (band_m_ + radius_m) * (1 + 1e-9), work, level);
  if (best.triangle == UINT32_MAX) return;
  if (size == 1) {
    const auto distance_m = static_cast<float>(best.distance_m);
    if (distance_m >= static_cast<float>(band_m_)) return;
    const bool is_inside =
        distance_.featureNormal(best.triangle, best.at.feature).dot(center - best.at.q) < 0;
    (*work.nodes)[ownIndex(low.x(), low.y(), low.z())] = is_inside ? -distance_m : distance_m;
    return;
  }
  // A triangle farther from the centre than the nearest one by the block's diameter is nearest to no node in
  // it.
  const TriangleBounds& list = work.lists[level];
  TriangleBounds& kept = work.lists[level + 1];
  const std::span<const float> bound2 = list.bounds2();
  const auto reach =
      static_cast<float>(std::min(best.distance_m + 2 * radius_m, band_m_ + radius_m) / h_) * (1 + 1e-5f) +
      list.slack();
  kept.reset(list.size(), list.slack());
  for (std::size_t i = 0; i < list.size(); ++i)
    if (bound2[i] <= reach * reach) kept.addFrom(list, i);
  for (int child = 0; child < 8; ++child)
    computeBlock(low + size / 2 * Index3(child >> 2, child >> 1 & 1, child & 1), level + 1, work);
}

void Voxeliser::boundCenters() {
  const Index3 size = layout_->size;
  tbb::parallel_for(0, size.x() * size.y(), [&](int row) {
    double last_m = 1e300;
    for (int z = 0; z < size.z(); ++z) {
      const Index3 cell = layout_->low + Index3(row / size.y(), row % size.y(), z);
      VoxCell& entry = layout_->cells[layout_->cellIndex(cell)];
      const Vec3 center = nodePosition(kBrick * cell + Index3::Constant(kBrick / 2));
      // From the centre before, the surface can be farther by the way between at most: a good start for the
      // search.
      const double start_m = (last_m * (1 + kCenterSlack) + kBrick * h_) * (1 + 1e-9);
      last_m = distance_.lowerBound(center, kCenterSlack, start_m);
      const bool is_inside = layout_->isConstant(entry.brick)
                                 ? entry.brick == layout_->inside()
                                 : entry.brick->distance_m[nodeIndex(kBrick / 2, kBrick / 2, kBrick / 2)] < 0;
      entry.center_m = static_cast<float>(is_inside ? -last_m : last_m);
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
  blocks_.nodes.resize(blocks_.cells.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks_.nodes.size()), [&](const auto& range) {
    Work work;
    for (std::size_t i = range.begin(); i < range.end(); ++i) computeNodes(i, work);
  });
  tell(0.7);
  if (signer_ != nullptr)
    signer_->signNodes(blocks_, *layout_, h_);
  else
    are_signs_sound_ = signsAgree(blocks_, h_);
  assembleBricks(*layout_, blocks_);
  if (signer_ != nullptr) signer_->signEmptyCells(*layout_, h_);
  tell(0.8);
  boundCenters();
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
  // Distances are floats; far beyond any part, but a file of nonsense gets there.
  if (!(settings.voxel_m > 1e-30) || !(settings.voxel_m < 1e30))
    throw LoadError("", part, "voxel size must lie between 1e-30 and 1e30 m; is the unit right?");
  if (!(settings.band_voxels >= 3) || !(settings.band_voxels <= 64))
    throw LoadError("", part, "band must be 3 to 64 voxels wide on each side; 4 is usual");
  const double area_m2 = area(mesh);
  const Vec3 size_m = bounds(mesh).size();
  char text[160];
  // Indices are 32 bit; half of their range is left to the part's own size, which the memory bounds below it.
  const double away_m = bounds(mesh).center().cwiseAbs().maxCoeff();
  if (!(away_m / settings.voxel_m < 1e9)) {
    std::snprintf(text, sizeof text,
                  "lies %.3g m from the origin, too far for %.3g mm voxels; move it nearer", away_m,
                  settings.voxel_m * 1e3);
    throw LoadError("", part, text);
  }
  const auto fits = [&](double h) {
    return estimatedBytes(area_m2, size_m, h, settings.band_voxels) <= kMemoryLimit_bytes;
  };
  if (fits(settings.voxel_m)) return;
  double h = settings.voxel_m;
  while (!fits(h)) h *= 1.05;
  std::snprintf(
      text, sizeof text, "needs %.0f GiB at %.3g mm voxels, the limit is %.0f; %.2g mm would fit",
      estimatedBytes(area_m2, size_m, settings.voxel_m, settings.band_voxels) / (1024.0 * 1024 * 1024),
      settings.voxel_m * 1e3, kMemoryLimit_bytes / (1024.0 * 1024 * 1024), h * 1.05e3);
  throw LoadError("", part, text);
}

}  // namespace

VoxMap VoxMapBuilder::build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                            const Progress& progress, MeshReport* report) {
  requireUsable(mesh, "", part);
  requireSettings(mesh, settings, part);
  VoxMap map;
  map.layout_ = nullptr;
  map.voxel_m_ = settings.voxel_m;
  map.band_m_ = Voxeliser::bandOf(settings);
  map.bounds_ = bounds(mesh);
  Mesh shared = welded(mesh);  // signs need shared vertices
  requireUsable(shared, "", part);
  RepairedMesh repaired = repairMesh(std::move(shared));
  if (repaired.is_sound) {
    Voxeliser voxeliser(repaired.surface, settings, nullptr);
    map.layout_ = voxeliser.build(progress);
    if (!voxeliser.areSignsSound()) {
      map.layout_ = nullptr;
      repaired = repairMesh(welded(mesh), Crossing::Seen);
    }
  }
  if (map.layout_ == nullptr) {
    WindingSigner signer(repaired.solid);
    map.layout_ = Voxeliser(repaired.surface, settings, &signer).build(progress);
    repaired.report.signed_by_winding = true;
    repaired.report.sure = signer.sure();
  }
  if (report != nullptr) *report = repaired.report;
  return map;
}

VoxMap buildVoxMap(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                   const Progress& progress, MeshReport* report) {
  return VoxMapBuilder::build(mesh, settings, part, progress, report);
}

}  // namespace vps
