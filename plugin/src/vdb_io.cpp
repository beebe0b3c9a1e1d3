// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps on disk, as OpenVDB level sets. The only file that includes OpenVDB: its headers are slow to
// compile.
//
// A file of ours holds the grid "surface", which other programs read, and two more that make a reload exact:
// "vps_center" (one value a directory cell: the bound at its centre) and, where parts are merged,
// "vps_owner". Files of others have the first alone; bounds are then derived from where its bricks lie.
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <sstream>
#include <string_view>

#include "brick_assembly.h"
#include "voxelise.h"
#include "vps/load_error.h"

namespace vps {
namespace {

constexpr int kBrick = VoxMap::kBrick;
constexpr const char* kSurface = "surface";
constexpr const char* kCenter = "vps_center";
constexpr const char* kOwner = "vps_owner";
/// The largest directory that is read: 4 GiB. More can only be a damaged file.
constexpr double kMostCells = 4.0 * 1024 * 1024 * 1024 / (sizeof(std::uint32_t) + sizeof(float));

void initializeOpenVdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

openvdb::Coord toCoord(const Index3& i) {
  return {i.x(), i.y(), i.z()};
}
openvdb::Vec3d toVdb(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
openvdb::Vec3i toVdb(const Index3& v) {
  return {v.x(), v.y(), v.z()};
}
Vec3 fromVdb(const openvdb::Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}
Index3 fromVdb(const openvdb::Vec3i& v) {
  return {v.x(), v.y(), v.z()};
}
Index3 fromCoord(const openvdb::Coord& c) {
  return {c.x(), c.y(), c.z()};
}

std::string partKey(std::size_t part, const char* what) {
  return "vps_part" + std::to_string(part) + "_" + what;
}

/// The end of a file of ours: a mark and the sum of all bytes before it. OpenVDB reads past neither, and its
/// reader trusts what it reads: a wrong byte can make it write where it must not, so we look first.
constexpr std::string_view kMark = "vps-end1";
constexpr std::size_t kEndBytes = kMark.size() + sizeof(std::uint64_t);

/// FNV-1a, 64 bit.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return sum;
}

std::string endOf(std::string_view bytes) {
  std::string end(kMark);
  const std::uint64_t sum = checksum(bytes);
  for (int i = 0; i < 8; ++i) end.push_back(static_cast<char>(sum >> 8 * i & 0xff));
  return end;
}

/// False for a file of ours that is not as it was written. Others' files end as they like.
bool isWhole(std::string_view bytes) {
  if (bytes.find("vps_parts") == std::string_view::npos && bytes.find(kMark) == std::string_view::npos)
    return true;
  return bytes.size() > kEndBytes &&
         bytes.substr(bytes.size() - kEndBytes) == endOf(bytes.substr(0, bytes.size() - kEndBytes));
}

template <typename Visit>
void forEachOwnNode(Visit visit) {
  for (int x = 0; x < kBrick; ++x)
    for (int y = 0; y < kBrick; ++y)
      for (int z = 0; z < kBrick; ++z) visit(ownIndex(x, y, z), nodeIndex(x, y, z));
}

// Writing
// -------------------------------------------------------------------------------------------------------------

openvdb::FloatGrid::Ptr surfaceGrid(const VoxLayout& layout, double voxel_m, double band_m,
                                    double quantum_m) {
  const auto grid = openvdb::FloatGrid::create(static_cast<float>(band_m));
  grid->setName(kSurface);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_m));
  openvdb::FloatTree& tree = grid->tree();
  for (std::size_t i = 0; i < layout.bricks.size(); ++i) {
    const std::uint32_t brick = layout.bricks[i];
    const openvdb::Coord origin = toCoord(kBrick * layout.cellAt(i));
    if (brick == kOutside) continue;  // the background
    if (brick == kInside) {
      tree.addTile(1, origin, static_cast<float>(-band_m), false);
      continue;
    }
    // A leaf has the order of our own nodes. Values beyond the band are inactive, of the right sign.
    auto* leaf = tree.touchLeaf(origin);
    const NodeValue* nodes = layout.nodesOf(i);
    forEachOwnNode([&](int own, int node) {
      const auto d = static_cast<float>(quantum_m * nodes[node]);
      if (std::abs(nodes[node]) < kFullBand)
        leaf->setValueOn(static_cast<openvdb::Index>(own), d);
      else
        leaf->setValueOff(static_cast<openvdb::Index>(own), d);
    });
  }
  tree.prune();
  return grid;
}

