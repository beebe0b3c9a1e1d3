// SPDX-License-Identifier: BSD-3-Clause
// A callback that throws at its n-th call ends the work: it is not called again, and the exception arrives.
#include "vps/stoppable.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "support/stop_at.h"
#include "vps/mesh.h"
#include "vps/mesh_repair.h"
#include "vps/pointshell.h"
#include "vps/solid.h"
#include "vps/voxmap.h"

namespace vps {
namespace {

/// Balls that cross each other, one without some facets: repair, union and winding numbers are all needed.
Mesh crossingBalls() {
  Mesh mesh = makeSphere(10e-3, 3);
  append(mesh, transformed(makeSphere(10e-3, 3), Pose::translation(Vec3(8e-3, 1e-3, 0))));
  Mesh open = transformed(makeSphere(10e-3, 3), Pose::translation(Vec3(0, 15e-3, 2e-3)));
  open.triangles.resize(open.triangles.size() * 9 / 10);
  append(mesh, open);
  return mesh;
}

TEST(Stoppable, TheRepairOfAMeshEndsAtAnyCall) {
  const Mesh mesh = welded(crossingBalls());
  EXPECT_GT(test::stopAtEveryCall([&](const Progress& progress) {
              const StoppableWork work(progress, "repairing");
              repairMesh(mesh);
            }),
            5);
}

TEST(Stoppable, ASolidEndsAtAnyCall) {
  const Mesh mesh = crossingBalls();
  EXPECT_GT(test::stopAtEveryCall([&](const Progress& progress) {
              const StoppableWork work(progress, "solid");
              const Solid made(mesh);
            }),
            5);
}

TEST(Stoppable, AVoxmapEndsAtAnyCall) {
  const Mesh mesh = crossingBalls();
  VoxMapSettings settings;
  settings.voxel_m = 2e-3;
  EXPECT_GT(
      test::stopAtEveryCall([&](const Progress& progress) { buildVoxMap(mesh, settings, "", progress); }),
      10);
}

TEST(Stoppable, APointshellEndsAtAnyCall) {
  const Mesh mesh = makeSphere(10e-3, 2);
  PointShellSettings settings;
  settings.spacing_m = 1e-3;
  EXPECT_GT(
      test::stopAtEveryCall([&](const Progress& progress) { buildPointShell(mesh, settings, "", progress); }),
      10);
}

TEST(Stoppable, PollingChangesNoBitOfTheResult) {
  const Mesh mesh = welded(crossingBalls());
  const RepairedMesh alone = repairMesh(mesh);
  const Progress progress = [](std::string_view, double) {};
  const StoppableWork work(progress);
  const RepairedMesh polled = repairMesh(mesh);
  EXPECT_EQ(alone.solid.triangles, polled.solid.triangles);
  EXPECT_EQ(alone.solid.vertices, polled.solid.vertices);
  EXPECT_EQ(alone.surface.triangles, polled.surface.triangles);
}

TEST(Stoppable, AllThreadsEndSoonAfterTheStop) {
  std::atomic<int> begun = 0, begun_at_stop = -1;
  const Progress progress = [&](std::string_view, double) {
    if (begun < 1000 || begun_at_stop >= 0) return;
    begun_at_stop = begun.load();
    throw test::StopAsked();
  };
  const StoppableWork work(progress, "counting");
  EXPECT_THROW(onAllCores(10'000'000, [&](std::size_t) { ++begun; }), test::StopAsked);
  ASSERT_GE(begun_at_stop, 1000);
  // Between two polls a thread begins one unit; a thread that the system suspends meanwhile begins none.
  EXPECT_LE(begun, begun_at_stop + 64 * static_cast<int>(std::thread::hardware_concurrency() + 1));
}

TEST(Stoppable, OnlyTheInnermostWorkIsAskedAndAnotherThreadHasNone) {
  int outer = 0, inner = 0;
  const Progress of_outer = [&](std::string_view, double) { ++outer; },
                 of_inner = [&](std::string_view, double) {
                   ++inner;
                   pollStop();  // within the callback there is no work
                 };
  const auto poll = [] {
    for (unsigned i = 0; i < 2 * StoppableWork::kPollsPerCall; ++i) pollStop();
  };
  const StoppableWork work(of_outer);
  {
    const StoppableWork within(of_inner);
    poll();
    EXPECT_GE(inner, 2);
    EXPECT_EQ(outer, 0);
    const int before = inner;
    std::thread(poll).join();
    EXPECT_EQ(inner, before);
    const Progress none;
    const StoppableWork without(none);  // leaves the enclosing work in force
    poll();
    EXPECT_GT(inner, before);
  }
  poll();
  EXPECT_GE(outer, 2);
}

TEST(Stoppable, ALateReportDoesNotLowerTheShare) {
  std::vector<double> shares;
  const Progress progress = [&](std::string_view, double share) { shares.push_back(share); };
  StoppableWork work(progress);
  work.report("a", 0.5);
  work.report("a", 0.25);
  work.report("b", 0);
  EXPECT_EQ(shares, (std::vector<double>{0.5, 0.5, 0}));
}

}  // namespace
}  // namespace vps
