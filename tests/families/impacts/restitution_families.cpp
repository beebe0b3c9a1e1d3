// SPDX-License-Identifier: BSD-3-Clause
// B: restitution never makes energy, keeps momentum, and passes an impact along a row.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "families/family.h"
#include "families/impacts/impact_world.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/solver.h"

namespace vps::families {
namespace {

using dynamics::Mode;
using dynamics::PartMesh;
using dynamics::Placed;
using test::Random;

constexpr double kGravity_m_s2 = dynamics::World::kGravity_m_s2;
constexpr std::array<double, 5> kSteps_s{0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3};
const Vec3 kCube_m(20e-3, 20e-3, 10e-3);

double anyStep_s(Random& random) {
  return kSteps_s[static_cast<std::size_t>(random.index(static_cast<int>(kSteps_s.size())))];
}

/// Cubes above each other, dropped together onto a plate.
struct Drop {
  int count = 3;
  double gap_m = 0.1e-3, height_m = 20e-3, restitution = 1, friction = 0.15, dt_s = 1e-3, tilt_rad = 0;
  bool is_heap = false;  ///< a wall of bricks, which the solver treats as a heap

  // The first members are the cases in which the fault was found.
  explicit Drop(int member, bool heap = false) : is_heap(heap) {
    constexpr std::array<std::pair<int, double>, 6> kFound{
        {{2, 1}, {3, 1}, {4, 1}, {5, 1}, {3, 0.8}, {5, 0.5}}};
    Random random(0xb0 + static_cast<std::uint64_t>(member));
    if (!heap && member < static_cast<int>(kFound.size())) {
      count = kFound[static_cast<std::size_t>(member)].first;
      restitution = kFound[static_cast<std::size_t>(member)].second;
      return;
    }
    count = heap ? 14 + random.index(6) : 1 + random.index(6);
    gap_m = random.chance(0.2) ? 0 : random.logUniform(1e-6, 2e-3);
    height_m = random.logUniform(3e-3, 60e-3);
    restitution = random.chance(0.3) ? 1 : random.uniform(0.05, 1);
    friction = random.chance(0.3) ? 0 : random.uniform(0.05, 0.6);
    dt_s = anyStep_s(random);
    tilt_rad = random.chance(0.5) ? 0 : random.uniform(0, 0.3);
  }

  /// Centre of a cube, relative to the middle of the lowest face.
  [[nodiscard]] Vec3 place(int i) const {
    const double level_m = kCube_m.z() + gap_m;
    if (!is_heap) return {0, 0, 0.5 * kCube_m.z() + i * level_m};
    const int row = i / 4;
    return {(i % 4 - 1.5 + 0.5 * (row % 2)) * (kCube_m.x() + gap_m), 0, 0.5 * kCube_m.z() + row * level_m};
  }
  /// Greatest energy above that of the start, in units of m g dt v with the greatest speed.
  [[nodiscard]] double gained(Mode mode) const {
    ImpactWorld scene(mode);
    scene.addFixed(boxPart(Vec3(0.2, 0.2, 0.02)), Pose::translation(Vec3(0, 0, -0.01)), 1, friction);
    // The stack is tilted about the middle of its lowest face, and raised by the distance by which the tilt
    // lowers the edges of this face.
    const Mat3 R = rotationFromVector(Vec3(0.6, 0.8, 0) * tilt_rad);
    const Vec3 base(0, 0, height_m + tilt_rad * (is_heap ? 0.05 : 0.015));
    for (int i = 0; i < count; ++i)
      scene.add(boxPart(kCube_m), Pose(R, base + R * place(i)), restitution, friction);
    const double start_J = scene.energy_J();
    double most_J = 0, top_m_s = std::sqrt(2 * kGravity_m_s2 * base.z());
    const int steps = static_cast<int>((is_heap ? 0.15 : 0.4) / dt_s);
    for (int k = 0; k < steps; ++k) {
      scene.world.step(1, dt_s);
      most_J = std::max(most_J, scene.energy_J() - start_J);
    }
    return most_J / (scene.mass_kg() * kGravity_m_s2 * dt_s * top_m_s);
  }
  [[nodiscard]] std::string words() const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%d cubes, gap %.3g mm, dropped %.3g mm, e %.2f, mu %.2f, tilt %.2f, %.2g ms", count,
                  1e3 * gap_m, 1e3 * height_m, restitution, friction, tilt_rad, 1e3 * dt_s);
    return text;
  }
};