openvdb::FloatGrid::Ptr centerGrid(const VoxLayout& layout, double voxel_m) {
  const auto grid = openvdb::FloatGrid::create(0);
  grid->setName(kCenter);
  const auto transform = openvdb::math::Transform::createLinearTransform(kBrick * voxel_m);
  transform->postTranslate(openvdb::Vec3d(kBrick / 2 * voxel_m));
  grid->setTransform(transform);
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < layout.bricks.size(); ++i)
    accessor.setValue(toCoord(layout.cellAt(i)), layout.centers_m[i]);
  return grid;
}

openvdb::Int32Grid::Ptr ownerGrid(const VoxLayout& layout, double voxel_m) {
  const auto grid = openvdb::Int32Grid::create(0);
  grid->setName(kOwner);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_m));
  // Every node of a brick, border too: the neighbour that owns a border node may have no brick to keep it in.
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < layout.bricks.size(); ++i) {
    const std::uint32_t brick = layout.bricks[i];
    if (isConstant(brick)) continue;
    for (int x = 0; x < kNodes; ++x)
      for (int y = 0; y < kNodes; ++y)
        for (int z = 0; z < kNodes; ++z) {
          const int node = nodeIndex(x, y, z);
          const int owner = layout.pool->ownerOf(brick, node);
          if (std::abs(layout.nodesOf(i)[node]) < kFullBand && owner != 0)
            accessor.setValue(toCoord(kBrick * layout.cellAt(i) + Index3(x, y, z)), owner);
        }
  }
  return grid;
}

void writeWhole(const openvdb::GridPtrVec& grids, const std::string& file) {
  // Under another name first: whoever reads `file` finds the old one or the new one, never half of it.
  const std::string unfinished = file + ".unfinished";
  try {
    std::ostringstream stream;
    openvdb::io::Stream(stream).write(grids);
    const std::string bytes = stream.str();
    std::ofstream out(unfinished, std::ios::binary);
    if (!out) throw LoadError(file, "", "cannot be written; does its folder exist, and may you write there?");
    out.exceptions(std::ios::failbit | std::ios::badbit);
    out << bytes << endOf(bytes);
    out.close();
    std::filesystem::rename(unfinished, file);
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception&) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw LoadError(file, "", "could not be written whole; is the disk full?");
  }
}

// Reading
// -------------------------------------------------------------------------------------------------------------

[[noreturn]] void refuse(const std::string& file, const std::string& found_and_remedy) {
  throw LoadError(file, "", found_and_remedy);
}
[[noreturn]] void refuseDamaged(const std::string& file) {
  refuse(file, "is damaged or cut short; build it again");
}

