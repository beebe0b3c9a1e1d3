// SPDX-License-Identifier: BSD-3-Clause
#include "scene/thread_form.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "support/screw.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {
namespace {

using test::mirrored;

test::ThreadShape threadOf(double pitch_m, double turns) {
  test::ThreadShape thread;
  thread.pitch_m = pitch_m;
  thread.length_m = turns * pitch_m;
  thread.columns = 96;
  thread.rows_per_pitch = 16;
  return thread;
}

TEST(ThreadForm, LeadAndHandOfRodsAndNuts) {
  for (const double pitch_m : {0.5e-3, 1e-3, 1.75e-3, 3e-3})
    for (const double turns : {3.0, 5.0, 12.0}) {
      const test::ThreadShape thread = threadOf(pitch_m, turns);
      for (const bool is_nut : {false, true}) {
        const Mesh right = is_nut ? test::makeNut(thread, 11e-3) : test::makeThreadedRod(thread);
        // The tolerance is 1 % for five turns, and more for fewer turns, where the rounded ends have more
        // weight.
        const double tol_m = (turns < 5 ? 0.03 : 0.01) * pitch_m;
        for (const double sign : {1.0, -1.0}) {
          const auto form = findThread(sign < 0 ? mirrored(right) : right, {20e-6, 0, 0}, Vec3::UnitZ());
          ASSERT_TRUE(form) << pitch_m << ' ' << turns << ' ' << is_nut;
          EXPECT_NEAR(form->lead_m, sign * pitch_m, tol_m);
          EXPECT_EQ(form->starts, 1);
          EXPECT_EQ(form->is_inside, is_nut);
        }
      }
    }
}

// A thread has the same hand when seen from either end of its axis.
TEST(ThreadForm, DoesNotDependOnTheAxisDirection) {
  const Mesh rod = test::makeThreadedRod(threadOf(1.5e-3, 6));
  const auto up = findThread(rod, Vec3::Zero(), Vec3::UnitZ()),
             down = findThread(rod, Vec3::Zero(), -Vec3::UnitZ());
  ASSERT_TRUE(up && down);
  EXPECT_NEAR(up->lead_m, down->lead_m, 1e-6);
}

// No thread is found on smooth, polygonal and grooved bodies, and on bodies with random corners.
TEST(ThreadForm, IsNotSeenWhereThereIsNone) {
  std::vector<Mesh> bodies = {makeCylinder(5e-3, 20e-3, 60), makeCylinder(5e-3, 20e-3, 6),
                              makeTube(5e-3, 3e-3, 20e-3, 40), makeBox({5e-3, 6e-3, 20e-3}),
                              makeSphere(5e-3, 3)};
  Mesh grooved = makeTube(5e-3, 3e-3, 1e-3, 40);
  for (int i = 1; i < 10; ++i) {
    Mesh ring = makeTube(i % 2 == 0 ? 5e-3 : 4e-3, 3e-3, 1e-3, 40);
    for (Vec3& v : ring.vertices) v.z() += 1e-3 * i;
    append(grooved, ring);
  }
  bodies.push_back(grooved);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> off(-0.5e-3, 0.5e-3);
  Mesh rough = makeSphere(5e-3, 4);
  for (Vec3& v : rough.vertices) v *= 1 + off(random) / 5e-3;
  bodies.push_back(rough);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto form = findThread(bodies[i], Vec3::Zero(), Vec3::UnitZ());
    EXPECT_FALSE(form) << i << ": lead " << (form ? form->lead_m : 0);
  }
}

TEST(ThreadForm, OfTheLooseM16NutAndBolt) {
  const char* folder = std::getenv("VPS_CAD_DIR");
  const std::filesystem::path from =
      std::filesystem::path(folder != nullptr ? folder : "../shared/cad") / "thread-m16-loose";
  if (!std::filesystem::exists(from)) GTEST_SKIP() << from.string() << " does not exist; set VPS_CAD_DIR";
  ImportSettings metres;
  metres.unit_m = 1;
  for (const char* file : {"factory_bolt_m16_loose.obj", "factory_nut_m16_loose_subdiv_3x.obj"}) {
    const auto form =
        findThread(importCad((from / file).string(), metres).parts.at(0).mesh, Vec3::Zero(), Vec3::UnitZ());
    ASSERT_TRUE(form) << file;
    EXPECT_NEAR(form->lead_m, 2e-3, 0.02e-3);
  }
}

}  // namespace
}  // namespace vps::scenes
