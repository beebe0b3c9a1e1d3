// SPDX-License-Identifier: BSD-3-Clause
// vps_curves: data behind the pictures of plugin/measurements.md. `vps_curves time DIR` and
// `vps_curves accuracy DIR` write plain columns for gnuplot (plots/*.gp) and Markdown tables.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>

#include "measure.h"
#include "scene_parts.h"
#include "support/units.h"

namespace vps::bench {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Median and p99 of the query, and the rival's median, as a line of a data file.
void writeLine(std::ostream& out, double x, const Scene& scene, const Motion& motion, double build_s) {
  const OneThread one_thread;
  StepCase c;
  c.map = &scene.map;
  c.shell = &scene.shell;
  c.field = scene.field.get();
  c.motion = motion;
  const Counters found = measureSteps(c, 0);
  out << number(x) << " " << number(found.at("ours_us")) << " " << number(found.at("p99_us")) << " "
      << (scene.field ? number(found.at("rival_us")) : "nan") << " " << number(found.at("touching")) << " "
      << number(build_s) << "\n";
  out.flush();
}

constexpr const char* kColumns = " median_us p99_us openvdb_us touching build_cpu_s\n";

/// Returns the same surface with four times the triangles.
Mesh subdivided(const Mesh& mesh) {
  Mesh fine;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(fine.vertices.size());
    const Vec3 p[3] = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    for (int k = 0; k < 3; ++k) fine.vertices.push_back(p[k]);
    // The order of the sum does not depend on the triangle, so both triangles of an edge get the same middle,
    // to the bit.
    for (int k = 0; k < 3; ++k) fine.vertices.emplace_back(0.5 * (p[k] + p[(k + 1) % 3]));
    for (const auto& [i, j, k] : {std::array<std::uint32_t, 3>{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
      fine.triangles.push_back({first + i, first + j, first + k});
  }
  return welded(fine);
}

/// A peg in a bore of 24 flats. The flats of the plate are subdivided more and more, so that the surface and
/// the contact stay the same.
void timeAgainstTriangles(const std::filesystem::path& dir) {
  std::ofstream out(dir / "triangles.dat");
  out << "# triangles" << kColumns;
  test::PlateShape plate = plateShape(1);
  plate.columns = 24;
  plate.bore_m /= std::cos(std::numbers::pi / plate.columns);
  plate.bore_rows = 5;
  plate.face_steps = 3;
  plate.side_rows = 2;
  Scene scene;
  scene.map_mesh = test::makeBoredPlate(plate);
  scene.shell = shellOfSize(test::makePeg(pegShape(1)), SceneSize{}.points);
  for (; scene.map_mesh.triangles.size() < 12'000'000; scene.map_mesh = subdivided(scene.map_mesh)) {
    scene.settings = {voxelFor(scene.map_mesh, 512), kBandVoxels};
    const double before_s = cpuSeconds();
    scene.map = buildVoxMap(scene.map_mesh, scene.settings);
    const double build_s = cpuSeconds() - before_s;
    writeLine(out, static_cast<double>(scene.map_mesh.triangles.size()), scene, pegMotion(0.1 * kMm),
              build_s);
  }
}

/// `x` gives the value of a size on the horizontal axis.
template <typename X>
void timeAgainst(const std::filesystem::path& file, Pair pair, const Motion& motion,
                 const std::vector<SceneSize>& sizes, const char* name, X x) {
  std::ofstream out(file);
  out << "# " << name << kColumns;
  for (const SceneSize& size : sizes) {
    const auto scene = sceneOf(pair, size);
    writeLine(out, x(size), *scene, motion, 0);
  }
}

void timeCurves(const std::filesystem::path& dir) {
  std::vector<SceneSize> by_points, by_voxels;
  for (const std::size_t points : {1'000u, 3'000u, 10'000u, 30'000u, 100'000u, 300'000u, 1'000'000u})
    by_points.push_back({.points = points});
  for (const int voxels : {64, 128, 256, 512, 1024}) by_voxels.push_back({.voxels = voxels});
  const auto points = [](const SceneSize& s) { return static_cast<double>(s.points); };
  const auto voxels = [](const SceneSize& s) { return static_cast<double>(s.voxels); };
  const struct {
    const char* name;
    Pair pair;
    Motion motion;
  } scenes[] = {{"peg", Pair::PegInPlate, pegMotion(0.1 * kMm)},
                {"gears", Pair::PlanetInRing, gearMotion(0.1 * kMm)},
                {"screw", Pair::RodInNut, screwMotion(0.1 * kMm)}};
  timeAgainstTriangles(dir);
  for (const auto& [name, pair, motion] : scenes) {
    timeAgainst(dir / (std::string("points_") + name + ".dat"), pair, motion, by_points, "points", points);
    timeAgainst(dir / (std::string("voxels_") + name + ".dat"), pair, motion, by_voxels, "voxels", voxels);
  }
}

std::string spreadText(const Spread& s, double unit) {
  return number(s.mean / unit) + " / " + number(s.p99 / unit) + " / " + number(s.most / unit);
}

void accuracyCurves(const std::filesystem::path& dir) {
  constexpr double kUm = 1e-6, kDegree_rad = std::numbers::pi / 180;
  std::ofstream table(dir / "accuracy.md"), data;
  table
      << "| shape | voxel [mm] | distance [um], mean / p99 / most | continuous normal [degrees] | trilinear "
         "normal [degrees] |\n|---|---|---|---|---|\n";
  std::string shape;
  for (const AccuracyPoint& p : accuracyStudy(20'000)) {
    if (p.shape != shape) {
      shape = p.shape;
      data = std::ofstream(dir / ("accuracy_" + shape + ".dat"));
      data << "# voxel_mm distance_um(mean p99 most) continuous_deg(..) trilinear_deg(..)\n";
    }
    data << number(p.voxel_m / kMm);
    const std::pair<Spread, double> columns[] = {
        {p.distance_m, kUm}, {p.continuous_rad, kDegree_rad}, {p.trilinear_rad, kDegree_rad}};
    for (const auto& [s, unit] : columns)
      data << " " << number(s.mean / unit) << " " << number(s.p99 / unit) << " " << number(s.most / unit);
    data << "\n";
    table << "| " << p.shape << " | " << number(p.voxel_m / kMm) << " | " << spreadText(p.distance_m, kUm)
          << " | " << spreadText(p.continuous_rad, kDegree_rad) << " | "
          << spreadText(p.trilinear_rad, kDegree_rad) << " |\n";
  }
}

}  // namespace
}  // namespace vps::bench

int main(int argc, char** argv) {
  const std::string what = argc == 3 ? argv[1] : "";
  if (what != "time" && what != "accuracy") {
    std::cerr << "usage: vps_curves time|accuracy FOLDER\n";
    return 2;
  }
  std::filesystem::create_directories(argv[2]);
  if (what == "time")
    vps::bench::timeCurves(argv[2]);
  else
    vps::bench::accuracyCurves(argv[2]);
  return 0;
}
