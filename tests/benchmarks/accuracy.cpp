// SPDX-License-Identifier: BSD-3-Clause
#include "measure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "support/fit.h"
#include "support/screw.h"
#include "support/units.h"
#include "vps/mesh_distance.h"
#include "vps/voxmap.h"

namespace vps::bench {
namespace {

struct Shape {
  std::string name;
  bool is_sharp = false;
  Mesh mesh;
  std::function<bool(const Vec3&)> isCounted;  ///< true for points at which samples are taken
  /// The normal of the smooth surface that the facets approximate. The normals of the facets differ from the
  /// true normal by up to 0.4 degrees, which is more than the field's error. If this function is empty, the
  /// true normal is the direction to the nearest point of the mesh.
  std::function<Vec3(const Vec3&)> trueNormal;
};

bool everywhere(const Vec3&) {
  return true;
}

/// A prism along y with a triangle of 30 degrees at its thin edge.
Mesh makeWedge(double length_m, double width_m) {
  const double height_m = length_m * std::tan(std::numbers::pi / 6);
  Mesh wedge;
  for (const double y : {-width_m / 2, width_m / 2})
    for (const auto& [x, z] : {std::pair{0.0, 0.0}, {length_m, 0.0}, {length_m, height_m}})
      wedge.vertices.emplace_back(x, y, z);
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
  return wedge;
}

/// A pose in which no face is aligned with the grid: a face on a plane of nodes would be more exact than
/// usual.
Pose askew() {
  return {rotationFromVector({0.3, 0.5, 0.2}), {0.31 * kMm, 0.17 * kMm, 0.23 * kMm}};
}

/// Converts a function of a point in the shape's own frame into a function of points and directions of the
/// rotated frame.
template <typename NormalOf>
std::function<Vec3(const Vec3&)> inFrame(NormalOf normalOf) {
  return [=, X_AM = askew()](const Vec3& p) { return Vec3(X_AM.R * normalOf(X_AM.inverse() * p)); };
}

/// The facets of the smooth shapes have edges of 8 to 43 um, except the straight edges of the cylinder.
std::vector<Shape> smoothShapes() {
  static constexpr double kRing_m = 8 * kMm;
  const auto isOnWall = [](const Vec3& p) {  // 3 mm from the rims
    return std::abs((askew().inverse() * p).z()) < 7 * kMm;
  };
  std::vector<Shape> all;
  all.push_back({"sphere", false, makeSphere(5 * kMm, 8), everywhere,
                 inFrame([](const Vec3& p) { return p.normalized(); })});
  all.push_back({"cylinder", false,
                 test::makePeg({.radius_m = 5 * kMm, .length_m = 20 * kMm, .columns = 4096, .rows = 64}),
                 isOnWall, inFrame([](const Vec3& p) { return Vec3(p.x(), p.y(), 0).normalized(); })});
  all.push_back(
      {"torus", false, test::makeTorus(kRing_m, 3 * kMm, 1600, 500), everywhere, inFrame([](const Vec3& p) {
         const Vec3 on_ring = kRing_m * Vec3(p.x(), p.y(), 0).normalized();
         return (p - on_ring).normalized();
       })});
  return all;
}

std::vector<Shape> shapes() {
  std::vector<Shape> all = smoothShapes();
  all.push_back({"box", true, makeBox({10 * kMm, 8 * kMm, 6 * kMm}), everywhere, {}});
  all.push_back({"wedge", true, makeWedge(10 * kMm, 8 * kMm), everywhere, {}});
  all.push_back({"screw",
                 true,
                 test::makeThreadedRod({.length_m = 10 * kMm, .columns = 600, .rows_per_pitch = 64}),
                 everywhere,
                 {}});
  for (Shape& shape : all) shape.mesh = transformed(shape.mesh, askew());
  return all;
}

Spread spreadOf(const std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {sum / static_cast<double>(values.size()), quantile(values, 0.99), quantile(values, 1)};
}

/// Random points up to a voxel from the surface, uniformly distributed over it.
class NearSurface {
 public:
  explicit NearSurface(const Mesh& mesh) : mesh_(mesh) {
    std::vector<double> areas;
    for (const auto& [a, b, c] : mesh.triangles) areas.push_back(crossOf(a, b, c).norm());
    triangle_ = std::discrete_distribution<std::size_t>(areas.begin(), areas.end());
  }
  Vec3 next(double reach_m) {
    const auto& [a, b, c] = mesh_.triangles[triangle_(random_)];
    double u = share_(random_), v = share_(random_);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3& p = mesh_.vertices[a];
    const Vec3 on = p + u * (mesh_.vertices[b] - p) + v * (mesh_.vertices[c] - p);
    return on + reach_m * (2 * share_(random_) - 1) * crossOf(a, b, c).normalized();
  }

 private:
  Vec3 crossOf(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (mesh_.vertices[b] - mesh_.vertices[a]).cross(mesh_.vertices[c] - mesh_.vertices[a]);
  }
  const Mesh& mesh_;
  std::mt19937 random_{1};
  std::discrete_distribution<std::size_t> triangle_;
  std::uniform_real_distribution<double> share_{0, 1};
};

AccuracyPoint measured(const Shape& shape, const MeshDistance& exact, double voxel_m, int samples) {
  const VoxMap map = buildVoxMap(shape.mesh, {voxel_m, kBandVoxels});
  NearSurface near(shape.mesh);
  std::vector<double> distance_m, continuous_rad, trilinear_rad;
  while (static_cast<int>(distance_m.size()) < samples) {
    const Vec3 p = near.next(voxel_m);
    if (!shape.isCounted(p)) continue;
    const double true_m = exact.signedDistance(p);
    distance_m.push_back(std::abs(map.distance(p) - true_m));
    // At distances below 1e-3 voxel the direction to the nearest point is lost in rounding.
    if (std::abs(true_m) < 1e-3 * voxel_m) continue;
    const Vec3 n = shape.trueNormal ? shape.trueNormal(p) : Vec3((p - exact.closest(p).q) / true_m);
    const auto angle = [&](Gradient gradient) {
      const Vec3 read = map.normal(p, gradient);
      return std::atan2(read.cross(n).norm(), read.dot(n));
    };
    continuous_rad.push_back(angle(Gradient::Continuous));
    trilinear_rad.push_back(angle(Gradient::Trilinear));
  }
  return {shape.name,           shape.is_sharp,           voxel_m,
          spreadOf(distance_m), spreadOf(continuous_rad), spreadOf(trilinear_rad)};
}

}  // namespace

std::vector<AccuracyPoint> accuracyStudy(int samples) {
  std::vector<AccuracyPoint> points;
  for (const Shape& shape : shapes()) {
    const MeshDistance exact(shape.mesh);
    for (const double voxel_mm : {0.8, 0.56, 0.4, 0.28, 0.2, 0.14, 0.1}) {
      points.push_back(measured(shape, exact, voxel_mm * kMm, samples));
    }
  }
  return points;
}

}  // namespace vps::bench
