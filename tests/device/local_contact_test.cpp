// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/local_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "support/device/fake_device.h"
#include "support/no_alloc.h"
#include "vps/mesh.h"
#include "vps_device/loop.h"

namespace vps::device {
namespace {

constexpr double kHalf_m = 10e-3;  // half the edge of the cube in hand; the cube touches the wall z <= 0 when
                                   // its centre is at this height
constexpr double kMass_kg = 0.05;
constexpr double kTick_s = 1e-3;

CouplingGains dualArmGains() {
  CouplingGains gains;
  gains.k_N_per_m = 1150;
  gains.b_Ns_per_m = 0.9;
  gains.k_Nm_per_rad = 2;
  gains.b_Nms_per_rad = 0.0016;
  return gains;
}

/// A cube over a flat wall, as voxmap and points.
struct WallModels {
  VoxMap map = buildVoxMap(makeBox(Vec3(80e-3, 80e-3, 10e-3)), {0.5e-3, 4});
  PointShell shell = buildPointShell(makeBox(Vec3::Constant(2 * kHalf_m)), {2e-3, 0.35});
  LocalPart part() const {
    LocalPart part;
    part.map = &map;
    part.shell = &shell;
    part.X_WM = Pose::translation(Vec3(0, 0, -5e-3));
    part.mass_kg = kMass_kg;
    part.inertia_G = kMass_kg * (2 * kHalf_m) * (2 * kHalf_m) / 6 * Mat3::Identity();
    return part;
  }
};

const WallModels& wall() {
  static const WallModels models;
  return models;
}

/// Reference of a physics engine: the cube does not rotate, is coupled to the proxy, and the wall is rigid.
/// Integrates each axis by backward Euler.
struct CubePhysics {
  CouplingState part{Pose::translation(Vec3(0, 0, kHalf_m + 2e-3)), {}, 0, true};

