// SPDX-License-Identifier: BSD-3-Clause
// Two gears of the heap while it falls: a tooth's tip slides out of the other's bore at 1.4 m/s, over its
// rim. The plane of the bore's facet that it faced lets it by, the rim's edges are passed one after the
// other, and the face that it is then in was in front of it at the start, below which it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "dynamics/heap.h"
#include "vps_bullet/convert.h"

namespace vps::dynamics {
namespace {

/// Of a body in the world.
struct State {
  Eigen::Quaterniond q;
  Vec3 p_m, v_m_s, w_rad_s;
};

// Without that face, 13 of the first 40 were 2 to 32 um deep after their first step.
TEST(SlidingGears, ATipThatLeavesABoreOverItsRimStaysOutside) {
  const PartMesh part = makeHeapGear();
  const Engine engine = heapEngine();
  const std::array<State, 2> states{State{{0.892710405, 0.027460799, 0.395735765, 0.21379252},
                                          {0.017427508, 0.0207874916, 0.0287547902},
                                          {-0.276511257, 0.0346279288, -0.191116916},
                                          {-9.76016382, -32.1502426, 8.54991993}},
                                    State{{0.535618403, -0.115619575, -0.813448718, 0.195054412},
                                          {0.0204341177, 0.0200501616, 0.0444690544},
                                          {0.114372476, 0.0222057151, -1.11981244},
                                          {12.9653597, -30.8098397, -8.10856841}}};
  std::mt19937 random(3);
  std::normal_distribution<double> speed_m_s(0, 0.3), rate_rad_s(0, 3);
  for (int i = 0; i < 100; ++i) {
    World world({Mode::Constraint, false, engine});
    std::vector<Placed> gears;
    for (const State& state : states) {
      gears.push_back(world.add(part, Pose(state.q.normalized().toRotationMatrix(), state.p_m), false, 0.3));
      Vec3 v_m_s = state.v_m_s, w_rad_s = state.w_rad_s;
      for (double& each : v_m_s) each += speed_m_s(random);
      for (double& each : w_rad_s) each += rate_rad_s(random);
      gears.back().body->setLinearVelocity(bullet::toBt(v_m_s));
      gears.back().body->setAngularVelocity(bullet::toBt(w_rad_s));
    }
    for (int step = 0; step < 6; ++step) {
      world.step();
      // Points tolerate a twentieth of the margin of 20 um, and a little more in each step.
      EXPECT_LE(penetration_m(part, gears[0].pose(), part, gears[1].pose()), 1.5e-6)
          << "case " << i << ", step " << step;
    }
  }
}

}  // namespace
}  // namespace vps::dynamics
