// SPDX-License-Identifier: BSD-3-Clause
// A cache file has a Header, the MeshReport, the cells' bricks and centre bounds, the nodes of all bricks,
// and a hash of everything before it. Numbers are stored as in memory.
#define XXH_INLINE_ALL
#include "vps/voxmap_cache.h"

#include <xxhash.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <tuple>

#include "voxmap/voxmap_access.h"
#include "vps/solid.h"
#include "vps/write_file.h"

namespace vps::inline v0 {
namespace {

namespace fs = std::filesystem;

/// Incremented when the file's layout changes, or building gives other bits.
constexpr std::uint32_t kVersion = 5;
constexpr std::array<char, 8> kMagic = {'v', 'p', 's', 'c', 'a', 'c', 'h', 'e'};
/// Reads as another number on a machine of the other byte order.
constexpr std::uint32_t kByteOrder = 0x01020304;

using Digest = std::array<std::uint64_t, 2>;

class Hash {
 public:
  Hash() { XXH3_128bits_reset(&state_); }
  void add(const void* bytes, std::size_t count) { XXH3_128bits_update(&state_, bytes, count); }
  [[nodiscard]] Digest digest() const {
    const XXH128_hash_t h = XXH3_128bits_digest(&state_);
    return {h.high64, h.low64};
  }

 private:
  XXH3_state_t state_;
};

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t byte_order = kByteOrder;
  Digest key = {};
  double voxel_m = 0, band_m = 0;
  std::array<double, 6> bounds_m = {};
  std::array<std::int32_t, 3> low = {}, size = {};
  float steepest = 1, node_error = 0;
  std::uint64_t is_metric = 1;
  std::uint64_t bricks = 0;  ///< without the constant ones
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 144);  // no gaps

/// All members of a report, one by one: gaps between them would put undefined bytes into the file.
template <typename Report>
auto membersOf(Report& r) {
  static_assert(sizeof(MeshReport) == 16 * 8, "a member was added");
  return std::tie(r.triangles, r.degenerate_triangles, r.duplicate_triangles, r.open_edges,
                  r.non_manifold_edges, r.flipped_edges, r.shells, r.holes, r.t_junctions, r.flipped_facets,
                  r.turned_shells, r.overlapping_shells, r.internal_facets, r.sheet_facets,
                  r.signed_by_winding, r.certain_share);
}
constexpr std::uint64_t kReportBytes = 14 * sizeof(std::size_t) + sizeof(bool) + sizeof(double);

Digest keyOf(const Mesh& mesh, const VoxMapSettings& settings) {
  const std::array<std::uint64_t, 3> sizes = {kVersion, mesh.vertices.size(), mesh.triangles.size()};
  const std::array<double, 2> values = {settings.voxel_m, settings.band_voxels};
  Hash hash;
  hash.add(sizes.data(), sizeof sizes);
  hash.add(values.data(), sizeof values);
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  hash.add(mesh.vertices.data(), mesh.vertices.size() * sizeof mesh.vertices[0]);
  hash.add(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  return hash.digest();
}

std::string nameOf(const Digest& key) {
  std::array<char, 33> text;
  std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(key[0]),
                static_cast<unsigned long long>(key[1]));
  return std::string(text.data()) + ".voxmap";
}

/// Reads and hashes; isGood() becomes false at the first missing byte.
class Reader {
 public:
  explicit Reader(const fs::path& file) : in_(file, std::ios::binary) {}
  [[nodiscard]] bool isGood() const { return in_.good(); }
  void read(void* to, std::size_t bytes) {
    in_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
    if (in_.good()) hash_.add(to, bytes);
  }
  template <typename T>
  void read(std::vector<T>& to) {
    read(to.data(), to.size() * sizeof(T));
  }
  /// True if the file ends with the hash of all that was read, and nothing follows.
  [[nodiscard]] bool endsWell() {
    const Digest found = hash_.digest();
    Digest kept = {};
    in_.read(reinterpret_cast<char*>(kept.data()), sizeof kept);
    return in_.good() && found == kept && in_.peek() == std::ifstream::traits_type::eof();
  }

