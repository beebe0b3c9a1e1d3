// SPDX-License-Identifier: BSD-3-Clause
// I: a block starts exactly flush on a plate, with a velocity along it. The block must move like a block that
// starts 0.1 um above the plate. A block that starts half a micrometre above a plate without friction must
// keep its velocity, even if it passes many points of the plate in one step.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::World;

struct Start {
  Vec3 size_m{20e-3, 20e-3, 10e-3};
  Vec3 over_m{8e-3, 0, 0};  ///< how far the block is beyond the plate's edges at +x and +y
  Vec3 v_W{-0.5, 0, 0};
  double mu = 0.15;
  double turn_rad = 0;  ///< rotation of the scene about z, by right angles: flush to the bit
};

constexpr double kPlate_m = 60e-3, kThick_m = 6e-3;

// Member 0 is the case in which the fault was found. Every fourth block lies on the plate as a whole.
Start startOf(int member) {
  Start start;
  if (member == 0) return start;
  test::Random random(static_cast<std::uint64_t>(member));
  const Vec3 sizes_m[] = {
      {20e-3, 20e-3, 10e-3}, {10e-3, 10e-3, 10e-3}, {24e-3, 12e-3, 5e-3}, {8e-3, 16e-3, 12e-3}};
  start.size_m = sizes_m[random.index(4)];
  // Less than half of the block is beyond the edge; otherwise the block would tip.
  const double x = random.uniform(0.02, 0.45) * start.size_m.x(),
               y = random.uniform(0.02, 0.3) * start.size_m.y();
  const int kind = member % 4;
  start.over_m = kind == 0   ? Vec3(-20e-3, -20e-3, 0)
                 : kind == 1 ? Vec3(0.25 * x, 0.8 * y, 0)
                             : Vec3(x, -20e-3, 0);
  const double speed_m_s = random.logUniform(0.01, 2), heading_rad = random.uniform(-1.2, 1.2);
  const Vec3 inward(-std::cos(heading_rad), std::sin(heading_rad), 0);
  start.v_W = speed_m_s * (random.chance(0.7) ? inward : Vec3(-1, 0, 0));
  start.mu = random.chance(0.5) ? 0 : random.uniform(0.05, 0.4);
  start.turn_rad = 0.5 * std::numbers::pi * random.index(4);
  return start;
}

std::string describe(int member) {
  const Start s = startOf(member);
  char text[160];
  std::snprintf(text, sizeof text,
                "block %.0fx%.0fx%.0f mm, beyond the edges by %.2f and %.2f mm, v %.3f, %.3f m/s, mu %.2f",
                1e3 * s.size_m.x(), 1e3 * s.size_m.y(), 1e3 * s.size_m.z(), 1e3 * s.over_m.x(),
                1e3 * s.over_m.y(), s.v_W.x(), s.v_W.y(), s.mu);
  return text;
}

const PartMesh& boxPart(const Vec3& size_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {size_m.x(), size_m.y(), size_m.z()},
                            [&] { return dynamics::makePart(makeBox(size_m)); });
}

std::vector<Vec3> pathOf(const Start& start, double gap_m) {
  static const dynamics::Engine engine = dynamics::vpsEngine();
  constexpr int kSteps = 30;
  // The matrix of right angles is exact, so that flush faces stay flush.
  Mat3 R = rotationFromVector({0, 0, start.turn_rad});
  for (int i = 0; i < 9; ++i) R.data()[i] = std::round(R.data()[i]);
  World world({dynamics::Mode::Constraint, false, engine});
  world.add(boxPart({kPlate_m, kPlate_m, kThick_m}), Pose(R, Vec3(0, 0, -0.5 * kThick_m)), true, start.mu);
  const Vec3 center = Vec3(0.5 * kPlate_m, 0.5 * kPlate_m, 0) -
                      0.5 * Vec3(start.size_m.x(), start.size_m.y(), 0) + start.over_m +
                      Vec3(0, 0, 0.5 * start.size_m.z() + gap_m);
  const dynamics::Placed block = world.add(boxPart(start.size_m), Pose(R, R * center), false, start.mu);
  block.body->setLinearVelocity(bullet::toBt(Vec3(R * start.v_W)));
  std::vector<Vec3> path;
  for (int i = 0; i < kSteps; ++i) {
    world.step();
    path.push_back(R.transpose() * block.pose().p);
  }
  return path;
}

