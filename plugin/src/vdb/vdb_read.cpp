// SPDX-License-Identifier: BSD-3-Clause
// Reads a voxmap from a .vdb file.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <new>

#include "vdb/vdb_grids.h"
#include "voxmap/field_bounds.h"
#include "voxmap/voxmap_access.h"
#include "vps/errors.h"
#include "vps/vdb.h"

namespace vps {
namespace {

[[noreturn]] void refuseDamaged(const std::string& file) {
  refuseVdb(file, "the file is damaged or cut short; build it again");
}

std::string bytesOf(const std::string& file) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  if (!unknown && static_cast<double>(size) > kMemoryLimit_bytes)
    refuseVdb(file, "the file is larger than 4 GiB, the limit; resample it with larger voxels");
  std::ifstream in(file, std::ios::binary);
  if (!in) refuseVdb(file, "the file cannot be read; check its name");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads an unchanged file of saveVdb().
class OwnFile {
 public:
  OwnFile(const std::string& file, VdbArchive& archive) : file_(file) {
    for (std::size_t i = 0; i < archive.entries().size(); ++i)
      grids_[archive.entries()[i].name()] = archive.read(i);
  }

  VoxMap read() {
    surface_ = gridOf<openvdb::FloatGrid>(kSurface);
    readLayout();
    const double voxel_m = surface_->voxelSize().x();
    const double band_m = valueOf<double>("vps_band");
    if (!(voxel_m > 0) || !(band_m > 0)) refuseDamaged(file_);
    readNodes(surface_->tree(), quantumOf(band_m), file_, *layout_);
    readCenters();
    readParts();
    markFarCells(*layout_);
    return VoxMapAccess::make(layout_, voxel_m, band_m, boxOf("vps_bounds_"));
  }

 private:
  template <typename Grid>
  typename Grid::Ptr gridOf(const char* name) {
    const auto found = grids_.find(name);
    const auto grid = found == grids_.end() ? nullptr : openvdb::gridPtrCast<Grid>(found->second);
    if (grid == nullptr) refuseDamaged(file_);
    return grid;
  }
  template <typename T>
  T valueOf(const std::string& name) {
    const auto stored = surface_->getMetadata<openvdb::TypedMetadata<T>>(name);
    if (!stored) refuseDamaged(file_);
    return stored->value();
  }
  Box boxOf(const std::string& name) {
    return {fromVdb(valueOf<openvdb::Vec3d>(name + "min")), fromVdb(valueOf<openvdb::Vec3d>(name + "max"))};
  }

  void readLayout() {
    layout_->low = fromVdb(valueOf<openvdb::Vec3i>("vps_low"));
    layout_->size = fromVdb(valueOf<openvdb::Vec3i>("vps_size"));
    layout_->steepest = valueOf<float>("vps_steepest");
    layout_->node_error = valueOf<float>("vps_node_error");
    layout_->is_metric = valueOf<bool>("vps_is_metric");
  }

  void readCenters() {
    const auto centers = gridOf<openvdb::FloatGrid>(kCenter);
    auto accessor = centers->getConstAccessor();
    for (std::size_t i = 0; i < layout_->bricks.size(); ++i)
      layout_->centers_m[i] = accessor.getValue(toCoord(layout_->cellAt(i)));
  }