/// Equal cubes in a row without friction or gravity. The first cubes fly at the other cubes, which are at
/// rest. With e = 1 the same number of cubes leaves at the other end, at the same speed.
struct Row {
  int count = 3, moving = 1;
  double gap_m = 0.1e-3, speed_m_s = 1, dt_s = 1e-3;
  Mat3 R = Mat3::Identity();

  explicit Row(int member) {
    Random random(0xb1 + static_cast<std::uint64_t>(member));
    if (member < 2) {
      count = member == 0 ? 3 : 5;
      return;
    }
    count = 2 + random.index(6);
    moving = 1 + random.index(std::min(2, count - 1));
    gap_m = random.chance(0.3) ? 0 : random.logUniform(1e-7, 3e-3);
    speed_m_s = random.logUniform(0.3, 20);
    dt_s = anyStep_s(random);
    if (random.chance(0.5)) R = random.rotation();
  }
  /// Greatest error of a velocity, relative to the velocity of the first cube.
  [[nodiscard]] double error(Mode mode) const {
    ImpactWorld scene(mode);
    scene.world.setGravity(Vec3::Zero());
    for (int i = 0; i < count; ++i) {
      const Placed body =
          scene.add(boxPart(kCube_m), Pose(R, R * Vec3(i * (kCube_m.x() + gap_m), 0, 0)), 1, 0);
      setVelocity(body, i < moving ? Vec3(R * Vec3(speed_m_s, 0, 0)) : Vec3(0, 0, 0));
    }
    const double way_m = count * (gap_m + 1e-6);
    scene.world.step(static_cast<int>(std::ceil(way_m / (speed_m_s * dt_s))) + 3 * count + 10, dt_s);
    double worst = 0;
    for (int i = 0; i < count; ++i) {
      const double wanted_m_s = i >= count - moving ? speed_m_s : 0;
      const Vec3 v = velocityOf(scene.bodies[static_cast<std::size_t>(i)]);
      worst = std::max(worst, (v - R * Vec3(wanted_m_s, 0, 0)).norm() / speed_m_s);
    }
    return worst;
  }
  [[nodiscard]] std::string words() const {
    char text[160];
    std::snprintf(text, sizeof text, "%d cubes, %d of them at %.3g m/s, gap %.3g mm, %.2g ms", count, moving,
                  speed_m_s, 1e3 * gap_m, 1e3 * dt_s);
    return text;
  }
};

/// A cube that flies without rotation into a corner of one to three walls, which the cube reaches in the same
/// step or in different steps. Each wall has its own restitution and reverses the velocity component along
/// its normal.
struct Corner {
  int walls = 3;
  double e[3] = {1, 1, 1};
  Vec3 gap_m, v_m_s;
  double dt_s = 1e-3;
  Mat3 R = Mat3::Identity();

