// SPDX-License-Identifier: BSD-3-Clause
// Signs of voxmaps of real, faulty CAD exports, compared with rays and with the solid angles of all
// triangles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "support/analytic.h"
#include "support/temporary_folder.h"
#include "vps/mesh_repair.h"
#include "vps/voxmap.h"
#include "vps/winding_number.h"

namespace vps::test {
namespace {

namespace fs = std::filesystem;

/// Reads three corners for each facet, in the file's unit times unit_m.
Mesh readStl(const fs::path& file, double unit_m) {
  const std::string bytes = test::bytesOf(file);
  Mesh mesh;
  const auto add = [&](const Vec3& p) {
    mesh.vertices.push_back(unit_m * p);
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    if (n % 3 == 0) mesh.triangles.push_back({n - 3, n - 2, n - 1});
  };
  std::uint32_t count = 0;
  if (bytes.size() >= 84) std::memcpy(&count, &bytes[80], 4);
  if (bytes.size() == 84 + std::size_t{50} * count) {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        std::array<float, 3> p{};
        std::memcpy(p.data(), &bytes[84 + 50 * i + 12 * (corner + 1)], sizeof p);
        add({p[0], p[1], p[2]});
      }
    return mesh;
  }
  std::istringstream text(bytes);
  std::string word;
  Vec3 p;
  while (text >> word)
    if (word == "vertex" && text >> p.x() >> p.y() >> p.z()) add(p);
  return mesh;
}

Mesh readObj(const fs::path& file) {
  Mesh mesh;
  std::istringstream text(test::bytesOf(file));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    Vec3 p;
    if (word == "v" && words >> p.x() >> p.y() >> p.z()) mesh.vertices.push_back(p);
    if (word != "f") continue;
    std::vector<std::uint32_t> corners;
    while (words >> word) corners.push_back(static_cast<std::uint32_t>(std::stoul(word) - 1));
    for (std::size_t i = 2; i < corners.size(); ++i)
      mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
  return mesh;
}

/// Reads VRML as KiCad writes it: pairs of "coordIndex [...]" and "point [...]", one pair for each face.
Mesh readWrl(const fs::path& file, double unit_m) {
  std::string text = test::bytesOf(file);
  std::replace(text.begin(), text.end(), ',', ' ');
  Mesh mesh;
  std::size_t from = 0;
  while ((from = text.find("coordIndex [", from)) != std::string::npos) {
    const std::size_t point = text.find("point [", from);
    std::istringstream indices(text.substr(from + 12, text.find(']', from) - from - 12));
    std::istringstream points(text.substr(point + 7, text.find(']', point) - point - 7));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    int a = 0, b = 0, c = 0, end = 0;
    while (indices >> a >> b >> c >> end)
      mesh.triangles.push_back({first + static_cast<std::uint32_t>(a), first + static_cast<std::uint32_t>(b),
                                first + static_cast<std::uint32_t>(c)});
    Vec3 p;
    while (points >> p.x() >> p.y() >> p.z()) mesh.vertices.push_back(unit_m * p);
    from = point;
  }
  return mesh;
}

/// The number of facets that a ray crosses.
int crossings(const Mesh& mesh, const Vec3& p, const Vec3& way) {
  int count = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
    const double u = way.dot(a.cross(b)), v = way.dot(b.cross(c)), w = way.dot(c.cross(a));
    if (((u < 0) != (v < 0)) || ((v < 0) != (w < 0))) continue;
    count += a.dot((b - a).cross(c - a)) * (u + v + w) > 0;
  }
  return count;
}

struct Agreement {
  MeshReport report;
  std::size_t tested = 0, against_windings = 0, doubtful = 0, against_rays = 0;
};

/// Compares the signs of a map's nodes, at random positions in and around the part, with two references: the
/// winding number of all triangles (of the cleaned mesh), and the parity of eleven rays (of the mesh as
/// given) if at least nine agree.
Agreement compare(const std::string& name, const Mesh& mesh, int voxels) {
  Agreement found;
  const double voxel_m = bounds(mesh).size().maxCoeff() / voxels;
  const VoxMap map = buildVoxMap(mesh, {voxel_m, 4}, "", {}, &found.report);
  const Mesh solid = repairMesh(welded(mesh)).solid;
  const WindingNumber winding(solid);
  RandomPoints random(1);
  std::vector<Vec3> ways;
  for (int i = 0; i < 11; ++i) ways.push_back(random.inBox(Vec3::Ones()).normalized());
  for (int n = 0; n < 400; ++n) {
    // Half of the positions are near the surface, half are anywhere.
    Vec3 p = bounds(mesh).center() + random.inBox(0.6 * bounds(mesh).size());
    if (n % 2) {
      const auto pick = static_cast<std::size_t>((0.5 + 0.5 * random.unit()) * 0.999 *
                                                 static_cast<double>(mesh.triangles.size()));
      p = mesh.vertices[mesh.triangles[pick][0]] + random.inBox(Vec3::Constant(3 * voxel_m));
    }
    p = voxel_m * (p / voxel_m).array().round().matrix();
    if (std::abs(map.distance(p)) < 1e-6 * voxel_m) continue;  // on the surface
    const bool is_inside = map.distance(p) < 0;
    ++found.tested;
    const double w = winding.exact(p);
    found.against_windings += std::abs(w - 0.5) > 0.02 && is_inside != (w > 0.5);
    int inside = 0;
    for (const Vec3& way : ways) inside += crossings(mesh, p, way) % 2;
    if (inside > 2 && inside < 9)
      ++found.doubtful;
    else
      found.against_rays += is_inside != (inside >= 9);
  }
  std::printf(
      "%s: %s; by %s; of %zu nodes %zu against all windings, %zu against rays, rays of %zu disagree\n",
      name.c_str(), describe(found.report).c_str(),
      found.report.signed_by_winding ? "winding" : "pseudonormals", found.tested, found.against_windings,
      found.against_rays, found.doubtful);
  return found;
}

