// SPDX-License-Identifier: BSD-3-Clause
// A file of a voxmap has a Header, the MeshReport, the cells' bricks and centre bounds, the nodes of all
// bricks, and a hash of everything before it. A file of a shell has a ShellHeader, then points, normals,
// areas and progressive order, and a hash; its hierarchy of spheres is built again, which takes a hundredth
// of the time of sampling. Numbers are stored as in memory.
#include "vps/voxmap_cache.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

#include "part/cache_file.h"
#include "part/cache_folder.h"
#include "pointshell/shell_hierarchy.h"
#include "voxmap/voxmap_access.h"
#include "vps/solid.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

namespace fs = std::filesystem;

/// Incremented when the file's layout changes, or when building gives other bits.
constexpr std::uint32_t kVersion = 8;
constexpr std::array<char, 8> kMagic = {'v', 'p', 's', 'c', 'a', 'c', 'h', 'e'};

struct Header {
  CacheFileStart start = {kMagic, kVersion};
  double voxel_m = 0, band_m = 0;
  std::array<double, 6> bounds_m = {};
  std::array<std::int32_t, 3> low = {}, size = {};
  float steepest = 1, node_error = 0;
  std::uint64_t is_metric = 1;
  std::uint64_t bricks = 0;  ///< not counting the constant bricks
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 144);  // no gaps

/// All members of a report, separately, because gaps between them would put undefined bytes into the file.
template <typename Report>
auto membersOf(Report& r) {
  static_assert(sizeof(MeshReport) == 19 * 8, "a member was added");
  return std::tie(r.triangles, r.degenerate_triangles, r.duplicate_triangles, r.open_edges,
                  r.non_manifold_edges, r.flipped_edges, r.shells, r.joined_corners, r.joined_m, r.holes,
                  r.t_junctions, r.flipped_facets, r.turned_shells, r.overlapping_shells, r.internal_facets,
                  r.sheet_facets, r.united_shells, r.signed_by_winding, r.is_union_incomplete,
                  r.certain_share);
}
constexpr std::uint64_t kReportBytes = 16 * sizeof(std::size_t) + 2 * sizeof(bool) + 2 * sizeof(double);

Digest keyOf(const Mesh& mesh, const VoxMapSettings& settings) {
  const std::array<std::uint64_t, 3> sizes = {kVersion, mesh.vertices.size(), mesh.triangles.size()};
  const std::array<double, 2> values = {settings.voxel_m, settings.band_voxels};
  Hash hash;
  hash.add(sizes.data(), sizeof sizes);
  hash.add(values.data(), sizeof values);
  hash.add(mesh);
  return hash.digest();
}

/// Size of a file with this header; nothing if the numbers are impossible. The size is checked before memory
/// is allocated.
std::optional<std::uint64_t> bytesOf(const Header& header) {
  constexpr std::uint64_t kMaxCells = std::uint64_t{1} << 40;
  constexpr std::int64_t kFarthest =
      std::numeric_limits<std::int32_t>::max() / VoxMap::kBrick;  // in voxels, an int
  std::uint64_t cells = 1;
  for (std::size_t k = 0; k < header.size.size(); ++k) {
    const std::int64_t n = header.size[k], low = header.low[k];
    if (n < 1 || low < -kFarthest || low + n > kFarthest) return std::nullopt;
    cells *= static_cast<std::uint64_t>(n);
    if (cells > kMaxCells) return std::nullopt;
  }
  if (header.bricks > VoxPool::kMaxBricks) return std::nullopt;
  return sizeof(Header) + kReportBytes + cells * (sizeof(std::uint32_t) + sizeof(float)) +
         header.bricks * kBrickStride * sizeof(NodeValue) + sizeof(Digest);
}

/// Incremented when the file's layout changes, or when sampling gives other bits.
constexpr std::uint32_t kShellVersion = 3;
constexpr std::array<char, 8> kShellMagic = {'v', 'p', 's', 's', 'h', 'e', 'l', 'l'};

struct ShellHeader {
  CacheFileStart start = {kShellMagic, kShellVersion};
  double spacing_m = 0;
  std::uint64_t points = 0;
};
static_assert(std::is_trivially_copyable_v<ShellHeader> && sizeof(ShellHeader) == 48);  // no gaps

constexpr std::uint64_t kPointBytes = 2 * sizeof(Vec3) + sizeof(double) + sizeof(std::uint32_t);

