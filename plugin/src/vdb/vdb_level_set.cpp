// SPDX-License-Identifier: BSD-3-Clause
#include "vdb/vdb_grids.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "voxmap/map_limits.h"
#include "vps/errors.h"

namespace vps {
namespace {

using openvdb::DoubleGrid;
using openvdb::FloatGrid;
using Entry = VdbArchive::Entry;

std::string digits(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
}

// Choice of the grid
// -------------------------------------------------------------------------------------------------------------

bool isScalar(const Entry& entry) {
  return entry.grid->isType<FloatGrid>() || entry.grid->isType<DoubleGrid>();
}

std::string namesOf(const std::vector<Entry>& entries) {
  std::string names;
  for (const Entry& entry : entries) names += (names.empty() ? "'" : ", '") + entry.name() + "'";
  return names;
}

/// The reason why a grid cannot be a level set, as far as its type shows; empty if there is no reason.
std::string objection(const Entry& entry) {
  const std::string grid = "grid '" + entry.name() + "' ";
  if (entry.descriptor.gridType().find("ptdataidx") != std::string::npos ||
      entry.descriptor.gridType().find("ptidx") != std::string::npos)
    return grid + "holds points; make a level set of them (Houdini: VDB from Particles)";
  if (!isScalar(entry))
    return grid + "is of type " + entry.grid->valueType() + "; a level set of floats is needed";
  if (entry.grid->getGridClass() == openvdb::GRID_FOG_VOLUME)
    return grid + "is a fog volume; convert it to a level set (Houdini: Convert VDB, to SDF)";
  if (entry.grid->getGridClass() == openvdb::GRID_STAGGERED)
    return grid + "is staggered; a level set of floats is needed";
  return "";
}

/// The only entry of a class, null if there is none. Throws LoadError if there are several.
const Entry* onlyOf(const std::vector<Entry>& entries, openvdb::GridClass wanted, const std::string& file) {
  std::vector<Entry> found;
  for (const Entry& entry : entries)
    if (objection(entry).empty() && entry.grid->getGridClass() == wanted) found.push_back(entry);
  if (found.size() > 1) refuseVdb(file, "the file holds several level sets; name one of " + namesOf(found));
  if (found.empty()) return nullptr;
  return &*std::find_if(entries.begin(), entries.end(),
                        [&](const Entry& entry) { return entry.grid == found.front().grid; });
}

const Entry& choose(const std::vector<Entry>& entries, const std::string& file, const std::string& name) {
  if (entries.empty()) refuseVdb(file, "the file holds no grids; export the part again");
  if (!name.empty()) {
    for (const Entry& entry : entries) {
      if (entry.name() != name) continue;
      if (!objection(entry).empty()) refuseVdb(file, objection(entry));
      return entry;
    }
    refuseVdb(file, "the file holds no grid '" + name + "'; it holds " + namesOf(entries));
  }
  for (const openvdb::GridClass wanted : {openvdb::GRID_LEVEL_SET, openvdb::GRID_UNKNOWN})
    if (const Entry* entry = onlyOf(entries, wanted, file)) return *entry;
  refuseVdb(file, "the file holds no level set: " + objection(entries.front()));
}

FloatGrid::Ptr asFloats(const openvdb::GridBase::Ptr& grid) {
  if (grid->isType<FloatGrid>()) return openvdb::gridPtrCast<FloatGrid>(grid);
  return std::make_shared<FloatGrid>(*openvdb::gridPtrCast<DoubleGrid>(grid));
}

// Position of the grid's lattice
// -------------------------------------------------------------------------------------------------------------

/// A matrix of floats has half the digits of a double; over a thousand voxels its error is a thousandth of a
/// voxel.
constexpr double kSameLength = 1e-6;

void findLattice(const std::string& file, LevelSet& out) {
  const openvdb::math::Transform& transform = out.grid->transform();
  const auto affine = transform.isLinear() ? transform.baseMap()->getAffineMap() : nullptr;
  if (affine == nullptr)
    refuseVdb(file, "the file has voxels that widen with depth (a frustum); resample it to cubes");
  const openvdb::Mat4R m = affine->getMat4();
  Mat3 steps;  // columns: a step along each axis of the lattice
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 3; ++k) steps(k, axis) = m(axis, k);
  const Vec3 lengths = steps.colwise().norm();
  const double h = lengths.x();
  if (!(h > 0) || !steps.allFinite())
    refuseVdb(file, "the file has voxels whose size is not a positive number; resample it");
  if (!((lengths.array() - h).abs() <= kSameLength * h).all())
    refuseVdb(file, "the file has voxels of " + digits(1e3 * lengths.x()) + " x " +
                        digits(1e3 * lengths.y()) + " x " + digits(1e3 * lengths.z()) +
                        " mm; resample it to cubes (Houdini: VDB Resample)");
  const Mat3 R = steps / h;
  if (!((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() <= 4 * kSameLength))
    refuseVdb(file, "the file has voxels that are sheared; resample it to cubes (Houdini: VDB Resample)");
  if (R.determinant() < 0)
    refuseVdb(file, "the file has a mirrored grid; resample it (Houdini: VDB Resample)");
  const Vec3 p(m(3, 0), m(3, 1), m(3, 2));
  if (!p.allFinite()) refuseVdb(file, "the file has a grid whose position is not finite; set its transform");
  out.voxel_m = h;
  // Deviations within rounding error do not justify a resampling.
  const bool is_straight = (R - Mat3::Identity()).cwiseAbs().maxCoeff() <= 1e-9;
  const bool is_home = is_straight && p.cwiseAbs().maxCoeff() <= 1e-6 * h;
  if (!is_home) out.X_FM = is_straight ? Pose::translation(p) : Pose(Quat(R), p);
}

// The grid's values
// -------------------------------------------------------------------------------------------------------------

constexpr double kMinBand = 3, kMaxBand = 32;  // voxels; at kMaxBand half a quantum is 1/2000 voxel

[[noreturn]] void refuseNan(const std::string& file) {
  refuseVdb(file, "the file holds values that are not numbers; export it again");
}

/// Tests the values of tiles, which cover many voxels. Values of leaves are tested one by one elsewhere.
void requireTiles(const std::string& file, const FloatGrid& grid) {
  auto tile = grid.tree().cbeginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (std::isnan(*tile)) refuseNan(file);
}

void requireValues(const std::string& file, const FloatGrid& grid) {
  const double background = static_cast<double>(grid.background());
  if (grid.tree().leafCount() == 0)
    refuseVdb(file, "the file is empty: it has no values in a band around a surface; export it again");
  if (background < 0)
    refuseVdb(file, "the file is inside out: its background is negative; negate all values");
  if (!(background > 0))
    refuseVdb(file, "the file looks like a fog volume: its background is 0; convert it to a level set");
  if (!std::isfinite(background)) refuseVdb(file, "the file has no band: its background is not a number");
  requireTiles(file, grid);
  bool has_inside = false, has_outside = false;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
    for (openvdb::Index i = 0; i < FloatGrid::TreeType::LeafNodeType::SIZE; ++i) {
      const float d = leaf->getValue(i);
      if (std::isnan(d)) refuseNan(file);
      has_inside = has_inside || d < 0;
      has_outside = has_outside || d >= 0;
    }
  if (!has_inside || !has_outside)
    refuseVdb(file, std::string("the file has no surface: no value is ") +
                        (has_inside ? "positive" : "negative") +
                        "; a fog volume or a distance without sign must be converted to a level set");
}

/// Gives the inside beyond the band its sign, because some programs leave it marked as outside.
void signInside(FloatGrid& grid) {
  for (auto value = grid.cbeginValueOff(); value; ++value)
    if (*value < 0) return;
  openvdb::tools::signedFloodFill(grid.tree());
}

void widenBand(const std::string& file, LevelSet& level_set) {
  const double band = static_cast<double>(level_set.grid->background()) / level_set.voxel_m;
  if (band < 1 - 1e-6)
    refuseVdb(file, "the file has a band of " + digits(band) +
                        " voxels; at least 1 voxel is needed, 3 are enough (Houdini: VDB " +
                        "Renormalize or VDB Rebuild)");
  const int missing = static_cast<int>(std::ceil(kMinBand - band + 1e-3));
  // Steps across edges too, so that the new band is as wide in every direction.
  const auto wider = openvdb::tools::dilateSdf(*level_set.grid, missing, openvdb::tools::NN_FACE_EDGE);
  const auto background = static_cast<float>(kMinBand * level_set.voxel_m);
  openvdb::tools::changeLevelSetBackground(wider->tree(), background);
  level_set.grid = wider;
  level_set.band_m = kMinBand * level_set.voxel_m;
}

}  // namespace

LevelSet asLevelSet(const FloatGrid::Ptr& grid, const std::string& file) {
  LevelSet out;
  out.grid = grid;
  findLattice(file, out);
  requireValues(file, *grid);
  signInside(*out.grid);
  const double band = static_cast<double>(grid->background()) / out.voxel_m;
  out.band_m = std::min(band, kMaxBand) * out.voxel_m;
  if (band < kMinBand - 1e-3) widenBand(file, out);
  return out;
}

LevelSet levelSetOf(VdbArchive& archive, const std::string& file, const std::string& name) {
  const std::vector<Entry>& entries = archive.entries();
  const Entry& entry = choose(entries, file, name);
  requireMemory(entry.bytes(), " for grid '" + entry.name() + "'", "resample it with larger voxels", file);
  return asLevelSet(asFloats(archive.read(static_cast<std::size_t>(&entry - entries.data()))), file);
}

}  // namespace vps
