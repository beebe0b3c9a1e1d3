// SPDX-License-Identifier: BSD-3-Clause
// A peg in a bore with tens of micrometres of clearance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>

#include "bullet_bridge/world.h"
#include "support/lathe.h"
#include "vps_bullet/coupling.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

constexpr double kRadius_m = 0.005, kDepth_m = 0.015, kLength_m = 0.030;
// Facets are 5 mm (1 - cos(pi / 256)) = 0.4 um inside their circle: much less than a tenth of the clearance.
constexpr int kSegments = 256;
constexpr double kDeepest_m = 3e-6;
// Penalty contact yields: the rim of a tilted peg carries 10 N on 0.9 mm^2 of points and sinks by 11 um at
// 1e12 N/m^3, half of which is for each side; the seat sinks by 11 um too.
constexpr double kSoft_m = 12e-6;

// 10 x 30 mm with a 1 mm chamfer at the lower end (z = 0).
Built makePeg() {
  return test::build(
      test::lathe({{0, 0}, {kRadius_m - 1e-3, 0}, {kRadius_m, 1e-3}, {kRadius_m, kLength_m}, {0, kLength_m}},
                  kSegments),
      7850);
}

// A block with a blind bore from z = 0 down to -kDepth_m, and a chamfered mouth.
Built makeBore(double clearance_m) {
  const double r = kRadius_m + clearance_m / 2;
  return test::build(test::lathe({{0, -kDepth_m - 0.005},
                                  {0.012, -kDepth_m - 0.005},
                                  {0.012, 0},
                                  {r + 0.5e-3, 0},
                                  {r, -0.5e-3},
                                  {r, -kDepth_m},
                                  {0, -kDepth_m}},
                                 kSegments),
                     7850);
}

// Building takes longer than simulating, so each shape is built once, for all masses.
Built peg(double mass_kg) {
  static const Built unit = makePeg();
  Built built = unit;
  built.frame.inertia_kg_m2 *= mass_kg / unit.frame.mass_kg;
  built.frame.mass_kg = mass_kg;
  return built;
}
const Built& bore(double clearance_m) {
  static std::map<double, Built> bores;
  auto it = bores.find(clearance_m);
  if (it == bores.end()) it = bores.emplace(clearance_m, makeBore(clearance_m)).first;
  return it->second;
}

struct Case {
  SolverKind solver;
  double clearance_m;
  double mass_kg;
};

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  const Case& c = info.param;
  return test::nameOf(c.solver) + std::to_string(std::lround(c.clearance_m * 1e6)) + "um" +
         std::to_string(std::lround(c.mass_kg * 1e3)) + "g";
}

class PegInBore : public testing::TestWithParam<Case> {
 protected:
  World world{GetParam().solver};
  const Built& bore_ = bore(GetParam().clearance_m);
  const Built peg_ = peg(GetParam().mass_kg);
  btRigidBody& fixed = world.add(bore_, Pose(), true);
  double deepest_m = -1, worst_us = 0, total_us = 0;
  int steps = 0;

  void step(btRigidBody& body, bool measure = true) {
    const auto before = std::chrono::steady_clock::now();
    world.step();
    const double us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count();
    worst_us = std::max(worst_us, us);
    total_us += us;
    ++steps;
    if (measure)
      deepest_m = std::max(deepest_m, test::penetration_m(bore_, Pose(), peg_, test::partPose(body, peg_)));
  }
  void report(const char* what) {
    std::printf("[ measured ] %s: deepest %.2f um, %.0f us a step (worst %.0f)\n", what, deepest_m * 1e6,
                total_us / steps, worst_us);
  }
};

TEST_P(PegInBore, DroppedItSeats) {
  // The peg starts half the clearance off the axis and 1 mm above the seat's chamfer; it falls and comes to
  // rest.
  btRigidBody& body = world.add(peg_, Pose::translation(Vec3(3e-6, 2e-6, -0.004)));
  for (int i = 0; i < 1500; ++i) step(body, i % 5 == 0);
  const Pose rest = test::partPose(body, peg_);
  double speed_m_s = 0;
  const std::size_t searched = stats(world.dispatcher).pair_updates;
  for (int i = 0; i < 2000; ++i) {
    world.step();
    speed_m_s = std::max<double>(speed_m_s, body.getLinearVelocity().length());
  }
  // Contacts of the seat use up the contact limit. Further contacts that the rim needs must be kept in
  // addition, or each step is solved twice and searched again.
  if (GetParam().solver == SolverKind::Constraint) {
    EXPECT_LE(stats(world.dispatcher).pair_updates - searched, 20u);
  }
  const Pose later = test::partPose(body, peg_);
  report("drop");
  std::printf("[ measured ] seat error %.2f um, drift %.3f um, jitter %.1e m/s\n",
              (later.p.z() + kDepth_m) * 1e6, (later.p - rest.p).norm() * 1e6, speed_m_s);
  EXPECT_NEAR(later.p.z(), -kDepth_m, 3e-6);
  // In single precision the stock solver, which starts friction from zero in each step, lets the part creep
  // by the rounding of dt g, at most 2e-5 m/s, for two seconds. Penalty contact creeps too (4.7e-6 m/s
  // measured), since the deflections of the friction bristles do not include the rounding of a pose.
  const bool creeps = GetParam().solver != SolverKind::Constraint && sizeof(btScalar) == 4;
  // In single precision a pose is rounded by up to 3.7 nm at 62 mm in each of 2000 steps, which friction does
  // not undo. Measured: 1.04 um.
  const double rounding_m = sizeof(btScalar) == 4 ? 2000 * 3.7e-9 : 0;
  EXPECT_LE((later.p - rest.p).norm(), creeps ? 4e-5 : 1e-6 + rounding_m);
  // A rigid contact corrects the rounding of a pose in each step: 3.7 nm at up to 62 mm, in 1 ms.
  const double rounding_m_s = sizeof(btScalar) == 4 ? 2 * 3.7e-6 : 0;
  EXPECT_LE(speed_m_s, creeps ? 2e-5 : 1e-6 + rounding_m_s);
  EXPECT_LE(deepest_m, kDeepest_m);
}

