// SPDX-License-Identifier: BSD-3-Clause
// C: a nut with restitution on its rod. The threads have a radial clearance of 0.1 mm. The nut crosses it
// within a step of 1 ms and then touches along whole flanks. The nut's depth must equal the depth in the same
// run without restitution.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "dynamics/scenes.h"
#include "families/family.h"
#include "families/impacts/impact_world.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/shape.h"

namespace vps::families {
namespace {

using dynamics::NutSize;
using dynamics::PartMesh;
using dynamics::Placed;

constexpr double kToUm = 1e6, kStep_s = 1e-3;
constexpr NutSize kM20{20e-3, 2.5e-3, 16e-3, 34.6e-3 / 2};
constexpr int kColumns = 192;  // facets per turn: they deviate by 1.3 um from the crest of an M20 rod

enum class Push { Sideways, Along, Gravity };

struct NutHit {
  NutSize size = kM20;
  double restitution = 0.7, speed_m_s = 1;
  Push push = Push::Sideways;
  Vec3 direction = Vec3::UnitX();

  // Member 0 is the case in which the fault was found.
  explicit NutHit(int member) {
    if (member == 0) return;
    constexpr std::array<double, 4> kRestitutions{0.7, 0, 0.3, 1};
    test::Random random(0xc5 + 2 * static_cast<std::uint64_t>(member));
    const auto i = static_cast<std::size_t>(member);
    if (member % 2 == 1) size = dynamics::kM10;
    restitution = kRestitutions[i / 2 % 4];
    push = static_cast<Push>(i / 8 % 3);
    speed_m_s = push == Push::Gravity ? 0 : random.logUniform(0.2, 20);
    const double angle_rad = random.uniform(0, 6.2);
    if (push == Push::Sideways) direction = Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.1);
    if (push == Push::Along) direction = Vec3(0.05, 0, random.chance(0.5) ? 1 : -1);
  }
};

/// Greatest depth by exact distance of the vertices of a part, among the vertices whose distance in the other
/// part's field is within kNear_m.
double deepestVertex_m(const Placed& of, const Pose& X_WP, const Placed& in, const Pose& X_WI) {
  constexpr double kNear_m = 20e-6, kReach_m = 1e-3;  // the field's error on faces is 0.05 voxel of 0.25 mm
  const auto& shape = dynamic_cast<const bullet::Shape&>(*in.body->getCollisionShape());
  // Pose of the frame of the part's map in the frame of the part.
  const Pose X_IM = in.pose().inverse() * bullet::fromBt(in.body->getWorldTransform()) * shape.X_SM();
  const Pose X_IP = X_WI.inverse() * X_WP, X_MI = X_IM.inverse();
  double deepest_m = -1;
  for (const Vec3& p_P : of.part.mesh.vertices) {
    const Vec3 p_I = X_IP * p_P;
    if (shape.models().map->distance(X_MI * p_I) > kNear_m) continue;
    deepest_m = std::max(deepest_m, -in.part.exact->signedDistance(p_I, kReach_m));
  }
  return deepest_m;
}

/// Greatest depth [um] after each step and at its middle.
double nutDepth_um(const NutHit& hit, double restitution) {
  constexpr int kSteps = 40;
  constexpr double kFriction = 0.15;
  static const dynamics::Engine engine = dynamics::vpsEngine({0.25e-3, 1e-3});
  dynamics::World world({dynamics::Mode::Constraint, true, engine});
  if (hit.push != Push::Gravity) world.setGravity(Vec3::Zero());
  const Placed rod = world.add(dynamics::rodPart(hit.size, kColumns), Pose(), true, kFriction);
  rod.body->setRestitution(1);
  const Placed nut = world.add(dynamics::nutPart(hit.size, kColumns),
                               Pose::translation({0, 0, hit.size.pitch_m}), false, kFriction);
  nut.body->setRestitution(bullet::toBt(restitution));
  setVelocity(nut, hit.speed_m_s * hit.direction);
  double deepest_m = -1;
  for (int k = 0; k < kSteps; ++k) {
    const Pose from = nut.pose();
    world.step(1, kStep_s);
    for (const double share : {0.5, 1.0}) {
      const Pose X_WN = interpolate(from, nut.pose(), share);
      deepest_m = std::max(
          {deepest_m, deepestVertex_m(nut, X_WN, rod, Pose()), deepestVertex_m(rod, Pose(), nut, X_WN)});
    }
  }
  return kToUm * deepest_m;
}

double depth_um(int member) {
  const NutHit hit(member);
  return nutDepth_um(hit, hit.restitution);
}

std::string words(int member) {
  const NutHit hit(member);
  constexpr std::array<const char*, 3> kPushes{"sideways", "along the axis", "under gravity"};
  char text[160];
  std::snprintf(text, sizeof text, "M%.0f, %s, %.3g m/s, e %.2f; without restitution %.3g um",
                1e3 * hit.size.major_m, kPushes[static_cast<std::size_t>(hit.push)], hit.speed_m_s,
                hit.restitution, nutDepth_um(hit, 0));
  return text;
}

}  // namespace

std::vector<Family> nutGapFamilies() {
  return {{"C_nuts", "depth of a nut in its rod, after and within steps [um]", 10, 24, 5, depth_um, words}};
}

}  // namespace vps::families
