// SPDX-License-Identifier: BSD-3-Clause
// Builds a voxmap from a mesh: the exact distance at every node within the band.
//
// 1. Features: faces, edges and vertices with their neighbours (surface_features.h).
// 2. Gather: the tiles of 32^3 nodes that each feature can reach, then the features of each tile.
// 3. Splat: tile by tile, each feature writes to the nodes to which it may be nearest (splat.h). Bricks are
// cut from the tile while it is in the cache.
// 4. Bricks: the neighbours' border, a sign for the nodes beyond the band (brick_assembly.h), and a bound of
// the distance at every cell's centre (field_bounds.h).
//
// Parallel over features, tiles and rows; each result has one writer and a fixed order, so that every number
// of threads gives the same bits.

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "voxelise/brick_assembly.h"
#include "voxelise/splat.h"
#include "voxelise/winding_signs.h"
#include "voxmap/field_bounds.h"
#include "voxmap/map_limits.h"
#include "voxmap/voxmap_access.h"
#include "vps/mesh_repair.h"
#include "vps/solid.h"
#include "vps/stoppable.h"

namespace vps {

namespace {

constexpr int kTileBricks = kTile / kBrick;

/// A feature and a tile that it reaches.
struct Reached {
  std::uint32_t tile, feature;
};

/// A brick to be cut from a tile: its first node in the tile, and its cell.
struct CutBrick {
  Index3 node;
  std::size_t cell;
};

/// d == kFar, compared by bits, because compilers do not vectorise comparisons of floats by default.
bool isFar(float d) {
  return std::bit_cast<std::uint32_t>(d) == std::bit_cast<std::uint32_t>(kFar);
}

class Voxeliser {
 public:
  /// @param signer   signs nodes by winding number; null: pseudonormals decide
  Voxeliser(const Mesh& mesh, const Box& box, const VoxMapSettings& settings, WindingSigner* signer)
      : mesh_(mesh),
        box_(box),
        h_(settings.voxel_m),
        band_m_(bandHeld(settings.band_voxels * settings.voxel_m)),
        // Distances that round to the full band need not be computed.
        reach_((kFullBand - 0.5) * quantumOf(band_m_) / h_),
        signer_(signer) {}

  std::shared_ptr<VoxLayout> build(const Progress& progress);
  /// False if pseudonormals contradict each other.
  [[nodiscard]] bool areSignsConsistent() const { return are_signs_consistent_; }

 private:
  void layOutDirectory();
  void gather(const SurfaceFeatures& features);
  void gatherFeature(Splatter& splatter, std::uint32_t feature, std::vector<Reached>& out) const;
  void gatherRange(const Splatter& splatter, std::uint32_t feature, const Index3& low, const Index3& size,
                   std::vector<Reached>& out) const;
  void splatTiles(const SurfaceFeatures& features);
  void splatTile(Splatter& splatter, std::size_t at, Tile& tile) const;
  [[nodiscard]] std::vector<CutBrick> bricksOf(const Tile& tile, const Index3& low) const;
  void cutBrick(const Tile& tile, const CutBrick& brick, std::size_t slot, BrickWriter& writer);
  void boundCenters();

  [[nodiscard]] Index3 tiles() const { return (layout_->size.array() + kTileBricks - 1) / kTileBricks; }
  [[nodiscard]] std::uint32_t tileNumber(const Index3& tile) const {
    return static_cast<std::uint32_t>((tile.x() * tiles().y() + tile.y()) * tiles().z() + tile.z());
  }

  [[nodiscard]] Index3 tileAt(std::size_t number) const {
    const Index3 size = tiles();
    const int i = static_cast<int>(number);
    return {i / (size.y() * size.z()), i / size.z() % size.y(), i % size.z()};
  }

