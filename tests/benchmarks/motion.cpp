// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "scene.h"
#include "scene_parts.h"

namespace vps::bench {
namespace {

constexpr double kGear_m = 1e-3;  // module

/// A triangle wave between 0 and 1 with the period 2.
double toAndFro(double x) {
  const double within = x - 2 * std::floor(x / 2);
  return within < 1 ? within : 2 - within;
}

Mat3 turned(double about_z_rad) {
  return rotationFromVector({0, 0, about_z_rad});
}

double ringPlanetDistance() {
  return test::pitchRadius(ringShape(1)) - test::pitchRadius(planetShape(1));
}

}  // namespace

Motion pegMotion(double step_m) {
  // 2 % more than the clearance: an arc of 2 acos(1 / 1.02) = 23 degrees touches, with at most 0.2 um of
  // overlap.
  constexpr double kPressed_m = 1.02 * kPegClearance_m;
  constexpr double kShallow_m = 6e-3, kDeep_m = 18e-3;
  const double above_m = plateShape(1).height_m / 2 + pegShape(1).length_m / 2;
  return [=](int step) {
    const double travel_m = step * step_m;
    const double depth_m = kShallow_m + (kDeep_m - kShallow_m) * toAndFro(travel_m / (kDeep_m - kShallow_m));
    const double turn_rad = 0.2 * travel_m / pegShape(1).radius_m;
    return Pose(turned(turn_rad), {kPressed_m, 0, above_m - depth_m});
  };
}

Motion gearMotion(double step_m) {
  // Overlap across the flank; negative is a gap. The field gives slightly too small distances at the ring's
  // concave flanks: some 15 of 185,030 points touch at a gap of 0.4 um, and 130 without a gap.
  constexpr double kBite_m = -0.4e-6;
  const test::GearShape ring = ringShape(1), planet = planetShape(1);
  const double cos_pressure = std::cos(20 * std::numbers::pi / 180);
  // The gap across a flank is the backlash of one wheel; a rotation reduces this gap by rotation times base
  // radius.
  const double closed_rad =
      (kBacklash_m * cos_pressure + kBite_m) / (test::pitchRadius(planet) * cos_pressure);
  const double tip_m = test::pitchRadius(planet) + kGear_m;
  return [=](int step) {
    const double planet_rad = step * step_m / tip_m;
    const Pose X_WM(turned(planet_rad * planet.teeth / ring.teeth), Vec3::Zero());
    const Pose X_WP(turned(planet_rad + closed_rad), {ringPlanetDistance(), 0, 0});
    return X_WM.inverse() * X_WP;
  };
}

Motion screwMotion(double step_m) {
  // Flanks stand at 30 degrees to the radius: pushing the rod along by c / sqrt(3) closes a radial clearance
  // c on one side of the thread; a sideways shift of 2 um then makes half of the circumference touch, with up
  // to 1 um of overlap.
  const double pushed_m = kThreadClearance_m / std::sqrt(3.0);
  constexpr double kAside_m = 2e-6;
  const test::ThreadShape thread = rodThread(1);
  return [=](int step) {
    const double travelled_rad = step * step_m / thread.major_m;
    const double turn_rad = test::kTurn_rad * toAndFro(travelled_rad / test::kTurn_rad);
    const double climbed_m = thread.pitch_m * turn_rad / test::kTurn_rad;
    return Pose(turned(turn_rad), test::polar(kAside_m, 0.3 * travelled_rad, climbed_m + pushed_m));
  };
}

Motion hoverMotion(double step_m) {
  const double touching_m = (ringShape(1).width_m + planetShape(1).width_m) / 2;
  const double tip_m = test::pitchRadius(planetShape(1)) + kGear_m;
  return [=](int step) {
    const double turn_rad = step * step_m / tip_m;
    const double gap_m = 0.5e-3 + 3.5e-3 * toAndFro(step * step_m / 20e-3);
    // The tilt uses only a part of the gap, at most 0.4 mm at the rim.
    const double tilt_rad = 0.02 * std::sin(3 * turn_rad) + 1e-3;
    return Pose(Mat3(rotationFromVector({tilt_rad, 0, 0}) * turned(turn_rad)),
                {ringPlanetDistance() + 17e-3, 0, touching_m + gap_m + 0.4e-3});
  };
}

Motion freeMotion(double step_m) {
  return [=](int step) {
    const double turn_rad = step * step_m / 16e-3;
    return Pose(rotationFromVector({0.3 * turn_rad, 0.5 * std::sin(turn_rad), turn_rad}),
                {150e-3 + 20e-3 * std::sin(0.5 * turn_rad), 10e-3, 5e-3});
  };
}

Motion trembleMotion(double step_m) {
  constexpr double kReach_m = 30e-6;
  return [=](int step) {
    const double phase = step * step_m / kReach_m;
    const Vec3 p(std::sin(phase), std::sin(0.7 * phase + 1), std::sin(0.4 * phase + 2));
    return Pose(rotationFromVector(1e-4 * Vec3(std::sin(0.3 * phase), 1, std::cos(0.6 * phase))),
                kReach_m * p);
  };
}

}  // namespace vps::bench
