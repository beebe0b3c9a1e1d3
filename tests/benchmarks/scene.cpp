// SPDX-License-Identifier: BSD-3-Clause
#include "scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "scene_parts.h"
#include "support/temporary_folder.h"

namespace vps::bench {
namespace {

/// A shell of some points of another shell. The shell is written to a file and read back, which is the public
/// way to make a shell of given points: reading sorts the points and builds their spheres.
PointShell shellOfSome(const PointShell& shell, const std::vector<bool>& is_kept) {
  const auto count = std::count(is_kept.begin(), is_kept.end(), true);
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "shell.ply";
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << count << "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "area"})
    out << "property double " << name << "\n";
  out << "end_header\n";
  for (std::size_t i = 0; i < shell.size(); ++i) {
    if (!is_kept[i]) continue;
    const Vec3 &p = shell.points[i], &n = shell.inward[i];
    const double row[7] = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), shell.area_m2[i]};
    out.write(reinterpret_cast<const char*>(row), sizeof row);
  }
  out.close();
  PointShell some = loadPly(file.string());
  some.spacing_m = shell.spacing_m;
  return some;
}

/// The last scene, and its key.
struct Kept {
  Pair pair = Pair::PegInPlate;
  SceneSize size;
  std::shared_ptr<const Scene> scene;
};

void makeMap(Scene& scene, int voxels) {
  scene.settings = {voxelFor(scene.map_mesh, voxels), kBandVoxels};
  scene.map = buildVoxMap(scene.map_mesh, scene.settings);
  scene.field = buildOpenVdb(scene.map_mesh, {scene.settings.voxel_m, kBandVoxels, true});
}

}  // namespace

std::pair<Mesh, Mesh> meshesOf(Pair pair, int coarser) {
  switch (pair) {
    case Pair::PegInPlate:
      return {test::makeBoredPlate(plateShape(coarser)), test::makePeg(pegShape(coarser))};
    case Pair::PlanetInRing:
      return {test::makeRingGear(ringShape(coarser)), test::makeSpurGear(planetShape(coarser))};
    case Pair::RodInNut:
      return {test::makeNut(nutThread(coarser), kNutCorner_m), test::makeThreadedRod(rodThread(coarser))};
    case Pair::RingOnItself:
      break;
  }
  const Mesh ring = test::makeRingGear(ringShape(coarser));
  return {ring, ring};
}

double voxelFor(const Mesh& mesh, int voxels) {
  return bounds(mesh).size().maxCoeff() / voxels;
}

PointShell shellOfSize(const Mesh& mesh, std::size_t points) {
  const auto wanted = static_cast<double>(points);
  double spacing_m = std::sqrt(1.25 * area(mesh) / wanted);  // face points per square of the spacing
  PointShell shell;  // the smallest shell so far that has enough points
  for (int attempt = 0; attempt < 8; ++attempt) {
    PointShell tried = buildPointShell(mesh, {spacing_m, 0.35});
    const auto count = static_cast<double>(tried.size());
    if (count >= wanted && (shell.size() < points || tried.size() < shell.size())) shell = std::move(tried);
    if (count >= wanted && count <= 1.01 * wanted) break;
    spacing_m *= std::sqrt(count / (1.004 * wanted));
  }
  if (shell.size() < points)
    throw std::runtime_error("no spacing gives a shell of " + std::to_string(points) + " points");
  std::vector<bool> is_kept(shell.size(), false);
  for (std::size_t k = 0; k < points; ++k) is_kept[shell.order[k]] = true;
  return shellOfSome(shell, is_kept);
}

PointShell patchOf(const PointShell& shell, std::size_t first, std::size_t count) {
  std::vector<bool> is_kept(shell.size(), false);
  std::fill_n(is_kept.begin() + static_cast<std::ptrdiff_t>(first), count, true);
  return shellOfSome(shell, is_kept);
}

std::shared_ptr<const Scene> sceneOf(Pair pair, const SceneSize& size) {
  static Kept kept;
  if (kept.scene && kept.pair == pair && kept.size == size) return kept.scene;
  const bool has_parts = kept.scene && kept.pair == pair && kept.size.coarser == size.coarser;
  if (!has_parts)
    kept.scene.reset();  // the last scene is released before the next scene is built, since both scenes may
                         // be large
  auto scene = std::make_shared<Scene>();
  if (has_parts)
    *scene = *kept.scene;
  else
    std::tie(scene->map_mesh, scene->shell_mesh) = meshesOf(pair, size.coarser);
  if (!has_parts || kept.size.points != size.points)
    scene->shell = shellOfSize(scene->shell_mesh, size.points);
  if (!has_parts || kept.size.voxels != size.voxels) makeMap(*scene, size.voxels);
  kept = {pair, size, scene};
  return scene;
}

}  // namespace vps::bench