  /// @param fast_mm  range of the greatest travel along an axis in a step; without it the travel is less than
  /// the spacing of points. If a body travels by more than four voxels in a step, it is queried at several
  /// poses.
  explicit Corner(int member, std::optional<std::pair<double, double>> fast_mm = {}) {
    Random random(0xb2 + static_cast<std::uint64_t>(member));
    Random speed(0xb5 + static_cast<std::uint64_t>(member));
    const double travel_m = fast_mm ? 1e-3 * speed.logUniform(fast_mm->first, fast_mm->second) : 0.8e-3;
    walls = 1 + member % 3;
    dt_s = kSteps_s[static_cast<std::size_t>(
        random.index(3))];  // no speed is below Bullet's threshold of restitution, 0.2 m/s
    const bool is_at_once = random.chance(0.5);
    const double share = random.uniform(0, 1.5);
    for (int i = 0; i < 3; ++i) {
      e[i] = random.chance(0.3) ? 1 : random.chance(0.2) ? 0 : random.uniform(0.05, 1);
      v_m_s[i] = random.logUniform(0.35, 1) * travel_m / dt_s;
      gap_m[i] = v_m_s[i] * dt_s * (is_at_once ? share : random.uniform(0, 3));
    }
    if (random.chance(0.5)) R = random.rotation();
  }
  [[nodiscard]] double error(Mode mode) const {
    ImpactWorld scene(mode);
    scene.world.setGravity(Vec3::Zero());
    for (int i = 0; i < walls; ++i) {
      Vec3 size_m = Vec3::Constant(0.2), at = Vec3::Zero();
      size_m[i] = 0.02;
      at[i] = -0.5 * (size_m[i] + kCube_m[i]) - gap_m[i];
      scene.addFixed(boxPart(size_m), Pose(R, R * at), e[i], 0);
    }
    const Placed body = scene.add(boxPart(kCube_m), Pose(R, Vec3(0, 0, 0)), 1, 0);
    setVelocity(body, -(R * v_m_s));
    scene.world.step(8, dt_s);
    Vec3 wanted = -v_m_s;
    for (int i = 0; i < walls; ++i) wanted[i] = e[i] * v_m_s[i];
    return (velocityOf(body) - R * wanted).norm() / v_m_s.norm();
  }
  [[nodiscard]] std::string words() const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%d walls, e %.2f %.2f %.2f, v %.2f %.2f %.2f m/s, gaps %.3g %.3g %.3g mm, %.2g ms", walls,
                  e[0], e[1], e[2], v_m_s[0], v_m_s[1], v_m_s[2], 1e3 * gap_m[0], 1e3 * gap_m[1],
                  1e3 * gap_m[2], 1e3 * dt_s);
    return text;
  }
};

Corner fastCorner(int member) {
  return Corner(member, std::pair(0.8, 5.0));
}
// An impact within a step is computed with the lever arm that the contact point has at the start of the step.
// If the contact point is fixed to the other body, the lever arm at the time of the impact differs by the
// distance that the cube slides along that body until then, here up to half of the cube's size.
Corner fasterCorner(int member) {
  return Corner(member, std::pair(5.0, 10.0));
}

/// Bodies of several shapes, masses and restitutions that fly at each other and spin, in free space.
struct Swarm {
  int count = 2;
  double dt_s = 1e-3, friction = 0;
  std::uint64_t seed;