std::map<std::string, openvdb::GridBase::Ptr> readGrids(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, "cannot be read; is the name right?");
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!isWhole(bytes)) refuseDamaged(file);
  try {
    std::istringstream stream(bytes);
    // OpenVDB does not look whether a read came short; the stream itself says so.
    stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    std::map<std::string, openvdb::GridBase::Ptr> grids;
    const openvdb::GridPtrVecPtr stored = openvdb::io::Stream(stream, false).getGrids();
    for (const auto& grid : *stored) grids.emplace(grid->getName(), grid);
    return grids;
  } catch (const std::exception&) {
    refuse(file, "is not a whole OpenVDB file; build it again");
  }
}

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)), grids_(readGrids(file_)) {}

  void read() {
    findSurface();
    findTransform();
    findRange();
    readNodes();
    assembleBricks(*layout_, blocks_, band_m_);
    if (is_ours_)
      readExact();
    else
      deriveBounds();
  }

  double voxel_m_ = 0, band_m_ = 0;
  Box bounds_;
  std::shared_ptr<VoxLayout> layout_ = std::make_shared<VoxLayout>();

 private:
  using Leaf = openvdb::FloatTree::LeafNodeType;

  void findSurface() {
    const auto named = grids_.find(kSurface);
    if (named != grids_.end()) surface_ = openvdb::gridPtrCast<openvdb::FloatGrid>(named->second);
    for (const auto& [name, grid] : grids_)
      if (surface_ == nullptr && grid->getGridClass() == openvdb::GRID_LEVEL_SET)
        surface_ = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (surface_ == nullptr || surface_->getGridClass() != openvdb::GRID_LEVEL_SET)
      refuse(file_, "holds no level set of floats; convert it to one");
    is_ours_ = surface_->getMetadata<openvdb::Int32Metadata>("vps_parts") != nullptr;
  }

  void findTransform() {
    const auto affine =
        surface_->transform().isLinear() ? surface_->transform().baseMap()->getAffineMap() : nullptr;
    if (affine == nullptr) refuse(file_, "is not on a uniform grid; resample it");
    const openvdb::Mat4R m = affine->getMat4();
    voxel_m_ = m(0, 0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (!(std::abs(m(i, j) - (i == j ? voxel_m_ : 0)) <= 1e-9 * voxel_m_))
          refuse(file_, "has voxels that are turned or not cubes; resample it");
    for (int i = 0; i < 3; ++i)
      if (!(std::abs(m(3, i)) <= 1e-6 * voxel_m_))
        refuse(file_, "has a grid that is moved off the origin; resample it");
    band_m_ = surface_->background();
    // A float does not hold our band exactly; the quantum that it gives may be another.
    if (const auto stored = surface_->getMetadata<openvdb::DoubleMetadata>("vps_band"))
      if (std::abs(stored->value() - band_m_) <= 1e-6 * band_m_) band_m_ = stored->value();
    band_m_ = kFullBand * quantumOf(band_m_);
    if (!(band_m_ >= 2.99 * voxel_m_) || !(band_m_ < 1e3 * voxel_m_))
      refuse(file_, "has a band of " + std::to_string(band_m_ / voxel_m_) + " voxels; 3 or more are needed");
  }

  /// Cells with nodes within the band, and one empty cell around them; for a file of ours as it was.
  void findRange() {
    constexpr int kMost = std::numeric_limits<int>::max() / 4;
    Index3 low = Index3::Constant(kMost), high = Index3::Constant(-kMost);
    for (auto leaf = surface_->tree().cbeginLeaf(); leaf; ++leaf) {
      const Index3 origin = fromCoord(leaf->origin());
      if (origin.cwiseAbs().maxCoeff() > kMost) refuseDamaged(file_);
      low = low.cwiseMin(origin);
      high = high.cwiseMax(origin);
    }
    if (low.x() > high.x()) refuse(file_, "is empty: no value lies within the band; build it again");
    // One more below: nodes on a leaf's low faces are also the border of its neighbour.
    layout_->low = low / kBrick - Index3::Constant(2);  // origins are multiples of 8
    layout_->size = high / kBrick + Index3::Constant(2) - layout_->low;
    if (is_ours_) {
      const auto stored_low = surface_->getMetadata<openvdb::Vec3IMetadata>("vps_low");
      const auto stored_size = surface_->getMetadata<openvdb::Vec3IMetadata>("vps_size");
      if (!stored_low || !stored_size) refuseDamaged(file_);
      const Index3 from = fromVdb(stored_low->value()), size = fromVdb(stored_size->value());
      if (from.cwiseAbs().maxCoeff() > kMost || size.maxCoeff() > kMost) refuseDamaged(file_);
      if (((layout_->low + Index3::Ones()).array() < from.array()).any() ||
          ((layout_->low + layout_->size).array() > (from + size).array()).any())
        refuseDamaged(file_);
      layout_->low = from;
      layout_->size = size;
    }
    if (layout_->size.minCoeff() <= 0 || layout_->size.cast<double>().prod() > kMostCells)
      refuseDamaged(file_);
    layout_->resizeCells();
  }

  void readNodes() {
    std::map<std::size_t, const Leaf*> leaves;  // by directory index; null: only a neighbour's border
    for (auto leaf = surface_->tree().cbeginLeaf(); leaf; ++leaf) {
      const Index3 cell = fromCoord(leaf->origin()) / kBrick;
      leaves[layout_->cellIndex(cell)] = &*leaf;
      for (int part = 1; part < 8; ++part)
        leaves.try_emplace(layout_->cellIndex(cell - Index3(part >> 2, part >> 1 & 1, part & 1)), nullptr);
    }
    const auto band_m = static_cast<float>(band_m_);
    for (const auto& [index, leaf] : leaves) {
      blocks_.cells.push_back(index);
      OwnNodes& nodes = blocks_.nodes.emplace_back();
      nodes.fill(kFar);
      if (leaf == nullptr) continue;
      for (int i = 0; i < kOwnNodes; ++i) {
        const float d = leaf->getValue(static_cast<openvdb::Index>(i));
        if (!(std::abs(d) <= 1.001f * band_m)) refuseDamaged(file_);
        if (std::abs(d) < band_m) nodes[i] = d;
      }
    }
  }

  void readExact() {
    const auto centers =
        grids_.count(kCenter) ? openvdb::gridPtrCast<openvdb::FloatGrid>(grids_[kCenter]) : nullptr;
    const auto low = surface_->getMetadata<openvdb::Vec3DMetadata>("vps_bounds_min");
    const auto high = surface_->getMetadata<openvdb::Vec3DMetadata>("vps_bounds_max");
    if (!centers || !low || !high) refuseDamaged(file_);
    bounds_.min = fromVdb(low->value());
    bounds_.max = fromVdb(high->value());
    auto accessor = centers->getConstAccessor();
    for (std::size_t i = 0; i < layout_->bricks.size(); ++i)
      layout_->centers_m[i] = accessor.getValue(toCoord(layout_->cellAt(i)));
    readParts();
  }

  void readParts() {
    const int count = surface_->getMetadata<openvdb::Int32Metadata>("vps_parts")->value();
    if (count < 1 || count > std::numeric_limits<std::uint16_t>::max()) refuseDamaged(file_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const auto min = surface_->getMetadata<openvdb::Vec3DMetadata>(partKey(i, "min"));
      const auto max = surface_->getMetadata<openvdb::Vec3DMetadata>(partKey(i, "max"));
      const auto low = surface_->getMetadata<openvdb::Vec3IMetadata>(partKey(i, "low"));
      const auto high = surface_->getMetadata<openvdb::Vec3IMetadata>(partKey(i, "high"));
      if (!min || !max || !low || !high) refuseDamaged(file_);
      VoxPartRange& part = layout_->parts.emplace_back();
      part.bounds.min = fromVdb(min->value());
      part.bounds.max = fromVdb(max->value());
      part.low = fromVdb(low->value());
      part.high = fromVdb(high->value());
    }
    const auto owners =
        grids_.count(kOwner) ? openvdb::gridPtrCast<openvdb::Int32Grid>(grids_[kOwner]) : nullptr;
    if (count > 1 && owners == nullptr) refuseDamaged(file_);
    if (owners != nullptr) readOwners(*owners, count);
  }

  void readOwners(const openvdb::Int32Grid& grid, int parts) {
    auto mixed = std::make_shared<std::vector<NodeOwners>>();
    mixed->reserve(layout_->pool->size());  // bricks point into it
    auto accessor = grid.getConstAccessor();
    NodeOwners nodes;
    for (std::size_t i = 0; i < layout_->bricks.size(); ++i) {
      const std::uint32_t brick = layout_->bricks[i];
      if (isConstant(brick)) continue;
      for (int n = 0; n < kBrickNodes; ++n) {
        const Index3 at(n / (kNodes * kNodes), n / kNodes % kNodes, n % kNodes);
        const int owner = accessor.getValue(toCoord(kBrick * layout_->cellAt(i) + at));
        if (owner < 0 || owner >= parts) refuseDamaged(file_);
        nodes[n] = static_cast<std::uint16_t>(owner);
      }
      layout_->pool->owner(brick) = nodes[0];
      if (std::all_of(nodes.begin(), nodes.end(), [&](std::uint16_t o) { return o == nodes[0]; })) continue;
      layout_->pool->mixed(brick) = &mixed->emplace_back(nodes);
    }
    layout_->owners = {mixed};
  }

  /// For files without our own grids: the surface lies within bricks and next to nodes nearer than a voxel.
  void deriveBounds() {
    const double quantum_m = quantumOf(band_m_);
    for (std::size_t i = 0; i < layout_->bricks.size(); ++i) {
      const NodeValue* nodes = layout_->nodesOf(i);
      // The centre is a node; rounded down, it stays a bound.
      const int center = nodes[nodeIndex(kBrick / 2, kBrick / 2, kBrick / 2)];
      layout_->centers_m[i] = static_cast<float>(quantum_m * (center > 0 ? center - 1 : center));
      if (isConstant(layout_->bricks[i])) continue;
      for (int n = 0; n < kBrickNodes; ++n) {
        if (quantum_m * std::abs(nodes[n]) > voxel_m_) continue;
        const Index3 at(n / (kNodes * kNodes), n / kNodes % kNodes, n % kNodes);
        const Vec3 p = voxel_m_ * (kBrick * layout_->cellAt(i) + at).cast<double>();
        bounds_.add(p - Vec3::Constant(voxel_m_));
        bounds_.add(p + Vec3::Constant(voxel_m_));
      }
    }
    if (bounds_.isEmpty()) refuse(file_, "has no surface: no value is near zero; build it again");
    layout_->parts = {{bounds_, layout_->low, layout_->low + layout_->size}};
  }

  const std::string file_;
  std::map<std::string, openvdb::GridBase::Ptr> grids_;
  openvdb::FloatGrid::Ptr surface_;
  bool is_ours_ = false;
  NodeBlocks blocks_;
};

}  // namespace