/// Digest of everything that determines the shell of a mesh's Solid.
Digest shellKeyOf(const Mesh& mesh, const PointShellSettings& settings) {
  const std::array<std::uint64_t, 3> sizes = {kShellVersion, mesh.vertices.size(), mesh.triangles.size()};
  const std::array<double, 2> values = {settings.spacing_m, settings.edge_angle_rad};
  Hash hash;
  hash.add(kShellMagic.data(), kShellMagic.size());
  hash.add(sizes.data(), sizeof sizes);
  hash.add(values.data(), sizeof values);
  hash.add(mesh);
  return hash.digest();
}

/// Returns nothing, and a reason in `why`, if the file cannot be trusted.
std::optional<PointShell> readShell(const std::filesystem::path& file, const Digest& key, std::string& why) {
  HashedReader reader(file);
  const auto header = readHeader<ShellHeader>(
      reader, file, key, "is not a pointshell",
      [](const ShellHeader& h) {
        return sizeof(ShellHeader) + std::min(h.points, kMostBytes / kPointBytes) * kPointBytes +
               sizeof(Digest);
      },
      why);
  if (!header) return std::nullopt;
  PointShell shell;
  shell.spacing_m = header->spacing_m;
  shell.points.resize(header->points);
  shell.inward.resize(header->points);
  shell.area_m2.resize(header->points);
  shell.order.resize(header->points);
  reader.read(shell.points);
  reader.read(shell.inward);
  reader.read(shell.area_m2);
  reader.read(shell.order);
  if (!reader.isGood() || !reader.endsWell()) return why = "is damaged", std::nullopt;
  shell.nodes = sphereHierarchy(shell.points);
  layOutBlocks(shell);
  return shell;
}

/// False if the file could not be written.
bool writeShell(const PointShell& shell, const std::filesystem::path& file, const Digest& key) {
  ShellHeader header;
  header.start.key = key;
  header.spacing_m = shell.spacing_m;
  header.points = shell.size();
  HashedWriter writer(file);
  writer.write(&header, sizeof header);
  writer.write(shell.points);
  writer.write(shell.inward);
  writer.write(shell.area_m2);
  writer.write(shell.order);
  return writer.finish();
}

constexpr const char *kMapEnding = ".voxmap", *kShellEnding = ".shell";

/// Reads the file's content. If there is no file, or it cannot be trusted, makes the content and keeps it.
/// @param read   (file, why): returns nothing, and a reason, if the file cannot be trusted
/// @param write  (content, file): returns true if the file was written
template <class What, class Read, class Make, class Write>
What readOrMake(CacheFolder& folder, const fs::path& file, Read read, Make make, Write write) {
  std::error_code error;
  if (fs::exists(file, error)) {
    std::string why;
    if (std::optional<What> kept = read(file, why)) {
      CacheFolder::touch(file);
      return std::move(*kept);
    }
    folder.warn(file, why + "; the model is built again");
  }
  What made = make();
  folder.keep(file, [&](const fs::path& to) { return write(made, to); });
  return made;
}

bool areNamesGood(const VoxLayout& layout) {
  const std::uint64_t end = layout.pool->size() * kBrickStride;
  for (const std::uint32_t brick : layout.bricks)
    if (brick % kBrickStride != 0 || brick >= end) return false;
  return true;
}

}  // namespace

/// Writes maps to files and reads them.
class VoxMapCacheFile {
 public:
  /// Returns nothing, and a reason in `why`, if the file cannot be trusted.
  static std::optional<VoxMap> read(const fs::path& file, const Digest& key, MeshReport& report,
                                    std::string& why) {
    HashedReader reader(file);
    const auto header = readHeader<Header>(reader, file, key, "is not a voxmap", bytesOf, why);
    if (!header) return std::nullopt;
    std::optional<VoxMap> map = readBody(reader, *header, report);
    if (!map) why = "is damaged";
    return map;
  }

  static bool write(const VoxMap& map, const MeshReport& report, const fs::path& file, const Digest& key) {
    const VoxLayout& layout = *VoxMapAccess::layout(map);
    Header header;
    header.start.key = key;
    header.voxel_m = map.voxel_m();
    header.band_m = map.band_m();
    for (int k = 0; k < 3; ++k) {
      header.bounds_m[static_cast<std::size_t>(k)] = map.bounds().min[k];
      header.bounds_m[static_cast<std::size_t>(k + 3)] = map.bounds().max[k];
      header.low[static_cast<std::size_t>(k)] = layout.low[k];
      header.size[static_cast<std::size_t>(k)] = layout.size[k];
    }
    header.steepest = layout.steepest;
    header.node_error = layout.node_error;
    header.is_metric = layout.is_metric ? 1 : 0;
    header.bricks = layout.pool->size() - 2;
    HashedWriter writer(file);
    writer.write(&header, sizeof header);
    std::apply([&](const auto&... member) { (writer.write(&member, sizeof member), ...); },
               membersOf(report));
    writer.write(layout.bricks);
    writer.write(layout.centers_m);
    writer.write(layout.pool->nodes(2 * kBrickStride), header.bricks * kBrickStride * sizeof(NodeValue));
    return writer.finish();
  }