  void step(const CouplingGains& gains, const CouplingState& proxy, double dt_s) {
    for (int axis = 0; axis < 3; ++axis) {
      double& p = part.X_W.p[axis];
      double& v = part.V_W.v[axis];
      v = (kMass_kg * v +
           dt_s * (gains.k_N_per_m * (proxy.X_W.p[axis] - p) + gains.b_Ns_per_m * proxy.V_W.v[axis])) /
          (kMass_kg + dt_s * gains.b_Ns_per_m + dt_s * dt_s * gains.k_N_per_m);
      if (axis == 2) v = std::max(v, (kHalf_m - p) / dt_s);
      p += dt_s * v;
    }
    part.time_s += dt_s;
  }
};

struct Motion {
  Vec3 p = Vec3::Zero(), v = Vec3::Zero();  // displacement and velocity of the handle from its start
};

struct Played {
  std::vector<Vec3> forces_N;  // by tick
  double worst_normal_N = 0;   // |force - K depth - b v|, once the reference has settled after touching
  double worst_side_N = 0;     // greatest sideways force, which is zero in the reference
  double greatest_step_N = 0;  // greatest change of the force from tick to tick
  LocalContact::Report local;
};

/// The loop at 1 kHz on a physics of `ticks` periods a step.
Played play(const std::function<Motion(double)>& motion, int ticks, bool has_local, double from_s,
            double until_s) {
  test::PlainDevice device;
  CouplingPort port;
  CubePhysics physics;
  LocalContact local;
  local.take(wall().part());
  LoopSettings settings;
  settings.gains = dualArmGains();
  settings.local = has_local ? &local : nullptr;
  HapticLoop loop(device, port, settings);
  port.physics.write({physics.part, 0, {}, {}});
  loop.grasp(physics.part.X_W);
  Played played;
  Vec3 before = Vec3::Zero();
  for (int tick = 1; tick * kTick_s < until_s; ++tick) {
    const double t_s = tick * kTick_s;
    const Motion m = motion(t_s);
    device.sample = {Pose::translation(m.p), {Vec3::Zero(), m.v}, t_s, Status::Ok};
    loop.tick();
    const Vec3 f_N = device.F_written_D.f;
    if (t_s > from_s) {
      const double depth_m = kHalf_m - loop.last().X_WG.p.z();
      const double ideal_N = settings.gains.k_N_per_m * depth_m - settings.gains.b_Ns_per_m * m.v.z();
      played.worst_normal_N = std::max(played.worst_normal_N, std::abs(f_N.z() - ideal_N));
      played.worst_side_N = std::max(played.worst_side_N, f_N.head<2>().norm());
      played.greatest_step_N = std::max(played.greatest_step_N, (f_N - before).norm());
    }
    before = f_N;
    played.forces_N.push_back(f_N);
    if (tick % ticks == 0) {
      physics.step(settings.gains, port.haptic.read().proxy, ticks * kTick_s);
      port.physics.write({physics.part, 0, {}, {}});
    }
  }
  played.local = local.report();
  return played;
}

// Moves down onto the wall at 50 mm/s and 3 mm into the wall (3.5 N), and then rests.
Motion press(double t_s) {
  const double z_m = std::min(50e-3 * t_s, 5e-3);
  return {Vec3(0, 0, -z_m), z_m < 5e-3 ? Vec3(0, 0, -50e-3) : Vec3(Vec3::Zero())};
}

// Moves down onto the wall, and then along the wall at 50 mm/s.
Motion slide(double t_s) {
  Motion m = press(t_s);
  const double x_m = 50e-3 * std::max(0.0, t_s - 0.2);
  m.p.x() = x_m;
  if (x_m > 0) m.v.x() = 50e-3;
  return m;
}

TEST(LocalContact, PressedOnAWallThePartStopsAtTheDepthOfTheContactStiffness) {
  LocalContact local;
  local.take(wall().part());
  const CouplingGains gains = dualArmGains();
  CouplingState proxy{Pose::translation(Vec3(0, 0, kHalf_m - 3e-3)), {}, 0, true};
  const CouplingState snapshot{Pose::translation(Vec3(0, 0, kHalf_m + 20e-6)), {}, 1, true};
  CouplingState part;
  {
    vps_test::NoAllocScope guard;
    for (int i = 0; i < 40; ++i) part = local.follow(gains, proxy, snapshot, kTick_s);
  }
  // Contact and coupling are springs in series: depth k A = K (3 mm - depth), with the area A of the face's
  // points, including the points of the rim. The voxmap's nodes are rounded to half a quantum.
  double area_m2 = 0;
  for (std::uint32_t i = 0; i < wall().shell.size(); ++i)
    if (wall().shell.points[i].z() < -kHalf_m + 1e-9) area_m2 += wall().shell.area_m2[i];
  const double k_wall = 1e12 * area_m2;
  const double depth_m = gains.k_N_per_m * 3e-3 / (k_wall + gains.k_N_per_m);
  EXPECT_NEAR(kHalf_m - part.X_W.p.z(), depth_m, wall().map.quantum_m() + 1e-3 * depth_m);
  EXPECT_LT(part.V_W.v.norm(), 1e-6) << "at rest";
  EXPECT_LT(rotationVector(part.X_W.R).norm(), 1e-6) << "flat";
  EXPECT_EQ(local.report().held, 0u);
}

TEST(LocalContact, InTheAirItMovesByTheCouplingAlone) {
  LocalContact local;
  local.take(wall().part());
  const CouplingGains gains = dualArmGains();
  CubePhysics truth;
  truth.part.X_W.p = Vec3(0, 0, 50e-3);
  const CouplingState snapshot = truth.part;
  CouplingState proxy{Pose::translation(Vec3(1e-3, -2e-3, 51e-3)), {}, 0, true};
  for (int i = 0; i < 40; ++i) {
    truth.step(gains, proxy, kTick_s);
    const CouplingState part = local.follow(gains, proxy, snapshot, kTick_s);
    ASSERT_LT((part.X_W.p - truth.part.X_W.p).norm(), 1e-12);
  }
}

TEST(LocalContact, FrictionHoldsAPartThatIsPulledWithinTheCone) {
  LocalPart part = wall().part();
  part.material.friction = 0.3;
  const CouplingGains gains = dualArmGains();
  for (const double pull_m : {0.5e-3, 2e-3}) {
    LocalContact local;
    local.take(part);
    // Pressed by 3.45 N: the cone is 1.03 N wide; pulled by 0.58 or 2.3 N.
    CouplingState proxy{Pose::translation(Vec3(pull_m, 0, kHalf_m - 3e-3)), {}, 0, true};
    CouplingState now{Pose::translation(Vec3(0, 0, kHalf_m)), {}, 1, true};
    for (int i = 0; i < 40; ++i)
      now = local.follow(gains, proxy, {Pose::translation(Vec3(0, 0, kHalf_m)), {}, 1, true}, kTick_s);
    // Within the cone the part creeps, at most at the speed at which friction has its full value.
    if (pull_m < 1e-3) {
      EXPECT_LT(now.X_W.p.x(), 1e-3 * 40 * kTick_s);
    } else {
      // The part slides, also beyond the middle, until the spring's force is within the cone.
      EXPECT_GT(now.X_W.p.x(), 0.5e-3);
      EXPECT_LT(gains.k_N_per_m * std::abs(pull_m - now.X_W.p.x()), 0.3 * 3.45);
      EXPECT_LT(now.V_W.v.norm(), 1e-3);
    }
  }
}

// Greatest difference of force between two runs, tick by tick.
double apart_N(const Played& a, const Played& b) {
  double most_N = 0;
  for (std::size_t i = 0; i < std::min(a.forces_N.size(), b.forces_N.size()); ++i)
    most_N = std::max(most_N, (a.forces_N[i] - b.forces_N[i]).norm());
  return most_N;
}

TEST(LocalContact, WithSlowPhysicsATouchMatchesThatOfFastPhysics) {
  const Played truth = play(press, 1, false, 0, 0.4), jagged = play(press, 10, false, 0, 0.4),
               crisp = play(press, 10, true, 0, 0.4);
  RecordProperty("error_100Hz_N", std::to_string(apart_N(jagged, truth)));
  RecordProperty("error_100Hz_local_N", std::to_string(apart_N(crisp, truth)));
  RecordProperty("step_1kHz_N", std::to_string(truth.greatest_step_N));
  RecordProperty("step_100Hz_N", std::to_string(jagged.greatest_step_N));
  RecordProperty("step_100Hz_local_N", std::to_string(crisp.greatest_step_N));
  EXPECT_LT(apart_N(crisp, truth), apart_N(jagged, truth) / 3) << "local contact has no benefit";
}

TEST(LocalContact, WithSlowPhysicsSlidingHasNoSawTooth) {
  const Played jagged = play(slide, 10, false, 0.3, 0.6), smooth = play(slide, 10, true, 0.3, 0.6);
  RecordProperty("side_100Hz_N", std::to_string(jagged.worst_side_N));
  RecordProperty("side_100Hz_local_N", std::to_string(smooth.worst_side_N));
  // Held for ten periods at 50 mm/s the part lags by 0.5 mm, which is 0.58 N; nine tenths of this force come
  // in one step.
  EXPECT_GT(jagged.greatest_step_N, 0.4);
  EXPECT_LT(smooth.worst_side_N, jagged.worst_side_N / 4);
  EXPECT_LT(smooth.greatest_step_N, jagged.greatest_step_N / 4);
}

TEST(LocalContact, BetweenPhysicsStatesItOnlyLosesEnergy) {
  // The hand holds still: the energy in spring, motion and contact must decrease at every tick.
  LocalContact local;
  local.take(wall().part());
  const CouplingGains gains = dualArmGains();
  const CouplingState proxy{Pose::translation(Vec3(1e-3, 2e-3, kHalf_m - 2e-3)), {}, 0, true};
  CouplingState part{
      Pose::translation(Vec3(0, 0, kHalf_m + 1e-3)), {Vec3(3, -2, 1), Vec3(0.2, 0.1, -0.3)}, 1, true};
  const CouplingState snapshot = part;
  const Mat3 inertia = wall().part().inertia_G;
  const auto stored_J = [&](const CouplingState& s) {
    TouchSummary touch;
    queryWrench(wall().map, wall().shell, wall().part().X_WM.inverse() * s.X_W, {}, 0, Vec3::Zero(), touch);
    const double turn_rad = rotationVector(proxy.X_W.R * s.X_W.R.transpose()).norm();
    return 0.5 * kMass_kg * s.V_W.v.squaredNorm() + 0.5 * s.V_W.w.dot(inertia * s.V_W.w) +
           0.5 * gains.k_N_per_m * (proxy.X_W.p - s.X_W.p).squaredNorm() +
           0.5 * gains.k_Nm_per_rad * turn_rad * turn_rad;
  };
  double before_J = stored_J(part);
  for (int i = 0; i < 49; ++i) {
    part = local.follow(gains, proxy, snapshot, kTick_s);
    const double now_J = stored_J(part);
    // Contact returns at most its own 1/2 k A d^2, a microjoule at these depths.
    ASSERT_LT(now_J, before_J + 1e-5) << i;
    before_J = std::min(before_J, now_J);
  }
}

TEST(LocalContact, HoldsThePartWhenPhysicsStopsOrContactsAreTooMany) {
  const CouplingGains gains = dualArmGains();
  const CouplingState proxy{Pose::translation(Vec3(5e-3, 0, kHalf_m + 5e-3)), {}, 0, true};
  const CouplingState snapshot{Pose::translation(Vec3(0, 0, kHalf_m + 5e-3)), {}, 1, true};
  LocalContact local;
  local.take(wall().part());
  CouplingState part;
  for (int i = 0; i < 52; ++i)
    part = local.follow(gains, proxy, snapshot, kTick_s);  // the part follows for 50 ms and is then held
  const Vec3 p = part.X_W.p;
  for (int i = 0; i < 100; ++i) part = local.follow(gains, proxy, snapshot, kTick_s);
  EXPECT_LT((part.X_W.p - p).norm(), 1e-12);
  EXPECT_EQ(part.V_W.v.norm(), 0);
  EXPECT_GE(local.report().held, 102u);
  EXPECT_LE(local.report().held, 103u);

  LocalContactSettings few;
  few.contact_limit = 3;
  LocalContact crowded(few);
  crowded.take(wall().part());
  const CouplingState touching{Pose::translation(Vec3(0, 0, kHalf_m)), {}, 1, true};
  EXPECT_EQ(crowded.follow(gains, proxy, touching, kTick_s).X_W.p, touching.X_W.p);
  EXPECT_EQ(crowded.report().held, 1u);
}

TEST(LocalContact, AStateThatIsNotFiniteIsReturnedUnchanged) {
  LocalContact local;
  local.take(wall().part());
  CouplingState snapshot{Pose::translation(Vec3(0, 0, kHalf_m)), {}, 1, true};
  const CouplingState proxy = snapshot;
  for (const double odd : {std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    snapshot.V_W.v.x() = odd;
    snapshot.time_s += 1;
    const CouplingState part = local.follow(dualArmGains(), proxy, snapshot, kTick_s);
    EXPECT_TRUE(couplingWrench(dualArmGains(), proxy, part).isFinite());
  }
  snapshot.V_W.v.x() = 0;
  snapshot.time_s += 1;
  EXPECT_TRUE(local.follow(dualArmGains(), proxy, snapshot, kTick_s).X_W.isFinite())
      << "the prediction continues";
}

}  // namespace
}  // namespace vps::device