  explicit Swarm(int member) : seed(0xb3 + static_cast<std::uint64_t>(member)) {
    Random random(seed);
    count = 2 + random.index(4);
    dt_s = anyStep_s(random);
    friction = random.chance(0.3) ? 0 : random.uniform(0.05, 0.6);
  }
  void fill(ImpactWorld& scene) const {
    static const std::array<Vec3, 3> kSizes{kCube_m, Vec3(15e-3, 15e-3, 15e-3), Vec3(8e-3, 30e-3, 12e-3)};
    scene.world.setGravity(Vec3::Zero());
    Random random(seed + 1000);
    for (int i = 0; i < count; ++i) {
      const PartMesh& part = boxPart(kSizes[static_cast<std::size_t>(random.index(3))]);
      const Vec3 at = Vec3((i % 2) * 38e-3, (i / 2) * 38e-3, 0) + random.inBox(Vec3::Constant(2e-3));
      const Placed body = scene.add(part, Pose(random.rotation(), at),
                                    random.chance(0.3) ? 1 : random.uniform(0, 1), friction);
      const Vec3 to_middle = Vec3(19e-3, count > 2 ? 19e-3 : 0, 0) - at;
      setVelocity(body, random.uniform(0.5, 4) * to_middle.normalized() + 0.3 * random.direction(),
                  random.uniform(0, 30) * random.direction());
    }
  }
  [[nodiscard]] int steps() const { return static_cast<int>(0.06 / dt_s); }
  /// Changes of momentum, each the greatest over time, relative to the sum of the momenta of the single
  /// bodies.
  struct Changes {
    double linear = 0;
    double angular = 0;            ///< in steps in which the solver separated no bodies by a push
    double angular_of_pushes = 0;  ///< in steps with a push, which changes positions but not velocities
  };
  [[nodiscard]] Changes changes() const {
    ImpactWorld scene;
    fill(scene);
    const auto& solver = dynamic_cast<const bullet::Solver&>(*scene.world.bullet().getConstraintSolver());
    const Momentum start = scene.momentum();
    const auto [linear, angular] = scene.momentumScale();
    Changes most;
    Vec3 by_steps = Vec3::Zero(), by_pushes = Vec3::Zero();
    for (int k = 0; k < steps(); ++k) {
      const Vec3 before = scene.momentum().angular;
      const std::size_t pushed = solver.pushedSteps();
      scene.world.step(1, dt_s);
      const Momentum now = scene.momentum();
      (solver.pushedSteps() == pushed ? by_steps : by_pushes) += now.angular - before;
      most.linear = std::max(most.linear, (now.linear - start.linear).norm() / linear);
      most.angular = std::max(most.angular, by_steps.norm() / angular);
      most.angular_of_pushes = std::max(most.angular_of_pushes, by_pushes.norm() / angular);
    }
    return most;
  }
  [[nodiscard]] double energyRise() const {
    ImpactWorld scene;
    fill(scene);
    const double start_J = scene.energy_J(false);
    double most_J = start_J;
    for (int k = 0; k < steps(); ++k) {
      scene.world.step(1, dt_s);
      most_J = std::max(most_J, scene.energy_J(false));
    }
    return most_J / start_J - 1;
  }
  [[nodiscard]] std::string words() const {
    char text[100];
    std::snprintf(text, sizeof text, "%d bodies, mu %.2f, %.2g ms", count, friction, 1e3 * dt_s);
    return text;
  }
};

template <typename Member>
auto wordsOf() {
  return [](int member) { return Member(member).words(); };
}

}  // namespace

std::vector<Family> restitutionFamilies() {
  const std::string gained = "energy gained over that at the start [m g dt v]";
  const std::string error = "greatest error of a velocity, over the first cube's velocity";
  std::vector<Family> all{
      {"B_cubes", gained, 1, 100, 5, [](int i) { return Drop(i).gained(Mode::Constraint); }, wordsOf<Drop>()},
      {"B_heaps", gained, 1, 50, 10, [](int i) { return Drop(i, true).gained(Mode::Constraint); },
       [](int i) { return Drop(i, true).words(); }},
      {"B_rows", error, 0.01, 100, 5, [](int i) { return Row(i).error(Mode::Constraint); }, wordsOf<Row>()},
      {"B_corners", error, 0.01, 99, 5, [](int i) { return Corner(i).error(Mode::Constraint); },
       wordsOf<Corner>()},
      {"B_fast_corners", error, 0.01, 99, 5, [](int i) { return fastCorner(i).error(Mode::Constraint); },
       [](int i) { return fastCorner(i).words(); }},
      {"B_faster_corners", error, 0.01, 99, 4, [](int i) { return fasterCorner(i).error(Mode::Constraint); },
       [](int i) { return fasterCorner(i).words(); }},
      {"B_momentum", "change of momentum, relative", 1e-9, 60, 6,
       [](int i) { return Swarm(i).changes().linear; }, wordsOf<Swarm>()},
      {"B_angular_momentum", "change of angular momentum in steps without a push, relative", 1e-9, 60, 6,
       [](int i) { return Swarm(i).changes().angular; }, wordsOf<Swarm>()},
      {"B_angular_pushes", "change of angular momentum in steps with a push, relative", 1e-9, 60, 6,
       [](int i) { return Swarm(i).changes().angular_of_pushes; }, wordsOf<Swarm>(), 2.4052e-7, 2.4052e-7},
      {"B_free_energy", "kinetic energy gained, relative", 1e-9, 60, 6,
       [](int i) { return Swarm(i).energyRise(); }, wordsOf<Swarm>()},
  };
  for (Family& family : bounceFamilies()) all.push_back(std::move(family));
  for (Family& family : massRatioFamilies()) all.push_back(std::move(family));
  return all;
}

}  // namespace vps::families