  const Mesh& mesh_;
  const Box box_;
  const double h_, band_m_;
  const double reach_;  // greatest distance that is computed [voxels]
  WindingSigner* const signer_;
  bool are_signs_consistent_ = true;
  std::shared_ptr<VoxLayout> layout_ = std::make_shared<VoxLayout>();
  std::vector<std::size_t> first_;       // start of each tile's features, and one more entry for the end
  std::vector<std::uint32_t> features_;  // by tile, ascending within each
  std::vector<std::int32_t> brick_of_;   // by cell; -1: none
  std::vector<SurfaceBits> surface_;     // by brick
};

void Voxeliser::layOutDirectory() {
  const double cell_m = kBrick * h_;
  // One cell more than the band on each side: normals read the neighbouring cell, and bounds get a margin.
  const Vec3 low = ((box_.min.array() - band_m_) / cell_m).floor() - 1;
  const Vec3 high = ((box_.max.array() + band_m_) / cell_m).floor() + 2;
  layout_->low = low.cast<int>();
  layout_->size = (high - low).cast<int>();
  layout_->resizeCells();
  layout_->parts = {{box_, layout_->low, layout_->low + layout_->size}};
}

/// Halves the range of tiles until one is left, and drops halves that the feature cannot reach. The cost of a
/// large oblique triangle is proportional to its surface, not to its box.
void Voxeliser::gatherRange(const Splatter& splatter, std::uint32_t feature, const Index3& low,
                            const Index3& size, std::vector<Reached>& out) const {
  const Vec3 half = 0.5 * kTile * size.cast<double>();
  if (!splatter.reaches(feature, kTile * low.cast<double>() + half, half.norm())) return;
  int axis = 0;
  if (size.maxCoeff(&axis) == 1) {
    out.push_back({tileNumber(low), feature});
    return;
  }
  Index3 near = size, far = size, middle = low;
  near[axis] = size[axis] / 2;
  far[axis] = size[axis] - near[axis];
  middle[axis] += near[axis];
  gatherRange(splatter, feature, low, near, out);
  gatherRange(splatter, feature, middle, far, out);
}

void Voxeliser::gatherFeature(Splatter& splatter, std::uint32_t feature, std::vector<Reached>& out) const {
  const Box box = splatter.reach(feature);
  if (box.isEmpty()) return;
  // A tile's last nodes are the next tile's first nodes.
  const Index3 low = ((box.min.array() - (kTile + 1e-6)) / kTile).ceil().max(0).cast<int>();
  const Index3 high = (box.max / kTile).cast<int>();
  const Index3 size = high - low + Index3::Ones();
  if (size.maxCoeff() > 2) return gatherRange(splatter, feature, low, size, out);
  // For few tiles it is faster to take all of them than to test them.
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) out.push_back({tileNumber({x, y, z}), feature});
}

void Voxeliser::gather(const SurfaceFeatures& features) {
  constexpr std::size_t kGrain = 4096;
  const std::size_t count = Splatter(features, reach_).count();
  std::vector<std::vector<Reached>> reached((count + kGrain - 1) / kGrain);
  onAllCores(reached.size(), [&](std::size_t chunk) {
    Splatter splatter(features, reach_);
    for (std::size_t i = chunk * kGrain; i < std::min(count, (chunk + 1) * kGrain); ++i)
      pollStop(), gatherFeature(splatter, static_cast<std::uint32_t>(i), reached[chunk]);
  });

  // Counting sort by tile.
  first_.assign(static_cast<std::size_t>(tiles().prod()) + 2, 0);
  for (const auto& chunk : reached)
    for (const Reached& r : chunk) ++first_[r.tile + 2];
  for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
  features_.resize(first_.back());
  for (const auto& chunk : reached)
    for (const Reached& r : chunk) features_[first_[r.tile + 1]++] = r.feature;
  first_.pop_back();
}

void Voxeliser::splatTile(Splatter& splatter, std::size_t at, Tile& tile) const {
  tile.fill(kFar);
  const Vec3 origin = kTile * tileAt(at).cast<double>();
  StridedPoll poll;
  for (std::size_t k = first_[at]; k < first_[at + 1]; ++k)
    poll(), splatter.splat(features_[k], origin, tile.data());
}

/// The bricks of a tile that have a node within the band.
std::vector<CutBrick> Voxeliser::bricksOf(const Tile& tile, const Index3& low) const {
  // Bit b of a row along z: brick b has a known node in the row. A brick's last node is the next brick's
  // first.
  std::array<std::uint8_t, std::size_t{kTileNodes}* kTileNodes> rows = {};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const float* d = &tile[row * kTileNodes];
    for (int b = 0; b < kTileBricks; ++b) {
      int known = 0;
      for (int z = 0; z < kNodes; ++z) known |= isFar(d[kBrick * b + z]) ? 0 : 1;
      rows[row] |= static_cast<std::uint8_t>(known << b);
    }
  }
  std::vector<CutBrick> bricks;
  for (int x = 0; x < kTileBricks; ++x)
    for (int y = 0; y < kTileBricks; ++y) {
      unsigned known = 0;
      for (int i = 0; i < kNodes * kNodes; ++i)
        known |=
            rows[static_cast<std::size_t>((kBrick * x + i / kNodes) * kTileNodes + kBrick * y + i % kNodes)];
      for (int z = 0; z < kTileBricks; ++z) {
        const Index3 at(x, y, z);
        if ((known >> z & 1) == 0 || ((low + at).array() >= layout_->size.array()).any()) continue;
        const std::size_t cell = layout_->cellIndex(layout_->low + low + at);
        bricks.push_back({kBrick * at, cell});
      }
    }
  return bricks;
}