 private:
  static std::optional<VoxMap> readBody(HashedReader& reader, const Header& header, MeshReport& report) {
    auto layout = std::make_shared<VoxLayout>();
    Box bounds;
    for (int k = 0; k < 3; ++k) {
      bounds.min[k] = header.bounds_m[static_cast<std::size_t>(k)];
      bounds.max[k] = header.bounds_m[static_cast<std::size_t>(k + 3)];
      layout->low[k] = header.low[static_cast<std::size_t>(k)];
      layout->size[k] = header.size[static_cast<std::size_t>(k)];
    }
    layout->steepest = header.steepest;
    layout->node_error = header.node_error;
    layout->is_metric = header.is_metric != 0;
    layout->parts = {{bounds, layout->low, layout->low + layout->size}};
    layout->resizeCells();
    MeshReport kept;
    std::apply([&](auto&... member) { (reader.read(&member, sizeof member), ...); }, membersOf(kept));
    reader.read(layout->bricks);
    reader.read(layout->centers_m);
    layout->pool = std::make_shared<VoxPool>(header.bricks);
    (void)layout->pool->take(header.bricks);  // the pool is new, so the bricks start at its first one
    reader.read(layout->pool->nodes(2 * kBrickStride), header.bricks * kBrickStride * sizeof(NodeValue));
    if (!reader.isGood() || !reader.endsWell() || !areNamesGood(*layout)) return std::nullopt;
    report = kept;
    markFarCells(*layout);
    return VoxMapAccess::make(layout, header.voxel_m, header.band_m, bounds);
  }
};

VoxMapCache::VoxMapCache(fs::path folder, Warn warn, std::uint64_t limit_bytes)
    : folder_(std::make_shared<CacheFolder>(std::move(folder), std::move(warn), limit_bytes)) {}

fs::path VoxMapCache::fileOf(const Mesh& mesh, const VoxMapSettings& settings) const {
  return folder_->fileOf(nameOf(keyOf(mesh, settings)) + kMapEnding);
}

fs::path VoxMapCache::shellFileOf(const Mesh& mesh, const PointShellSettings& settings) const {
  return folder_->fileOf(nameOf(shellKeyOf(mesh, settings)) + kShellEnding);
}

VoxMap VoxMapCache::build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                          const Progress& progress, MeshReport* report) const {
  const StoppableWork work(progress, "repairing the mesh");
  return readOrBuild(mesh, settings, report, [&](MeshReport& found) {
    return buildVoxMap(Solid(mesh, part), settings, part, progress, &found);
  });
}

VoxMap VoxMapCache::build(const Mesh& mesh, const Solid& solid, const VoxMapSettings& settings,
                          const std::string& part, const Progress& progress, MeshReport* report) const {
  return readOrBuild(mesh, settings, report,
                     [&](MeshReport& found) { return buildVoxMap(solid, settings, part, progress, &found); });
}

VoxMap VoxMapCache::readOrBuild(const Mesh& mesh, const VoxMapSettings& settings, MeshReport* report,
                                const std::function<VoxMap(MeshReport&)>& make) const {
  const Digest key = keyOf(mesh, settings);
  MeshReport found;
  VoxMap map = readOrMake<VoxMap>(
      *folder_, folder_->fileOf(nameOf(key) + kMapEnding),
      [&](const fs::path& file, std::string& why) { return VoxMapCacheFile::read(file, key, found, why); },
      [&] { return make(found); },
      [&](const VoxMap& made, const fs::path& to) { return VoxMapCacheFile::write(made, found, to, key); });
  if (report != nullptr) *report = found;
  return map;
}

PointShell VoxMapCache::buildShell(const Mesh& mesh, const Solid& solid, const PointShellSettings& settings,
                                   const std::string& part) const {
  const Digest key = shellKeyOf(mesh, settings);
  return readOrMake<PointShell>(
      *folder_, folder_->fileOf(nameOf(key) + kShellEnding),
      [&](const fs::path& file, std::string& why) { return readShell(file, key, why); },
      [&] { return buildPointShell(solid, settings, part); },
      [&](const PointShell& made, const fs::path& to) { return writeShell(made, to, key); });
}

}  // namespace vps
