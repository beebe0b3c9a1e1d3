// SPDX-License-Identifier: BSD-3-Clause
// Writes a voxmap to a .vdb file.
#include <openvdb/io/Stream.h>

#include <cmath>
#include <sstream>

#include "vdb/vdb_format.h"
#include "voxmap/voxmap_access.h"
#include "vps/errors.h"
#include "vps/vdb.h"
#include "vps/write_file.h"

namespace vps {
namespace {

constexpr int kOwnNodes = kBrick * kBrick * kBrick;

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
    // A leaf stores its nodes in the same order as a brick. Values beyond the band are inactive and have the
    // right sign.
    auto* leaf = tree.touchLeaf(origin);
    const NodeValue* nodes = layout.nodesOf(i);
    for (int n = 0; n < kOwnNodes; ++n) {
      const NodeValue node = nodes[nodeIndex(n / (kBrick * kBrick), n / kBrick % kBrick, n % kBrick)];
      const auto d = static_cast<float>(quantum_m * node);
      if (std::abs(node) < kFullBand)
        leaf->setValueOn(static_cast<openvdb::Index>(n), d);
      else
        leaf->setValueOff(static_cast<openvdb::Index>(n), d);
    }
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
  // Stores every node of a brick, including its border, because the neighbour that owns a border node may
  // have no brick in which to store it.
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

/// Data that, in addition to the nodes, a reload needs for the same bits.
void addExactData(const VoxLayout& layout, double band_m, const Box& bounds, openvdb::MetaMap& out) {
  out.insertMeta("vps_band", openvdb::DoubleMetadata(band_m));
  out.insertMeta("vps_low", openvdb::Vec3IMetadata(toVdb(layout.low)));
  out.insertMeta("vps_size", openvdb::Vec3IMetadata(toVdb(layout.size)));
  out.insertMeta("vps_steepest", openvdb::FloatMetadata(layout.steepest));
  out.insertMeta("vps_node_error", openvdb::FloatMetadata(layout.node_error));
  out.insertMeta("vps_is_metric", openvdb::BoolMetadata(layout.is_metric));
  out.insertMeta("vps_bounds_min", openvdb::Vec3DMetadata(toVdb(bounds.min)));
  out.insertMeta("vps_bounds_max", openvdb::Vec3DMetadata(toVdb(bounds.max)));
  out.insertMeta("vps_parts", openvdb::Int32Metadata(static_cast<int>(layout.parts.size())));
  for (std::size_t i = 0; i < layout.parts.size(); ++i) {
    const VoxPartRange& part = layout.parts[i];
    out.insertMeta(partKey(i, "min"), openvdb::Vec3DMetadata(toVdb(part.bounds.min)));
    out.insertMeta(partKey(i, "max"), openvdb::Vec3DMetadata(toVdb(part.bounds.max)));
    out.insertMeta(partKey(i, "low"), openvdb::Vec3IMetadata(toVdb(part.low)));
    out.insertMeta(partKey(i, "high"), openvdb::Vec3IMetadata(toVdb(part.high)));
  }
}

void writeGrids(const openvdb::GridPtrVec& grids, const std::string& file) {
  std::string bytes;
  try {
    std::ostringstream stream;
    openvdb::io::Stream(stream).write(grids);
    bytes = std::move(stream).str();
    bytes += endOf(bytes);
  } catch (const std::exception&) {
    throw LoadError(file, "", "the file could not be written; is there enough memory?");
  }
  writeWholeFile(file, bytes);
}

}  // namespace

void saveVdb(const VoxMap& map, const std::string& file) {
  const VoxLayout& layout = *VoxMapAccess::layout(map);
  if (layout.bricks.empty())
    throw LoadError(file, "",
                    "the file was not written, because the voxmap is empty; build the voxmap first");
  initializeOpenVdb();
  const auto surface = surfaceGrid(layout, map.voxel_m(), map.band_m(), map.quantum_m());
  addExactData(layout, map.band_m(), map.bounds(), *surface);
  openvdb::GridPtrVec grids = {surface, centerGrid(layout, map.voxel_m())};
  if (layout.parts.size() > 1) grids.push_back(ownerGrid(layout, map.voxel_m()));
  writeGrids(grids, file);
}

}  // namespace vps
