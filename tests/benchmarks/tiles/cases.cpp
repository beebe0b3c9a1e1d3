// SPDX-License-Identifier: BSD-3-Clause
#include "tiles.h"

#include <cmath>
#include <numbers>

#include "dynamics/scenes.h"
#include "support/gear.h"
#include "support/lathe.h"

namespace vps::bench {

namespace {

constexpr int kPoses = 6;

Pose turned(double angle_rad, const Vec3& p) {
  return {rotationFromVector(Vec3(0, 0, angle_rad)), p};
}

// The nut is in phase with the rod at every angle; gravity brings the lower flanks together.
Fit threadFit() {
  const dynamics::NutSize size = dynamics::kM10;
  Fit fit{"M10 nut on its rod",
          {dynamics::rodPart(size).mesh, dynamics::nutPart(size).mesh},
          {},
          -Vec3::UnitZ(),
          0.4e-3,
          0.2e-3,
          0.5e-3,
          0.3e-3};
  for (int k = 0; k < kPoses; ++k) {
    const double angle_rad = 0.37 * k;
    fit.X_01.push_back(
        turned(angle_rad, Vec3(0, 0, size.pitch_m * (1 + angle_rad / (2 * std::numbers::pi)))));
  }
  return fit;
}

Fit pegFit() {
  Fit fit{"peg in its bore, 50 um",
          {dynamics::borePart(50e-6).mesh, dynamics::pegPart().mesh},
          {},
          Vec3::UnitX(),
          0.1e-3,
          0.25e-3,
          1e-3,
          0.5e-3};
  for (int k = 0; k < kPoses; ++k) fit.X_01.push_back(turned(0.1 * k, Vec3(0, 0, -5e-3)));
  return fit;
}

// A fit as in the bearing block: 12 mm with 24 um of clearance, and facets with a sagitta of 1 um.
Fit bearingFit() {
  constexpr int kSegments = 172;
  const Mesh bushing = test::lathe(
      {{6.012e-3, 0.5e-3}, {6.512e-3, 0}, {12e-3, 0}, {12e-3, 20e-3}, {6.512e-3, 20e-3}, {6.012e-3, 19.5e-3}},
      kSegments);
  const Mesh shaft = test::lathe(
      {{0, -30e-3}, {5.5e-3, -30e-3}, {6e-3, -29.5e-3}, {6e-3, 29.5e-3}, {5.5e-3, 30e-3}, {0, 30e-3}},
      kSegments);
  Fit fit{"bearing block: shaft in its bushing, 24 um",
          {bushing, shaft},
          {},
          Vec3::UnitX(),
          0.1e-3,
          0.25e-3,
          1e-3,
          1e-3};
  for (int k = 0; k < kPoses; ++k) fit.X_01.push_back(turned(0.1 * k, Vec3(0, 0, 10e-3)));
  return fit;
}

Mesh gear(int teeth, double width_m) {
  test::GearShape shape;
  shape.module_m = 2e-3;
  shape.teeth = teeth;
  shape.width_m = width_m;
  shape.backlash_m = 0.05e-3;
  shape.other_radius_m = 8e-3;
  return test::makeSpurGear(shape);
}

Fit gearFit() {
  Fit fit{"gears 20:30", {gear(20, 12e-3), gear(30, 10e-3)}, {}, Vec3::UnitY(), 0.3e-3, 0.25e-3, 1e-3,
          0.5e-3};
  for (int k = 0; k < kPoses; ++k) {
    // Both gears turn by the same arc length, so that the meshing goes through a pitch; poses are relative to
    // the first gear.
    const double driver_rad = 2 * std::numbers::pi / 20 * k / kPoses;
    const Pose driver = turned(driver_rad, Vec3::Zero());
    const Pose driven = turned(std::numbers::pi / 30 - driver_rad * 20 / 30, Vec3(50e-3, 0, 0));
    fit.X_01.push_back(driver.inverse() * driven);
  }
  return fit;
}

// A ball of 10 mm in a bowl whose radius is 20 um greater.
Fit socketFit() {
  constexpr double kBall_m = 10e-3, kBowl_m = 10.02e-3;
  std::vector<std::array<double, 2>> profile{{0, -14e-3}, {14e-3, -14e-3}, {14e-3, 0}, {kBowl_m, 0}};
  constexpr int kRows = 64;
  for (int i = 1; i <= kRows; ++i) {
    const double angle_rad = 0.5 * std::numbers::pi * i / kRows;
    profile.push_back({i < kRows ? kBowl_m * std::cos(angle_rad) : 0, -kBowl_m * std::sin(angle_rad)});
  }
  Fit fit{"ball in its socket, 20 um",
          {test::lathe(profile, 256), makeSphere(kBall_m, 5)},
          {},
          -Vec3::UnitZ(),
          0.1e-3,
          0.25e-3,
          1e-3,
          0.5e-3};
  for (int k = 0; k < kPoses; ++k)
    fit.X_01.push_back({rotationFromVector(0.3 * k * Vec3(0.6, 0, 0.8)), Vec3::Zero()});
  return fit;
}

double least_m(const Model& points_of, const Model& in, const Pose& X_MP, double near_m) {
  double least_m = near_m;
  for (const Vec3& p : points_of->shell->points) {
    const Vec3 p_M = X_MP * p;
    if (in->map->distance(p_M) > near_m + in->map->voxel_m()) continue;
    least_m = std::min(least_m, in->solid->signedDistance(p_M, near_m));
  }
  return least_m;
}

}  // namespace

std::vector<Fit> allFits(bool is_short) {
  std::vector<Fit> fits{pegFit(), socketFit()};
  if (!is_short)
    for (const Fit& fit : {threadFit(), bearingFit(), gearFit()}) fits.push_back(fit);
  if (is_short)
    for (Fit& fit : fits) fit.X_01.resize(1);
  return fits;
}

Model modelOf(const Mesh& mesh, double voxel_m, double spacing_m) {
  VoxMapSettings voxels;
  voxels.voxel_m = voxel_m;
  PointShellSettings points;
  points.spacing_m = spacing_m;
  return buildPartModel("", mesh, voxels, points);
}

Pose touching(const Fit& fit, const Pose& X_01, const Model (&model)[2]) {
  double free_m = 0, meets_m = fit.play_m;
  constexpr int kHalvings = 12;
  for (int i = 0; i < kHalvings; ++i) {
    const double way_m = 0.5 * (free_m + meets_m);
    const Pose X = Pose::translation(way_m * fit.way) * X_01;
    const double gap_m = std::min(least_m(model[0], model[1], X.inverse(), fit.play_m),
                                  least_m(model[1], model[0], X, fit.play_m));
    (gap_m >= -0.1e-6 ? free_m : meets_m) = way_m;
  }
  return Pose::translation(free_m * fit.way) * X_01;
}

}  // namespace vps::bench
