// SPDX-License-Identifier: BSD-3-Clause
// A file of a shell has a ShellHeader, then points, normals, areas and progressive order, and a hash of
// everything before it. The hierarchy of spheres is built again, which takes a hundredth of the time of
// sampling.
#include "part/shell_file.h"

#include "pointshell/shell_hierarchy.h"

namespace vps {
namespace {

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

}  // namespace

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

std::optional<PointShell> readShell(const std::filesystem::path& file, const Digest& key, std::string& why) {
  HashedReader reader(file);
  ShellHeader header;
  if (!reader.isGood()) return why = "cannot be read", std::nullopt;
  reader.read(&header, sizeof header);
  if (!reader.isGood() || header.start.magic != kShellMagic) return why = "is not a pointshell", std::nullopt;
  if (!header.start.isOfSameVersion(ShellHeader().start))
    return why = "is of another version of this program", std::nullopt;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  constexpr std::uint64_t kFrame = sizeof(ShellHeader) + sizeof(Digest);
  // Tested before memory is allocated for the points.
  if (error || size < kFrame || (size - kFrame) % kPointBytes != 0 ||
      (size - kFrame) / kPointBytes != header.points)
    return why = "is damaged or cut short", std::nullopt;
  if (header.start.key != key) return why = "is of another part", std::nullopt;
  PointShell shell;
  shell.spacing_m = header.spacing_m;
  shell.points.resize(header.points);
  shell.inward.resize(header.points);
  shell.area_m2.resize(header.points);
  shell.order.resize(header.points);
  reader.read(shell.points);
  reader.read(shell.inward);
  reader.read(shell.area_m2);
  reader.read(shell.order);
  if (!reader.isGood() || !reader.endsWell()) return why = "is damaged", std::nullopt;
  shell.nodes = sphereHierarchy(shell.points);
  layOutBlocks(shell);
  return shell;
}

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

}  // namespace vps