  void readParts() {
    const int count = valueOf<std::int32_t>("vps_parts");
    if (count < 1 || count > std::numeric_limits<std::uint16_t>::max()) refuseDamaged(file_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      layout_->parts.push_back({boxOf(partKey(i, "")), fromVdb(valueOf<openvdb::Vec3i>(partKey(i, "low"))),
                                fromVdb(valueOf<openvdb::Vec3i>(partKey(i, "high")))});
    if (count > 1) readOwners(*gridOf<openvdb::Int32Grid>(kOwner), count);
  }

  void readOwners(const openvdb::Int32Grid& grid, int parts) {
    auto mixed = std::make_shared<std::vector<NodeOwners>>();
    mixed->reserve(layout_->pool->size());  // never reallocated, since bricks point into it
    auto accessor = grid.getConstAccessor();
    NodeOwners nodes;
    for (std::size_t i = 0; i < layout_->bricks.size(); ++i) {
      const std::uint32_t brick = layout_->bricks[i];
      if (isConstant(brick)) continue;
      for (int n = 0; n < kBrickNodes; ++n) {
        const int owner = accessor.getValue(toCoord(kBrick * layout_->cellAt(i) + nodeAt(n)));
        if (owner < 0 || owner >= parts) refuseDamaged(file_);
        nodes[n] = static_cast<std::uint16_t>(owner);
      }
      layout_->pool->owner(brick) = nodes[0];
      if (std::all_of(nodes.begin(), nodes.end(), [&](std::uint16_t o) { return o == nodes[0]; })) continue;
      layout_->pool->mixed(brick) = &mixed->emplace_back(nodes);
    }
    layout_->owners = {mixed};
  }

  const std::string& file_;
  std::map<std::string, openvdb::GridBase::Ptr> grids_;
  openvdb::FloatGrid::Ptr surface_;
  std::shared_ptr<VoxLayout> layout_ = std::make_shared<VoxLayout>();
};

PlacedVdb readOthers(const std::string& file, VdbArchive& archive, const std::string& name) {
  const LevelSet level_set = levelSetOf(archive, file, name);
  const double quantum_m = quantumOf(level_set.band_m);
  const auto layout = std::make_shared<VoxLayout>();
  layOut(level_set.grid->tree(), quantum_m, file, *layout);
  readNodes(level_set.grid->tree(), quantum_m, file, *layout);
  const Box bounds = proveField(*layout, level_set.voxel_m, quantum_m);
  if (bounds.isEmpty())
    refuseVdb(file, "the file has no surface: its values change sign nowhere; export it again");
  markFarCells(*layout);
  return {VoxMapAccess::make(layout, level_set.voxel_m, level_set.band_m, bounds), level_set.X_FM};
}

PlacedVdb read(const std::string& file, const std::string& name) {
  try {
    std::string bytes = bytesOf(file);
    const Origin origin = originOf(bytes);
    if (origin == Origin::Changed)
      refuseVdb(file,
                "the file is damaged or cut short, or another program changed it and kept our metadata "
                "'vps_...'; build the file again, or remove these metadata");
    VdbArchive archive(std::move(bytes), kMemoryLimit_bytes);
    if (origin == Origin::Ours) return {OwnFile(file, archive).read(), Pose()};
    return readOthers(file, archive, name);
  } catch (const LoadError&) {
    throw;
  } catch (const openvdb::LookupError&) {
    refuseVdb(
        file,
        "the file holds a grid of a type that is not known here; export the level set alone, as floats");
  } catch (const std::bad_alloc&) {
    refuseVdb(file,
              "the file needs more memory than is free; resample it with larger voxels, or, if the file is "
              "small, export "
              "it again: it is damaged");
  } catch (const std::exception&) {
    refuseVdb(file, "the file is not a whole OpenVDB file; build it again");
  }
}

}  // namespace

PlacedVdb loadPlacedVdb(const std::string& file, const std::string& grid) {
  initializeOpenVdb();
  return read(file, grid);
}

VoxMap loadVdb(const std::string& file, const std::string& grid) {
  const PlacedVdb placed = loadPlacedVdb(file, grid);
  if (placed.X_FM.R.isIdentity(0) && placed.X_FM.p.isZero(0)) return placed.map;
  const VoxMap& map = placed.map;
  // Not resampledVoxMap(), which would refuse a band that is 3 voxels up to the rounding of floats.
  const VoxMapSettings settings = {map.voxel_m(), map.band_m() / map.voxel_m()};
  return mountVoxMap(VoxMapAccess::empty(settings), PlacedMap{&map, placed.X_FM});
}

}  // namespace vps