class CadSigns : public testing::Test {
 protected:
  static fs::path find(const std::string& name) {
    const char* given = std::getenv("VPS_CAD_DIR");
    return (given ? fs::path(given) : fs::path(VPS_SOURCE_DIR) / ".." / "shared" / "cad") / name;
  }
};

#define SKIP_WITHOUT(file) \
  if (!fs::exists(file)) GTEST_SKIP() << (file).string() << " does not exist; set VPS_CAD_DIR"

TEST_F(CadSigns, Bearing) {
  const fs::path file = find("occt-bearing-motor/bearing.stl");
  SKIP_WITHOUT(file);
  const Agreement found = compare("bearing", readStl(file, 1e-3), 128);
  EXPECT_EQ(found.report.open_edges, 134u);  // as the folder's LICENCE says
  EXPECT_EQ(found.report.flipped_facets, 29u);
  EXPECT_EQ(found.against_windings, 0u);
  EXPECT_EQ(found.against_rays, 0u);
}
TEST_F(CadSigns, Motor) {
  const fs::path file = find("occt-bearing-motor/motor.stl");
  SKIP_WITHOUT(file);
  const Agreement found = compare("motor", readStl(file, 1e-3), 128);
  EXPECT_GT(found.report.overlapping_shells, 0u);
  EXPECT_GT(found.report.certain_share, 0.999);
  EXPECT_EQ(found.against_windings, 0u);
  EXPECT_EQ(found.against_rays, 0u);
}
TEST_F(CadSigns, MotorCase) {
  const fs::path file = find("planetary-tiptap/Motor_Case.STL");
  SKIP_WITHOUT(file);
  const Agreement found = compare("Motor_Case", readStl(file, 1e-3), 128);
  EXPECT_EQ(found.report.open_edges, 123u);
  EXPECT_GT(found.report.certain_share, 0.999);
  EXPECT_EQ(found.against_windings, 0u);
  EXPECT_EQ(found.against_rays, 0u);
}
TEST_F(CadSigns, Nut) {
  const fs::path file = find("thread-m16-loose/factory_nut_m16_loose_subdiv_3x.obj");
  SKIP_WITHOUT(file);
  const Agreement found = compare("nut", readObj(file), 128);
  EXPECT_EQ(found.report.open_edges, 108u);
  EXPECT_GT(found.report.t_junctions, 50u);
  EXPECT_GT(found.report.certain_share, 0.999);
  EXPECT_EQ(found.against_windings, 0u);
  EXPECT_EQ(found.against_rays, 0u);
}
TEST_F(CadSigns, PinHeaderWithOneShellPerFace) {
  const fs::path file = find("kicad-pinheader/PinHeader_1x04_P2.54mm_Vertical.wrl");
  SKIP_WITHOUT(file);
  const Agreement found = compare("PinHeader", readWrl(file, 2.54e-3), 128);
  EXPECT_FALSE(found.report.signed_by_winding);
  EXPECT_EQ(found.against_windings, 0u);
  EXPECT_EQ(found.against_rays, 0u);
}
TEST_F(CadSigns, PinSocketWithOneShellPerFace) {
  const fs::path file = find("kicad-pinheader/PinSocket_1x04_P2.54mm_Vertical.wrl");
  SKIP_WITHOUT(file);
  const Agreement found = compare("PinSocket", readWrl(file, 2.54e-3), 128);
  EXPECT_FALSE(found.report.signed_by_winding);
  EXPECT_EQ(found.against_windings, 0u);
  EXPECT_EQ(found.against_rays, 0u);
}
TEST_F(CadSigns, TriangleSoupReportsUncertainSigns) {
  const fs::path file = find("cad-trimesh/soup.stl");
  SKIP_WITHOUT(file);
  const Agreement found = compare("soup", readStl(file, 1e-3), 64);
  EXPECT_EQ(found.report.shells, 100u);
  EXPECT_LT(found.report.certain_share, 0.9);
  EXPECT_EQ(found.against_windings, 0u);
}
TEST_F(CadSigns, SharedEdge) {
  const fs::path file = find("cad-trimesh/shared.STL");
  SKIP_WITHOUT(file);
  const Agreement found = compare("shared", readStl(file, 1e-3), 64);
  EXPECT_EQ(found.report.non_manifold_edges, 1u);
  EXPECT_EQ(found.against_windings, 0u);
  EXPECT_EQ(found.against_rays, 0u);
}

}  // namespace
}  // namespace vps::test