/// Bits of a row along z in a brick; bit z: the node is so near the surface that it may be the nearest node
/// of a surface point.
std::uint8_t nearBits(const float* row) {
  constexpr auto kNearBits = std::bit_cast<std::uint32_t>(static_cast<float>(SurfaceBits::kNear));
  unsigned bits = 0;
  // Without their sign, floats have the same order as their bits.
  for (unsigned z = 0; z < kBrick; ++z)
    bits |= (std::bit_cast<std::uint32_t>(row[z]) & 0x7FFFFFFFU) <= kNearBits ? 1U << z : 0U;
  return static_cast<std::uint8_t>(bits);
}

/// Copies a brick from its tile and records the nodes near the surface.
void Voxeliser::cutBrick(const Tile& tile, const CutBrick& brick, std::size_t slot, BrickWriter& writer) {
  BrickNodes distance;
  SurfaceBits& surface = surface_[static_cast<std::size_t>(brick_of_[brick.cell])];
  for (int x = 0; x < kNodes; ++x)
    for (int y = 0; y < kNodes; ++y) {
      const float* from = &tile[tileIndex(brick.node.x() + x, brick.node.y() + y, brick.node.z())];
      std::copy_n(from, kNodes, &distance[nodeIndex(x, y, 0)]);
      if (x < kBrick && y < kBrick)
        surface.rows[static_cast<std::size_t>(x / 2 * 4 + y / 2)] |= nearBits(from);
    }
  layout_->bricks[brick.cell] = writer.write(slot, distance);
}

/// Processes a batch of tiles at a time in the same memory, because the first access to new pages for all
/// tiles would cost more than the computation.
void Voxeliser::splatTiles(const SurfaceFeatures& features) {
  constexpr std::size_t kBatch = 16;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i + 1 < first_.size(); ++i)
    if (first_[i] < first_[i + 1]) wanted.push_back(i);
  brick_of_.assign(layout_->bricks.size(), -1);
  // A surface through a tile takes about a third of its bricks.
  constexpr std::size_t kExpected = kTileBricks * kTileBricks * kTileBricks / 2;
  BrickWriter writer(*layout_, h_ / quantumOf(band_m_),
                     std::min(kExpected * wanted.size(), brick_of_.size()));
  std::vector<Tile> tiles(std::min(kBatch, wanted.size()));
  std::vector<std::vector<CutBrick>> bricks(tiles.size());
  std::vector<std::size_t> slot(tiles.size());
  tbb::enumerable_thread_specific<Splatter> splatters([&] { return Splatter(features, reach_); });
  for (std::size_t begin = 0; begin < wanted.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, wanted.size() - begin);
    onAllCores(count, [&](std::size_t i) {
      splatTile(splatters.local(), wanted[begin + i], tiles[i]);
      bricks[i] = bricksOf(tiles[i], kTileBricks * tileAt(wanted[begin + i]));
    });
    std::size_t taken = 0;
    for (std::size_t i = 0; i < count; ++i) {
      slot[i] = taken;
      for (const CutBrick& brick : bricks[i])
        brick_of_[brick.cell] = static_cast<std::int32_t>(surface_.size() + taken++);
    }
    if (taken == 0) continue;
    writer.take(taken);
    surface_.resize(surface_.size() + taken);
    onAllCores(count, [&](std::size_t i) {
      for (std::size_t k = 0; k < bricks[i].size(); ++k)
        cutBrick(tiles[i], bricks[i][k], slot[i] + k, writer);
    });
  }
}

void Voxeliser::boundCenters() {
  const std::vector<float> bound = boundCellCenters(layout_->size, brick_of_, surface_);
  const double quantum_m = quantumOf(band_m_);
  tbb::parallel_for(std::size_t{0}, bound.size(), [&](std::size_t i) {  // too short to poll in each round
    constexpr int kCenter = kBrick / 2;
    const int center = layout_->nodesOf(i)[nodeIndex(kCenter, kCenter, kCenter)];
    // Within the band the distance is known, up to rounding; beyond, it is at least nearly the band.
    const double known_m = std::max(0.0, (std::abs(center) - 0.51) * quantum_m);
    const double least_m = std::abs(center) < kFullBand ? known_m : std::max(known_m, bound[i] * h_);
    layout_->centers_m[i] = static_cast<float>(center < 0 ? -least_m : least_m);
  });
}

