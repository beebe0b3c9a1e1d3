// SPDX-License-Identifier: BSD-3-Clause
// Compares the shapes from which a user of Bullet can choose: a convex part drops into a fixed part that is
// not convex.
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "dynamics/scenes.h"
#include "rivals.h"
#include "rows.h"
#include "vps_bullet/convert.h"

namespace vps::bench {

namespace {

constexpr double kClearance_m = 50e-6;

double residentBytes() {
  long pages = 0, resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Mean time of a ray that goes down through the bore.
double rayTime_s(const dynamics::Engine& engine, int count) {
  dynamics::World world({dynamics::Mode::ConstraintStock, true, engine});
  world.add(dynamics::borePart(kClearance_m), Pose(), true);
  world.step();
  const double start_s = dynamics::threadTime_s();
  for (int i = 0; i < count; ++i) {
    const double x_m = 15e-3 * (2.0 * i / count - 1);
    const btVector3 from = bullet::toBt(Vec3(x_m, 1e-3, 10e-3)), to = bullet::toBt(Vec3(-x_m, -1e-3, -20e-3));
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world.bullet().rayTest(from, to, hit);
  }
  return (dynamics::threadTime_s() - start_s) / count;
}

Row rowOf(const Options& options, const char* name, const dynamics::Engine& engine, dynamics::Mode mode) {
  const double before = residentBytes(), start_s = dynamics::threadTime_s();
  const auto bore = engine.makeShape(dynamics::borePart(kClearance_m), true),
             peg = engine.makeShape(dynamics::pegPart(), false);
  const double built_s = dynamics::threadTime_s() - start_s, bytes = residentBytes() - before;
  const auto r = dynamics::dropPeg({mode, options.is_short, engine}, {.clearance_m = kClearance_m});
  return {"peg 10x30, 50 um, shapes",
          name,
          {{r.isSeated() ? "seats" : "does not seat", "", true},
           reported("build", built_s, 1e3, "ms"),
           reported("memory", bytes, 1e-6, "MB"),
           reported("step", r.step_ms, 1, "ms"),
           reported("deepest", std::max(0.0, r.deepest_m), 1e6, "um"),
           reported("height error", r.height_error_m, 1e6, "um"),
           reported("jitter", r.jitter_m_s, 1, "m/s"),
           reported("ray", rayTime_s(engine, options.is_short ? 100 : 2000), 1e6, "us")},
          ""};
}

}  // namespace

void shapesRow(const Options& options, Table& table) {
  using dynamics::Mode;
  // The meshes are made once, before the memory of a shape is measured.
  dynamics::borePart(kClearance_m);
  dynamics::pegPart();
  table.addRival(rowOf(options, "VPS", dynamics::vpsEngine(), Mode::Constraint));
  table.addRival(rowOf(options, "VPS, Bullet's solver", dynamics::vpsEngine(), Mode::ConstraintStock));
  table.addRival(rowOf(options, "GImpact, margin 20 um", gimpactEngine(20e-6), Mode::ConstraintStock));
  table.addRival(rowOf(options, "btBvhTriangleMesh, hull", bvhEngine(), Mode::ConstraintStock));
  table.addRival(rowOf(options, "hull, hull", hullEngine(), Mode::ConstraintStock));
}

}  // namespace vps::bench