class VoxMapFile {
 public:
  static void save(const VoxMap& map, const std::string& file) {
    if (map.layout_->bricks.empty()) throw LoadError(file, "", "would be an empty voxmap; build one first");
    const VoxLayout& layout = *map.layout_;
    const auto surface = surfaceGrid(layout, map.voxel_m_, map.band_m_, map.quantum_m_);
    surface->insertMeta("vps_band", openvdb::DoubleMetadata(map.band_m_));
    surface->insertMeta("vps_low", openvdb::Vec3IMetadata(toVdb(layout.low)));
    surface->insertMeta("vps_size", openvdb::Vec3IMetadata(toVdb(layout.size)));
    surface->insertMeta("vps_bounds_min", openvdb::Vec3DMetadata(toVdb(map.bounds_.min)));
    surface->insertMeta("vps_bounds_max", openvdb::Vec3DMetadata(toVdb(map.bounds_.max)));
    surface->insertMeta("vps_parts", openvdb::Int32Metadata(static_cast<int>(layout.parts.size())));
    for (std::size_t i = 0; i < layout.parts.size(); ++i) {
      const VoxPartRange& part = layout.parts[i];
      surface->insertMeta(partKey(i, "min"), openvdb::Vec3DMetadata(toVdb(part.bounds.min)));
      surface->insertMeta(partKey(i, "max"), openvdb::Vec3DMetadata(toVdb(part.bounds.max)));
      surface->insertMeta(partKey(i, "low"), openvdb::Vec3IMetadata(toVdb(part.low)));
      surface->insertMeta(partKey(i, "high"), openvdb::Vec3IMetadata(toVdb(part.high)));
    }
    openvdb::GridPtrVec grids = {surface, centerGrid(layout, map.voxel_m_)};
    if (layout.parts.size() > 1) grids.push_back(ownerGrid(layout, map.voxel_m_));
    writeWhole(grids, file);
  }

  static VoxMap load(const std::string& file) {
    Reader reader(file);
    reader.read();
    VoxMap map;
    map.voxel_m_ = reader.voxel_m_;
    map.band_m_ = reader.band_m_;
    map.quantum_m_ = quantumOf(map.band_m_);
    map.bounds_ = reader.bounds_;
    markFarCells(*reader.layout_);
    map.layout_ = reader.layout_;
    return map;
  }
};

void saveVdb(const VoxMap& map, const std::string& file) {
  initializeOpenVdb();
  VoxMapFile::save(map, file);
}

VoxMap loadVdb(const std::string& file) {
  initializeOpenVdb();
  try {
    return VoxMapFile::load(file);
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception&) {  // out of memory for a size that is nonsense, a type that does not fit
    refuseDamaged(file);
  }
}

}  // namespace vps