 private:
  std::ifstream in_;
  Hash hash_;
};

class Writer {
 public:
  explicit Writer(const fs::path& file) : out_(file, std::ios::binary) {}
  void write(const void* from, std::size_t bytes) {
    out_.write(static_cast<const char*>(from), static_cast<std::streamsize>(bytes));
    hash_.add(from, bytes);
  }
  template <typename T>
  void write(const std::vector<T>& from) {
    write(from.data(), from.size() * sizeof(T));
  }
  /// True if everything has been written.
  bool finish() {
    const Digest digest = hash_.digest();
    out_.write(reinterpret_cast<const char*>(digest.data()), sizeof digest);
    out_.close();
    return !out_.fail();
  }

 private:
  std::ofstream out_;
  Hash hash_;
};

/// Size of a file with this header; nothing if the numbers are impossible. Checked before memory is
/// allocated.
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
    Reader reader(file);
    if (!reader.isGood()) return why = "cannot be read", std::nullopt;
    Header header;
    reader.read(&header, sizeof header);
    if (!reader.isGood() || header.magic != kMagic) return why = "is not a voxmap", std::nullopt;
    if (header.version != kVersion || header.byte_order != kByteOrder)
      return why = "is of another version of this program", std::nullopt;
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error || bytesOf(header) != size) return why = "is damaged or cut short", std::nullopt;
    if (header.key != key) return why = "is of another part", std::nullopt;
    std::optional<VoxMap> map = readBody(reader, header, report);
    if (!map) why = "is damaged";
    return map;
  }

  static bool write(const VoxMap& map, const MeshReport& report, const fs::path& file, const Digest& key) {
    const VoxLayout& layout = *VoxMapAccess::layout(map);
    Header header;
    header.key = key;
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
    Writer writer(file);
    writer.write(&header, sizeof header);
    std::apply([&](const auto&... member) { (writer.write(&member, sizeof member), ...); },
               membersOf(report));
    writer.write(layout.bricks);
    writer.write(layout.centers_m);
    writer.write(layout.pool->nodes(2 * kBrickStride), header.bricks * kBrickStride * sizeof(NodeValue));
    return writer.finish();
  }

 private:
  static std::optional<VoxMap> readBody(Reader& reader, const Header& header, MeshReport& report) {
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
    (void)layout->pool->take(header.bricks);  // all of a new pool, so from its first brick on
    reader.read(layout->pool->nodes(2 * kBrickStride), header.bricks * kBrickStride * sizeof(NodeValue));
    if (!reader.isGood() || !reader.endsWell() || !areNamesGood(*layout)) return std::nullopt;
    report = kept;
    markFarCells(*layout);
    return VoxMapAccess::make(layout, header.voxel_m, header.band_m, bounds);
  }
};

VoxMapCache::VoxMapCache(fs::path folder, Warn warn) : folder_(std::move(folder)), warn_(std::move(warn)) {}

fs::path VoxMapCache::fileOf(const Mesh& mesh, const VoxMapSettings& settings) const {
  return folder_ / nameOf(keyOf(mesh, settings));
}

VoxMap VoxMapCache::build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                          const Progress& progress, MeshReport* report) const {
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
  const fs::path file = folder_ / nameOf(key);
  const auto warn = [&](const fs::path& about, const std::string& text) {
    if (warn_) warn_(about.string() + ": " + text);
  };
  MeshReport found;
  std::error_code error;
  if (fs::exists(file, error)) {
    std::string why;
    if (const std::optional<VoxMap> map = VoxMapCacheFile::read(file, key, found, why)) {
      if (report != nullptr) *report = found;
      return *map;
    }
    warn(file, why + "; built again");
  }
  const VoxMap map = make(found);
  if (report != nullptr) *report = found;
  fs::create_directories(folder_, error);
  WholeFile whole(file);
  if (error || !VoxMapCacheFile::write(map, found, whole.temporary(), key) || whole.commit())
    warn(folder_, "a voxmap could not be kept there; is it a folder, may you write to it, is the disk full?");
  return map;
}

}  // namespace vps::inline v0
