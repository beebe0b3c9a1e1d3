// SPDX-License-Identifier: BSD-3-Clause
// M: a nut is turned up its rod against an axial force F. The theory of threads gives the torque
//
//     T = F r tan(lead + atan(mu / cos 30)),   tan(lead) = pitch / (2 pi r),
//
// where r is the mean radius at which the flanks touch, for a pressure that is even over the flanks.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "support/random_draw.h"
#include "support/screw.h"
#include "vps_bullet/convert.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using dynamics::World;

constexpr double kPi = std::numbers::pi, kClearance_m = 0.1e-3;

struct Size {
  const char* name;
  double major_m, pitch_m, height_m, corner_m;
};
constexpr Size kSizes[] = {{"M10", 10e-3, 1.5e-3, 8e-3, 9.25e-3}, {"M16", 16e-3, 2e-3, 10e-3, 13.85e-3}};

test::ThreadShape threadOf(const Size& size, double length_m) {
  test::ThreadShape thread;
  thread.major_m = 0.5 * size.major_m;
  thread.pitch_m = size.pitch_m;
  thread.length_m = length_m;
  thread.columns = 96;
  thread.rows_per_pitch = 16;
  thread.face_steps = 3;
  thread.side_steps = 3;
  return thread;
}

const PartMesh& nutOf(int size) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {double(size)}, [&] {
    test::ThreadShape thread = threadOf(kSizes[size], kSizes[size].height_m);
    thread.clearance_m = kClearance_m;
    return dynamics::makePart(test::makeNut(thread, kSizes[size].corner_m));
  });
}
const PartMesh& rodOf(int size) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {double(size)}, [&] {
    return dynamics::makePart(
        test::makeThreadedRod(threadOf(kSizes[size], kSizes[size].height_m + 4 * kSizes[size].pitch_m)));
  });
}

struct Load {
  int size = 0;
  double force_N = 50, mu = 0.15;
  [[nodiscard]] double theory_Nm() const {
    const Size& s = kSizes[size];
    // The flanks of rod and nut overlap between the nut's crests and the rod's.
    const double outer_m = 0.5 * s.major_m,
                 inner_m = outer_m - 5.0 / 16 * std::sqrt(3.0) * s.pitch_m + kClearance_m;
    const double r_m =
        2.0 / 3 * (std::pow(outer_m, 3) - std::pow(inner_m, 3)) / (outer_m * outer_m - inner_m * inner_m);
    const double lead = s.pitch_m / (2 * kPi * r_m), slope = mu / std::cos(kPi / 6);
    return force_N * r_m * (lead + slope) / (1 - lead * slope);
  }
};

// Member 0 is the case in which the fault was found.
Load loadOf(int member) {
  Load load;
  if (member == 0) return load;
  test::Random random(static_cast<std::uint64_t>(member));
  load.size = member % 4 == 3;
  load.force_N = random.logUniform(10, 500);
  load.mu = random.uniform(0.05, 0.35);
  return load;
}

std::string describe(int member) {
  const Load l = loadOf(member);
  char text[96];
  std::snprintf(text, sizeof text, "%s, %.1f N, friction %.3f: %.4f Nm by theory", kSizes[l.size].name,
                l.force_N, l.mu, l.theory_Nm());
  return text;
}

// The torque rises evenly, from a share of the theoretical torque, until the nut has turned by kTurned_rad.
// At the right torque the nut turns by kTurned_rad in two or three steps, so the torque is measured to 1 %.
double error(dynamics::Mode mode, double from, int member) {
  // Points are a millimetre apart, as in scenes that state no spacing.
  static const dynamics::Engine engine = dynamics::vpsEngine({0.25e-3, 1e-3});
  constexpr double kTurned_rad = 0.5e-3, kRise = 0.004, kMost = 1.2;
  constexpr int kSettling = 30;
  const Load load = loadOf(member);
  World world({mode, false, engine});
  world.setGravity(Vec3::Zero());
  world.add(rodOf(load.size), Pose(), true, load.mu);
  // The nut starts lower by the axial clearance of the flanks, less 1 um, so that its upper flanks touch; the
  // force pushes the nut down.
  const double axial_m = kClearance_m * std::tan(kPi / 6) - 1e-6;
  const Placed nut = world.add(nutOf(load.size), Pose::translation({0, 0, -axial_m}), false, load.mu);
  dynamics::TurnCounter turn(nut);
  const auto step = [&](double share) {
    nut.body->applyCentralForce(btVector3(0, 0, btScalar(-load.force_N)));
    nut.body->applyTorque(btVector3(0, 0, btScalar(share * load.theory_Nm())));
    world.step();
  };
  for (int i = 0; i < kSettling; ++i) step(from * i / kSettling);
  const double start_rad = turn.update();
  for (double share = from; share < kMost; share += kRise) {
    step(share);
    if (turn.update() - start_rad > kTurned_rad) return std::abs(share - 1);
  }
  return kMost - 1;
}

}  // namespace

std::vector<Family> loadedThreadFamilies() {
  Family ours;
  ours.key = "M_torque";
  ours.measure = "error of the torque by thread theory, our solver";
  ours.bar = 0.02;
  ours.members = 16;  // each member takes seconds
  ours.every = 13;
  ours.expected_failure = 0.06;
  ours.expected_failure_short = 0;
  ours.measured = [](int member) { return error(dynamics::Mode::Constraint, 0.8, member); };
  ours.describe = describe;
  Family stock = ours;
  stock.key = "M_torque_stock";
  stock.measure = "the same with Bullet's own solver";
  stock.members = 50;
  stock.expected_failure = stock.expected_failure_short = 0.996;
  stock.every = 7;
  stock.measured = [](int member) { return error(dynamics::Mode::ConstraintStock, 0, member); };
  return {ours, stock};
}

}  // namespace vps::families
