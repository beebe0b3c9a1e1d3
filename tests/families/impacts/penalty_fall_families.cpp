// SPDX-License-Identifier: BSD-3-Clause
// L: equal blocks, one above the other with small gaps, fall together on a plate in penalty contact.
//
// A block of mass m that stops on a spring of stiffness k compresses the spring by v sqrt(m/k). In a column
// of blocks the pressure of an impact depends on the speed and not on the number of blocks, since a wave runs
// up the column, and two impacts at once correspond to at most twice the speed. No contact may therefore be
// deeper than 2 v sqrt(m/k), and the energy may rise by at most m g dt v, the error of Bullet's integration
// for a rising body.
#include <cmath>
#include <cstdio>

#include "dynamics/world.h"
#include "families/family.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using dynamics::World;

constexpr double kGravity_m_s2 = World::kGravity_m_s2;

struct Fall {
  int blocks = 3;
  Vec3 size_m{20e-3, 20e-3, 10e-3};
  double gap_m = 0.1e-3, drop_m = 20e-3, stiffness_N_per_m3 = 1e12, dt_s = 1e-3;

  [[nodiscard]] double speed_m_s() const { return std::sqrt(2 * kGravity_m_s2 * drop_m); }
};

// Member 0 is the case in which the fault was found. Blocks have one of a few sizes, so that they share
// models.
Fall fallOf(int member) {
  Fall fall;
  if (member == 0) return fall;
  test::Random random(static_cast<std::uint64_t>(member));
  const Vec3 sizes_m[] = {{20e-3, 20e-3, 10e-3}, {10e-3, 10e-3, 10e-3}, {16e-3, 12e-3, 6e-3}};
  fall.blocks = 2 + random.index(4);
  fall.size_m = sizes_m[random.index(3)];
  fall.gap_m = member % 5 == 0 ? 0 : random.logUniform(1e-6, 2e-3);
  fall.drop_m = random.logUniform(1e-3, 50e-3);
  fall.stiffness_N_per_m3 = std::pow(10.0, 11 + random.index(3));
  fall.dt_s = random.chance(0.7) ? 1e-3 : 0.5e-3;
  return fall;
}

std::string describe(int member) {
  const Fall f = fallOf(member);
  char text[160];
  std::snprintf(text, sizeof text,
                "%d blocks %.0fx%.0fx%.0f mm, gaps %.4g mm, %.3g mm high, %g N/m3, dt %g ms", f.blocks,
                1e3 * f.size_m.x(), 1e3 * f.size_m.y(), 1e3 * f.size_m.z(), 1e3 * f.gap_m, 1e3 * f.drop_m,
                f.stiffness_N_per_m3, 1e3 * f.dt_s);
  return text;
}

const dynamics::Engine& engineFor(double stiffness_N_per_m3) {
  static std::map<double, dynamics::Engine> engines;
  const auto it = engines.find(stiffness_N_per_m3);
  if (it != engines.end()) return it->second;
  bullet::Settings settings;
  settings.stiffness_N_per_m3 = stiffness_N_per_m3;
  return engines.emplace(stiffness_N_per_m3, dynamics::vpsEngine({0.5e-3, 1e-3}, settings)).first->second;
}

const PartMesh& boxPart(const Vec3& size_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {size_m.x(), size_m.y(), size_m.z()},
                            [&] { return dynamics::makePart(makeBox(size_m)); });
}

// Depth of the lowest corner of `upper` below the top face of `lower`. The blocks are equal and stay above
// each other, so no other measure of depth is less.
double depth_m(const Placed& upper, const Vec3& upper_m, const Placed* lower, const Vec3& lower_m) {
  const Pose X_lower = lower ? lower->pose() : Pose::translation({0, 0, -0.5 * lower_m.z()});
  const Pose X = X_lower.inverse() * upper.pose();
  double lowest_m = 1e300;
  for (const Vec3& v : makeBox(upper_m).vertices) lowest_m = std::min(lowest_m, (X * v).z());
  return 0.5 * lower_m.z() - lowest_m;
}

struct Result {
  double depth = 0;   ///< greatest depth over v sqrt(m/k)
  double energy = 0;  ///< greatest rise of the energy above that at the start, over m g dt v of all blocks
};

Result runFall(const Fall& fall) {
  const Vec3 plate_m(60e-3, 60e-3, 6e-3);
  World world({dynamics::Mode::Penalty, false, engineFor(fall.stiffness_N_per_m3)});
  world.add(boxPart(plate_m), Pose::translation({0, 0, -0.5 * plate_m.z()}), true);
  std::vector<Placed> blocks;
  for (int i = 0; i < fall.blocks; ++i)
    blocks.push_back(world.add(
        boxPart(fall.size_m),
        Pose::translation({0, 0, fall.drop_m + 0.5 * fall.size_m.z() + i * (fall.size_m.z() + fall.gap_m)})));
  const auto energy_J = [&] {
    double sum = 0;
    for (const Placed& b : blocks)
      sum += dynamics::kineticEnergy_J(*b.body) + dynamics::heightEnergy_J(*b.body);
    return sum;
  };
  const double mass_kg = blocks[0].part.frame.mass_kg, v = fall.speed_m_s();
  const double k_N_per_m = fall.stiffness_N_per_m3 * fall.size_m.x() * fall.size_m.y();
  const double start_J = energy_J();
  Result result;
  const int steps = static_cast<int>((v / kGravity_m_s2 + 0.1) / fall.dt_s);
  for (int step = 0; step < steps; ++step) {
    world.step(1, fall.dt_s);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const double d_m = i == 0 ? depth_m(blocks[0], fall.size_m, nullptr, plate_m)
                                : depth_m(blocks[i], fall.size_m, &blocks[i - 1], fall.size_m);
      result.depth = std::max(result.depth, d_m / (v * std::sqrt(mass_kg / k_N_per_m)));
    }
    result.energy = std::max(
        result.energy, (energy_J() - start_J) / (fall.blocks * mass_kg * kGravity_m_s2 * fall.dt_s * v));
  }
  return result;
}

const Result& resultOf(int member) {
  static std::map<int, Result> results;
  const auto it = results.find(member);
  return it != results.end() ? it->second : results.emplace(member, runFall(fallOf(member))).first->second;
}

}  // namespace

std::vector<Family> penaltyFallFamilies() {
  Family depth;
  depth.key = "L_depth";
  depth.measure = "depth over v sqrt(m/k)";
  depth.bar = 2;
  depth.members = 60;
  depth.expected_failure = 1457;
  depth.expected_failure_short = 1149;
  depth.every = 9;
  depth.measured = [](int member) { return resultOf(member).depth; };
  depth.describe = describe;
  Family energy = depth;
  energy.key = "L_energy";
  energy.measure = "energy above that at the start, over m g dt v";
  energy.bar = 1;
  energy.expected_failure = 30.06;
  energy.expected_failure_short = 28.74;
  energy.measured = [](int member) { return resultOf(member).energy; };
  return {depth, energy};
}

}  // namespace vps::families
