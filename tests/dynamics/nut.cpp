// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/screw.h"

namespace vps::dynamics {

namespace {

constexpr double kClearance_m = 0.1e-3;  // radial clearance, as of a 6H nut on a 6g bolt

test::ThreadShape threadOf(const NutSize& size, int columns) {
  test::ThreadShape thread;
  thread.major_m = size.major_m / 2;
  thread.pitch_m = size.pitch_m;
  thread.columns = columns;
  thread.rows_per_pitch = 16;
  return thread;
}

/// A nut on its rod, in a world of their own.
struct Thread {
  World world;
  Placed rod, nut;

  Thread(const SceneSettings& settings, const NutSize& size, double friction)
      : world(settings),
        rod(world.add(rodPart(size), Pose(), true, friction)),
        // The nut is raised by whole pitches, at which the threads are in phase.
        nut(world.add(nutPart(size), Pose::translation(Vec3(0, 0, size.pitch_m)), false, friction)) {}

  [[nodiscard]] double tilt_rad() const {
    const Vec3 axis = nut.pose().R.col(2);
    return std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
  }
};

struct Sample {
  double t_s, z_m, v_m_s, turn_rad;
};

double slope(const std::vector<Sample>& samples) {
  double n = 0, st = 0, sv = 0, stt = 0, stv = 0;
  for (const Sample& s : samples)
    n += 1, st += s.t_s, sv += s.v_m_s, stt += s.t_s * s.t_s, stv += s.t_s * s.v_m_s;
  return (n * stv - st * sv) / (n * stt - st * st);
}

double theory_m_s2(const PartMesh& nut, const NutSize& size) {
  const Mat3 R = nut.frame.X_PB.R;
  const Mat3 I = R * nut.frame.inertia_kg_m2.asDiagonal() * R.transpose();
  const double r_m = size.pitch_m / (2 * std::numbers::pi);
  return World::kGravity_m_s2 / (1 + I(2, 2) / (nut.frame.mass_kg * r_m * r_m));
}

}  // namespace

const PartMesh& nutPart(const NutSize& size, int columns) {
  static std::map<std::vector<double>, PartMesh> parts;
  return keptPart(parts, {size.major_m, size.pitch_m, size.height_m, size.corner_m, double(columns)}, [&] {
    test::ThreadShape thread = threadOf(size, columns);
    thread.length_m = size.height_m;
    thread.clearance_m = kClearance_m;
    return makePart(test::makeNut(thread, size.corner_m));
  });
}

const PartMesh& rodPart(const NutSize& size, int columns) {
  static std::map<std::vector<double>, PartMesh> parts;
  return keptPart(parts, {size.major_m, size.pitch_m, size.height_m, double(columns)}, [&] {
    test::ThreadShape thread = threadOf(size, columns);
    thread.length_m = size.height_m + 6 * size.pitch_m;
    return makePart(test::makeThreadedRod(thread));
  });
}

NutSpinResult spinNut(const SceneSettings& settings, const NutSize& size, double rad_s, int steps) {
  constexpr int kLandingSteps = 100;
  Thread thread(settings, size, 0);
  thread.world.step(kLandingSteps);
  const double lead_m = size.pitch_m / (2 * std::numbers::pi);
  thread.nut.body->setAngularVelocity(btVector3(0, 0, btScalar(-rad_s)));
  thread.nut.body->setLinearVelocity(btVector3(0, 0, btScalar(-rad_s * lead_m)));
  thread.world.step(steps);
  const double gain_m_s = theory_m_s2(thread.nut.part, size) * steps * World::kStep_s;
  return {-static_cast<double>(thread.nut.body->getAngularVelocity().z()), rad_s + gain_m_s / lead_m};
}

NutRunResult runNut(const SceneSettings& settings, const NutSize& size) {
  constexpr double kLanding_s = 0.05;  // the nut first falls through the clearance
  Thread thread(settings, size, 0);
  TurnCounter turn(thread.nut);
  NutRunResult result;
  result.theory_m_s2 = theory_m_s2(thread.nut.part, size);
  result.deepest_m = -1e300;
  const double turns = settings.is_short ? 0.25 : 1;
  std::vector<Sample> samples;
  for (int i = 0; i < 1500; ++i) {
    thread.world.step();
    const Sample now{i * World::kStep_s, thread.nut.pose().p.z(), thread.nut.body->getLinearVelocity().z(),
                     turn.update()};
    result.tilt_rad = std::max(result.tilt_rad, thread.tilt_rad());
    if (i % 50 == 0 && !settings.is_short)
      result.deepest_m = std::max(result.deepest_m,
                                  penetration_m(thread.rod.part, Pose(), thread.nut.part, thread.nut.pose()));
    if (now.t_s < kLanding_s) continue;
    samples.push_back(now);
    if (std::abs(now.turn_rad - samples.front().turn_rad) >= turns * 2 * std::numbers::pi) break;
  }
  const double turned = (samples.back().turn_rad - samples.front().turn_rad) / (2 * std::numbers::pi);
  result.acceleration_m_s2 = -slope(samples);
  result.turns = std::abs(turned);
  result.advance_m = std::abs((samples.back().z_m - samples.front().z_m) / turned);
  result.step_ms = 1e3 * thread.world.times().mean_s();
  result.hash = thread.world.hash();
  return result;
}

double selfLockTheory(const NutSize& size) {
  const double pitch_diameter_m = size.major_m - 0.75 * size.pitch_m * std::sqrt(3.0) / 2;
  return size.pitch_m / (std::numbers::pi * pitch_diameter_m) * std::cos(std::numbers::pi / 6);
}

double turnWithFriction_rad(const SceneSettings& settings, const NutSize& size, double mu,
                            double duration_s) {
  constexpr int kSettling = 200;
  Thread thread(settings, size, mu);
  thread.world.step(kSettling);
  TurnCounter turn(thread.nut);
  double turned_rad = 0;
  const int steps = static_cast<int>(std::lround(duration_s / World::kStep_s));
  for (int i = 0; i < steps; ++i) {
    thread.world.step();
    turned_rad = std::max(turned_rad, std::abs(turn.update()));
  }
  return turned_rad;
}

double selfLockFriction(const SceneSettings& settings, const NutSize& size, double resolution) {
  // 0.001 below the threshold an M10 nut gains 1.1 rad/s^2: 0.03 rad in 0.25 s.
  constexpr double kMoves_rad = 0.01, kWatched_s = 0.25;
  double slides = 0, holds = 0.2;
  while (holds - slides > resolution) {
    const double mu = 0.5 * (slides + holds);
    (turnWithFriction_rad(settings, size, mu, kWatched_s) > kMoves_rad ? slides : holds) = mu;
  }
  return 0.5 * (slides + holds);
}

}  // namespace vps::dynamics