double difference_m(int member) {
  const Start start = startOf(member);
  const std::vector<Vec3> flush = pathOf(start, 0), above = pathOf(start, 0.1e-6);
  double most_m = 0;
  for (std::size_t i = 0; i < flush.size(); ++i) most_m = std::max(most_m, (flush[i] - above[i]).norm());
  return most_m;
}

struct Slide {
  Vec3 size_m{20e-3, 20e-3, 10e-3};
  double v_m_s = 1.3, heading_rad = 0, rate_hz = 1000;
};

// In members 0 to 2 the fault was found.
Slide slideOf(int member) {
  if (member < 3) return {.v_m_s = member == 0 ? 1.3 : member == 1 ? 5 : 10};
  test::Random random(0x51d0 + static_cast<std::uint64_t>(member));
  Slide slide;
  slide.size_m = Vec3(random.uniform(6e-3, 30e-3), random.uniform(6e-3, 30e-3), random.uniform(4e-3, 12e-3));
  constexpr double kRates_hz[] = {250, 1000, 4000};
  slide.rate_hz = kRates_hz[random.index(3)];
  slide.v_m_s = random.logUniform(0.2, 10) * slide.rate_hz / 1000;
  slide.heading_rad = random.uniform(0, 6.2);
  return slide;
}

std::string describeSlide(int member) {
  const Slide s = slideOf(member);
  char text[128];
  std::snprintf(text, sizeof text, "block %.0fx%.0fx%.0f mm, %.3f m/s, heading %.2f, %g Hz",
                1e3 * s.size_m.x(), 1e3 * s.size_m.y(), 1e3 * s.size_m.z(), s.v_m_s, s.heading_rad,
                s.rate_hz);
  return text;
}

// Relative change of the velocity after 100 mm or 20 steps.
double slideError(int member) {
  static const dynamics::Engine engine = dynamics::vpsEngine();
  const Slide slide = slideOf(member);
  World world({dynamics::Mode::Constraint, false, engine});
  world.add(boxPart({400e-3, 400e-3, kThick_m}), Pose::translation({0, 0, -0.5 * kThick_m}), true, 0);
  const dynamics::Placed block =
      world.add(dynamics::makePart(makeBox(slide.size_m)),
                Pose::translation({0, 0, 0.5 * slide.size_m.z() + 0.5e-6}), false, 0);
  const Vec3 v(slide.v_m_s * std::cos(slide.heading_rad), slide.v_m_s * std::sin(slide.heading_rad), 0);
  block.body->setLinearVelocity(bullet::toBt(v));
  const int steps = std::clamp(static_cast<int>(0.1 / slide.v_m_s * slide.rate_hz), 10, 20);
  world.step(steps, 1 / slide.rate_hz);
  return (bullet::fromBt(block.body->getLinearVelocity()) - v).norm() / slide.v_m_s;
}

}  // namespace

std::vector<Family> flushStartFamilies() {
  // The bar: the gap itself, and 1 um for the friction of a hundredth of a step that is missing while the gap
  // closes, in 30 steps.
  constexpr double kFlush_m = 2e-6;
  return {{"I_flush", "distance from a start 0.1 um above, 30 steps [m]", kFlush_m, 60, 6, difference_m,
           describe},
          {"I_slides", "relative change of velocity of a block that slides without friction", 1e-3, 60, 6,
           slideError, describeSlide}};
}

}  // namespace vps::families
