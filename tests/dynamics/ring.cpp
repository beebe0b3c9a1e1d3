// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include <algorithm>
#include <cmath>

#include "support/fit.h"
#include "support/lathe.h"

namespace vps::dynamics {

namespace {

constexpr double kRingHeight_m = 10e-3, kBore_m = 5e-3,
                 kRingClearance_m = 0.1e-3;  // radius of the bore; diametral clearance
constexpr int kRingSegments = 256;

// 256 x 2 x (2 x 12 + 2 x 8) = 20,480 triangles.
Mesh makeRing() {
  const Vec3 up(0, 0, kRingHeight_m / 2);
  return test::sweptSections(kRingSegments, [&](int i) {
    const double angle_rad = test::kTurn_rad * (i % kRingSegments) / kRingSegments;
    const Vec3 in = test::polar(kBore_m, angle_rad, 0), out = test::polar(10e-3, angle_rad, 0);
    std::vector<Vec3> loop;
    test::appendLine(loop, out - up, out + up, 12);
    test::appendLine(loop, out + up, in + up, 8);
    test::appendLine(loop, in + up, in - up, 12);
    test::appendLine(loop, in - up, out - up, 8);
    return loop;
  });
}

// A plate whose top is z = 0, with a chamfered peg of 20 mm on it.
Mesh makePegOnPlate() {
  const double r = kBore_m - kRingClearance_m / 2;
  return test::lathe(
      {{0, -5e-3}, {15e-3, -5e-3}, {15e-3, 0}, {r, 0}, {r, 19e-3}, {r - 1e-3, 20e-3}, {0, 20e-3}},
      kRingSegments);
}

}  // namespace

RingResult dropRing(const SceneSettings& settings) {
  static const PartMesh post_part = makePart(makePegOnPlate()), ring_part = makePart(makeRing());
  World world(settings);
  const Placed post = world.add(post_part, Pose(), true);
  // The ring starts around the peg: dropped over the peg's end, GImpact's ring is thrown off with any margin.
  const Pose start(rotationFromVector(Vec3(1e-3, 0.5e-3, 0)), Vec3(10e-6, 5e-6, 5e-3 + kRingHeight_m / 2));
  const Placed ring = world.add(ring_part, start);
  RingResult result;
  result.deepest_m = -1e300;
  StepTimes contact;
  const int steps = settings.is_short ? 600 : 2000, watched = settings.is_short ? 100 : 500;
  for (int i = 0; i < steps; ++i) {
    world.step();
    if (world.contactCount() > 0) contact.step_s.push_back(world.times().step_s.back());
    if (i % 10 == 0)
      result.deepest_m = std::max(result.deepest_m, penetration_m(post.part, Pose(), ring.part, ring.pose()));
    if (i >= steps - watched) result.jitter_m_s = std::max(result.jitter_m_s, ring.speed_m_s());
  }
  result.rest_height_m = ring.pose().p.z();
  result.height_error_m = result.rest_height_m - kRingHeight_m / 2;
  result.contact_steps = static_cast<int>(contact.step_s.size());
  result.step_ms = 1e3 * contact.mean_s();
  return result;
}

}  // namespace vps::dynamics
