// SPDX-License-Identifier: BSD-3-Clause
// Reads the bytes as a mesh: every mesh that requireUsable() accepts can be repaired, voxelised and read.
//
// The first byte is the form: its low six bits are an exponent of the scale; if the top bit is set corners
// are doubles and indices may be out of range, otherwise corners lie on a small grid, where facets coincide,
// touch and collapse. The second byte is the number of corners; corners and facets follow.
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "fuzz.h"
#include "vps/errors.h"
#include "vps/mesh_repair.h"
#include "vps/voxmap.h"

namespace {

vps::Mesh meshOf(const std::uint8_t* data, std::size_t size) {
  vps::Mesh mesh;
  if (size < 3) return mesh;
  const bool is_wild = (data[0] & 0x80) != 0;
  const double scale = std::pow(10, (data[0] & 0x3f) / 3 - 14);
  const std::size_t count = 1 + data[1] % 24, width = is_wild ? 24 : 3;
  std::size_t at = 2;
  for (; mesh.vertices.size() < count && at + width <= size; at += width) {
    vps::Vec3 p;
    if (is_wild)
      std::memcpy(p.data(), data + at, 24);
    else
      p = scale * vps::Vec3(data[at] % 6, data[at + 1] % 6, data[at + 2] % 6);
    mesh.vertices.push_back(p);
  }
  for (; at + 3 <= size && mesh.triangles.size() < 64; at += 3) {
    std::array<std::uint32_t, 3> t{};
    for (std::size_t i = 0; i < 3; ++i)
      t[i] = data[at + i] % static_cast<std::uint32_t>(mesh.vertices.size() + is_wild);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Such small meshes are finished before a second thread has started.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const vps::Mesh mesh = meshOf(data, size);
  try {
    vps::requireUsable(mesh, "", "");
    vps::Mesh shared = vps::welded(mesh);
    vps::requireUsable(shared, "", "");
    const vps::RepairedMesh repaired = vps::repairMesh(std::move(shared));
    vps::fuzz::require(!repaired.surface.triangles.empty(), "a surface is left");
    vps::fuzz::require(!vps::describe(repaired.report).empty(), "a report reads as a sentence");
    const double voxel_m = vps::bounds(mesh).size().maxCoeff() / 6;
    vps::MeshReport report;
    const vps::VoxMap map = vps::buildVoxMap(mesh, {voxel_m, 3}, "", {}, &report);
    vps::fuzz::require(report.certain_share >= 0 && report.certain_share <= 1, "a share is a share");
    for (const vps::Vec3& p : mesh.vertices)
      vps::fuzz::require(std::abs(map.distance(p)) <= (1 + 1e-6) * map.band_m(), "distances end at the band");
    vps::fuzz::require(map.distance(map.bounds().max + map.bounds().size()) == map.band_m(),
                       "far off is outside");
  } catch (const vps::LoadError&) {
  }
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  const auto bytes = [](const Mesh& mesh, double per_unit) {
    std::string out = {33, static_cast<char>(mesh.vertices.size() - 1)};  // 10^-3
    for (const Vec3& p : mesh.vertices)
      for (int i = 0; i < 3; ++i) out.push_back(static_cast<char>(std::lround(p[i] * per_unit + 2)));
    for (const auto& t : mesh.triangles) out.append({char(t[0]), char(t[1]), char(t[2])});
    return out;
  };
  Mesh two = makeBox({2, 2, 2});
  append(two, transformed(makeBox({2, 2, 2}), Pose::translation({1, 1, 1})));
  std::string wild = {char(0x80), 3};
  for (const double v : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0})
    wild.append(reinterpret_cast<const char*>(&v), sizeof v);
  wild.append({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3});
  return {bytes(makeBox({2, 2, 2}), 1), bytes(two, 1), bytes(makeSphere(2, 0), 1), wild};
}