TEST_P(PegInBore, PushedThroughTheCouplingItSeatsAndHolds) {
  btRigidBody& body = world.add(peg_, Pose::translation(Vec3(0.1e-3, 0.05e-3, 0.5e-3)));
  CouplingGains gains;
  gains.k_N_per_m = 2000;
  gains.b_Ns_per_m = 2 * std::sqrt(2000 * peg_.frame.mass_kg);
  gains.k_Nm_per_rad = 4;
  gains.b_Nms_per_rad = 0.02;
  const Pose X_PG = Pose::translation(Vec3(0, 0, kLength_m));
  CouplingConstraint coupling(body, peg_.frame.X_PB.inverse() * X_PG, gains);
  world.world->addConstraint(&coupling, true);
  CouplingState target;
  target.is_coupled = true;
  // The coupling's target moves down at 30 mm/s with an error of 0.1 mm and 0.5 degrees, to 5 mm below the
  // seat, which gives a force of 10 N.
  const Mat3 R = rotationFromVector(Vec3(0.006, 0.006, 0));
  const double end_z_m = -kDepth_m - 5e-3;
  for (int i = 0; i < 1200; ++i) {
    const double z_m = std::max(0.5e-3 - 0.03e-3 * i, end_z_m);
    target.X_W = Pose(R, Vec3(0.1e-3, 0.05e-3, z_m)) * X_PG;
    target.V_W.v = Vec3(0, 0, z_m > end_z_m ? -0.03 : 0);
    coupling.setTarget(target);
    step(body, i % 5 == 0);
  }
  const Pose rest = test::partPose(body, peg_);
  double speed_m_s = 0;
  for (int i = 0; i < 300; ++i) {
    step(body, i % 20 == 0);
    speed_m_s = std::max<double>(speed_m_s, body.getLinearVelocity().length());
  }
  report("push");
  std::printf("[ measured ] seat error %.2f um, jitter %.1e m/s, force %.3f N\n",
              (rest.p.z() + kDepth_m) * 1e6, speed_m_s, coupling.wrench().f.z());
  // The coupling's torque tilts the peg as far as the clearance allows. The peg then stands on its lower rim,
  // and the centre of its lower face is raised by the rim's radius times the tilt.
  const double tilt_rad = rotationVector(rest.R).norm();
  const double soft_m = GetParam().solver == SolverKind::Penalty ? kSoft_m : 0;
  EXPECT_LE(tilt_rad, (1.2 * GetParam().clearance_m + soft_m) / (kDepth_m - 1.5e-3));
  EXPECT_NEAR(rest.p.z(), -kDepth_m + (kRadius_m - 1e-3) * tilt_rad, 3e-6 + 0.5 * soft_m);
  EXPECT_LE(deepest_m, kDeepest_m + soft_m);
  // A part keeps its contacts' planes until it has moved by 1 um (kSamePlace_m), and is then corrected by one
  // step: by at most the difference to the plane of the next facet, turned by 2 pi / 256, after 1 um of
  // motion. This difference is 25 nm.
  const double kept_m = GetParam().solver == SolverKind::Constraint ? 1e-6 * 2 * M_PI / kSegments : 0;
  EXPECT_LE(speed_m_s, std::max(1e-5, kept_m / 1e-3));
  EXPECT_NEAR(coupling.wrench().f.z(), -10, 0.1);  // 1 %
  world.world->removeConstraint(&coupling);
}

INSTANTIATE_TEST_SUITE_P(
    Fits, PegInBore,
    testing::Values(Case{SolverKind::Constraint, 50e-6, 0.0185}, Case{SolverKind::Constraint, 20e-6, 0.0185},
                    Case{SolverKind::Constraint, 20e-6, 0.001}, Case{SolverKind::Constraint, 20e-6, 0.1},
                    Case{SolverKind::Stock, 50e-6, 0.0185}, Case{SolverKind::Penalty, 50e-6, 0.0185},
                    Case{SolverKind::Penalty, 20e-6, 0.0185}, Case{SolverKind::Penalty, 20e-6, 0.001}),
    nameOf);

}  // namespace
}  // namespace vps::bullet