std::shared_ptr<VoxLayout> Voxeliser::build(const Progress& progress) {
  StoppableWork work(progress);
  const auto report = [&](double share) { work.report("voxelising", share); };
  report(0);
  layOutDirectory();
  {
    const SurfaceFeatures features(mesh_, h_, kBrick * layout_->low.cast<double>());
    report(0.1);
    gather(features);
    report(0.3);
    splatTiles(features);
  }
  report(0.8);
  if (signer_ != nullptr)
    signer_->signBricks(*layout_, h_, quantumOf(band_m_));
  else
    are_signs_consistent_ = signsAgree(*layout_, h_, quantumOf(band_m_));
  fillEmptyCells(*layout_);
  if (signer_ != nullptr) signer_->signEmptyCells(*layout_, h_, quantumOf(band_m_));
  markFarCells(*layout_);
  report(0.9);
  boundCenters();
  report(1);
  return layout_;
}

/// The map of a repaired surface; nothing if its pseudonormals contradict each other.
/// @param interior  null: signs come from pseudonormals
/// @param report    receives the share of certain signs
std::optional<VoxMap> voxelised(const Mesh& surface, const Interior* interior, const Box& box,
                                const VoxMapSettings& settings, const Progress& progress,
                                MeshReport& report) {
  std::optional<WindingSigner> signer;
  if (interior != nullptr) signer.emplace(*interior);
  Voxeliser voxeliser(surface, box, settings, signer ? &*signer : nullptr);
  std::shared_ptr<const VoxLayout> layout = voxeliser.build(progress);
  if (!voxeliser.areSignsConsistent()) return std::nullopt;
  if (signer) {
    report.signed_by_winding = true;
    report.certain_share = signer->certainShare();
  }
  return VoxMapAccess::make(layout, settings.voxel_m, settings.band_voxels * settings.voxel_m, box);
}

/// voxelised() for a mesh whose interior is decided by winding numbers.
VoxMap voxelised(RepairedMesh repaired, const Box& box, const VoxMapSettings& settings,
                 const Progress& progress, MeshReport* report) {
  const Interior interior(std::move(repaired.solid), bounds(repaired.surface));
  const std::optional<VoxMap> map =
      voxelised(repaired.surface, &interior, box, settings, progress, repaired.report);
  if (report != nullptr) *report = repaired.report;
  return *map;
}

/// A surface with its interior; the interior is null if pseudonormals decide.
struct Body {
  const Mesh& surface;
  const Interior* interior;
  MeshReport report;
};

VoxMap voxelised(Body body, const Box& box, const VoxMapSettings& settings, const Progress& progress,
                 MeshReport* report) {
  const std::optional<VoxMap> map =
      voxelised(body.surface, body.interior, box, settings, progress, body.report);
  if (!map) {  // the surface crosses itself
    const RepairedMesh sound{{}, body.surface, body.report, true};
    return voxelised(repairCrossing(sound), box, settings, progress, report);
  }
  if (report != nullptr) *report = body.report;
  return *map;
}

}  // namespace

VoxMap buildVoxMap(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                   const Progress& progress, MeshReport* report) {
  requireUsable(mesh, "", part);
  requireFits(mesh, settings, part);
  const StoppableWork work(progress, "repairing the mesh");
  Mesh shared = welded(mesh);  // signs need shared vertices
  requireUsable(shared, "", part);
  RepairedMesh repaired = repairMesh(std::move(shared));
  const Box box = bounds(mesh);
  if (repaired.is_sound)
    return voxelised({repaired.surface, nullptr, repaired.report}, box, settings, progress, report);
  return voxelised(std::move(repaired), box, settings, progress, report);
}

VoxMap buildVoxMap(const PlacedSolid& part, const VoxMapSettings& settings, const std::string& name,
                   const Progress& progress, MeshReport* report) {
  const StoppableWork work(progress, "voxelising");
  const Solid& solid = *part.solid;
  const Interior* interior = solid.interior();
  if (part.X_MP.R.isIdentity(0) && part.X_MP.p.isZero(0)) {
    requireFits(solid.mesh(), settings, name);
    return voxelised({solid.mesh(), interior, solid.report()}, bounds(solid.mesh()), settings, progress,
                     report);
  }
  const Mesh surface = transformed(solid.mesh(), part.X_MP);
  requireUsable(surface, "", name);  // coordinates may overflow
  requireFits(surface, settings, name);
  std::optional<Interior> placed;
  if (interior != nullptr) placed.emplace(transformed(interior->mesh(), part.X_MP), bounds(surface));
  return voxelised({surface, placed ? &*placed : nullptr, solid.report()}, bounds(surface), settings,
                   progress, report);
}

VoxMap buildVoxMap(const Solid& solid, const VoxMapSettings& settings, const std::string& part,
                   const Progress& progress, MeshReport* report) {
  return buildVoxMap(PlacedSolid{&solid, Pose()}, settings, part, progress, report);
}

}  // namespace vps
