// SPDX-License-Identifier: BSD-3-Clause
#include "rows.h"

#include <cmath>

#include "dynamics/scenes.h"

namespace vps::bench {

namespace {

using dynamics::Mode;
using dynamics::SceneSettings;

// One engine for each resolution, so that all modes share the models.
SceneSettings settingsFor(const Options& options, Mode mode, const dynamics::Engine& engine) {
  return {mode, options.is_short, engine};
}

// A peg that is engaged by less than mu times its diameter can wedge, like a real peg (Whitney 1982: the line
// between the two contacts is within both friction cones). At 1 degree and mu 0.15, or at 2 degrees and mu
// 0.1, the peg stays tilted in the mouth, at rest. The friction is therefore lower for a greater tilt.
void pegRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine();
  constexpr double kDegree_rad = M_PI / 180;
  for (const Mode mode : options.modes) {
    dynamics::PegDropResult worst;
    bool seats = true;
    for (const auto& [tilt_deg, mu] : {std::pair{0.5, 0.15}, std::pair{1.0, 0.1}, std::pair{2.0, 0.05}}) {
      dynamics::PegDrop drop;
      drop.tilt_rad = tilt_deg * kDegree_rad;
      drop.friction = mu;
      const auto r = dynamics::dropPeg(settingsFor(options, mode, engine), drop);
      seats &= r.isSeated();
      if (std::abs(r.height_error_m) > std::abs(worst.height_error_m))
        worst.height_error_m = r.height_error_m;
      worst.deepest_m = std::max(worst.deepest_m, r.deepest_m);
      worst.jitter_m_s = std::max(worst.jitter_m_s, r.jitter_m_s);
      worst.step_ms = std::max(worst.step_ms, r.step_ms);
    }
    table.add(
        {"peg 10x30, 50 um",
         nameOf(mode),
         {holds("seats", seats), reported("height error", worst.height_error_m, 1e6, "um"),
          atMost("penetration", worst.deepest_m, 10e-6, 1e6, "um"),
          atMost("jitter", worst.jitter_m_s, 1e-6, 1, "m/s"), atMost("step", worst.step_ms, 0.15, 1, "ms")},
         "worst of three: 0.5, 1 and 2 degrees of tilt with friction 0.15, 0.1 and 0.05"});
  }
}

// With 0.2 degrees and mu 0.1 the peg enters a clearance of 5 um without wedging: engagement = clearance /
// tilt = 1.4 mm, more than mu D = 1 mm.
void ladderRow(const Options& options, Table& table) {
  for (const Mode mode : options.modes) {
    Row row{"clearance ladder", nameOf(mode), {}, "coarsest voxel that seats:"};
    double least_ratio = 1e300;
    std::vector<dynamics::Engine> engines;
    const std::vector<double> voxels_m = {1e-3, 0.5e-3, 0.25e-3, 0.125e-3};
    for (const double voxel_m : voxels_m) engines.push_back(dynamics::vpsEngine({voxel_m, 0.5e-3}));
    for (const double clearance_m : {100e-6, 50e-6, 20e-6, 10e-6, 5e-6}) {
      bool seats = false;
      double coarsest_m = 0;
      dynamics::PegDrop drop;
      drop.clearance_m = clearance_m;
      drop.tilt_rad = 0.2 * M_PI / 180;
      drop.friction = 0.1;
      for (std::size_t v = 0; v < voxels_m.size() && !seats; ++v) {
        const auto r = dynamics::dropPeg(settingsFor({options.modes, true}, mode, engines[v]), drop);
        seats = r.isSeated();
        if (seats) coarsest_m = voxels_m[v];
      }
      row.figures.push_back(holds(text("%.0f um seats", clearance_m * 1e6), seats));
      if (!seats) continue;
      row.note +=
          text(" %.0f um %.3g mm (%.3g);", clearance_m * 1e6, coarsest_m * 1e3, clearance_m / coarsest_m);
      least_ratio = std::min(least_ratio, clearance_m / coarsest_m);
    }
    row.figures.push_back(reported("least clearance/voxel that seats", least_ratio, 1, ""));
    table.add(row);
  }
}

// Points are 0.3 mm apart, as in the other rows of nuts, or 1 mm, as in scenes that state no spacing.
void nutRow(const Options& options, Table& table) {
  for (const auto& [name, size] :
       {std::pair{"nut M10x1.5", dynamics::kM10}, std::pair{"nut M16x2", dynamics::kM16}})
    for (const Mode mode : options.modes)
      for (const double spacing_m : {0.3e-3, 1e-3}) {
        const dynamics::Engine engine = dynamics::vpsEngine({0.2e-3, spacing_m});
        if (mode == Mode::Penalty && spacing_m > 0.3e-3)
          continue;  // in penalty contact the points share the area, so 0.3 mm is enough
        const SceneSettings settings = settingsFor(options, mode, engine);
        const auto r = dynamics::runNut(settings, size);
        const auto again = dynamics::runNut(settings, size);
        table.add({text("%s, no friction, points every %.1f mm", name, 1e3 * spacing_m),
                   nameOf(mode),
                   {within("a", r.acceleration_m_s2, r.theory_m_s2, 0.01 * r.theory_m_s2, 1, "m/s2"),
                    within("advance", r.advance_m, size.pitch_m, 0.01 * size.pitch_m, 1e3, "mm/turn"),
                    atMost("tilt", r.tilt_rad * 180 / M_PI, 0.05, 1, "deg"),
                    holds("repeats exactly", r.hash == again.hash), reported("turns", r.turns, 1, ""),
                    reported("penetration", r.deepest_m, 1e6, "um"), reported("step", r.step_ms, 1, "ms")},
                   ""});
      }
}

void nutFrictionRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine({0.2e-3, 0.3e-3});
  for (const auto& [name, size] :
       {std::pair{"nut M10x1.5", dynamics::kM10}, std::pair{"nut M16x2", dynamics::kM16}})
    for (const Mode mode : options.modes) {
      const SceneSettings settings = settingsFor(options, mode, engine);
      const double theory = dynamics::selfLockTheory(size);
      const double mu = dynamics::selfLockFriction(settings, size);
      const double watched_s = options.is_short ? 2 : 60;
      const double creep_m =
          dynamics::turnWithFriction_rad(settings, size, theory + 0.005, watched_s) * size.major_m / 2;
      table.add({text("%s, friction", name),
                 nameOf(mode),
                 {within("locks at mu", mu, theory, 0.005, 1, ""),
                  atMost(text("moves in %.0f s at mu + 0.005", watched_s), creep_m, 10e-6, 1e6, "um")},
                 ""});
    }
}

void massRestRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine();
  for (const Mode mode : options.modes) {
    const auto r = dynamics::loadPeg(settingsFor(options, mode, engine), {});
    table.add({"1:1000 at rest on the peg",
               nameOf(mode),
               {atMost("penetration", r.deepest_m, 10e-6, 1e6, "um"),
                atMost("energy gained", r.energy_gained_J, 1e-6, 1e6, "uJ"),
                reported("speed", r.speed_m_s, 1, "m/s"), reported("peg", r.peg_height_m, 1e6, "um"),
                reported("block", r.block_height_m, 1e6, "um"), reported("step", r.step_ms, 1, "ms")},
               ""});
  }
}

void massImpactRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine();
  for (const Mode mode : options.modes) {
    dynamics::HeavyBlock load;
    load.speed_m_s = 0.5;
    const auto r = dynamics::loadPeg(settingsFor(options, mode, engine), load);
    table.add(
        {"1:1000 impact at 0.5 m/s",
         nameOf(mode),
         {atMost("penetration", r.deepest_m, 0.5e-3, 1e6, "um"),
          atMost("comes to rest: speed", r.speed_m_s, 1e-3, 1, "m/s"),
          within("seated: peg", r.peg_height_m, 0, 10e-6, 1e6, "um"),
          reported("block", r.block_height_m, 1e6, "um"), reported("final penetration", r.final_m, 1e6, "um"),
          reported("energy gained", r.energy_gained_J, 1, "J"), reported("step", r.step_ms, 1, "ms")},
         ""});
  }
}

void longRestRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine();
  for (const Mode mode : options.modes) {
    const auto r = dynamics::restPeg(settingsFor(options, mode, engine));
    table.add({text("at rest for %.0f s", r.rest_s),
               nameOf(mode),
               {atMost("drift", r.drift_m, 1e-6, 1e6, "um"), reported("step", r.step_ms, 1, "ms")},
               ""});
  }
}

void gearRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine();
  for (const Mode mode : options.modes) {
    const auto r = dynamics::runGears(settingsFor(options, mode, engine));
    table.add(
        {"gears 20:30, module 2",
         nameOf(mode),
         {atMost(text("drift of the ratio over %.3g turns", r.turns), r.ratio_drift_rad, 1e-4, 1e6, "urad"),
          reported("at any moment", r.ratio_error_rad, 1e6, "urad"),
          within("torque", r.torque_share, 1, 0.02, 1, "of the drive's"),
          reported("penetration", r.deepest_m, 1e6, "um"), reported("step", r.step_ms, 1, "ms")},
         ""});
  }
}

void heapRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::heapEngine();
  for (const Mode mode : options.modes) {
    const auto r = dynamics::dropHeap(settingsFor(options, mode, engine));
    table.add({text("heap of %d", r.bodies),
               nameOf(mode),
               {holds(text("all sleep (%d after %.2f s)", r.asleep, r.asleep_s), r.asleep == r.bodies),
                holds("none escapes", r.escaped == 0), reported("points each", r.points, 1, ""),
                reported("penetration at the end", r.final_m, 1e6, "um"),
                reported("step median", r.step_ms[0], 1, "ms"), reported("p99", r.step_ms[1], 1, "ms"),
                reported("worst", r.step_ms[2], 1, "ms"), reported("our share", r.our_share, 100, "%")},
               ""});
  }
}

void createdInsideRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine({0.5e-3, 1e-3});
  for (const Mode mode : options.modes)
    for (const double depth_m : {0.5e-3, 4e-3}) {
      const auto r = dynamics::createInside(settingsFor(options, mode, engine), depth_m);
      table.add(
          {text("created %.1f mm inside", depth_m * 1e3),
           nameOf(mode),
           {atMost("kinetic energy", r.kinetic_J, mode == Mode::Penalty ? r.overlap_J : 1e-9, 1e6, "uJ"),
            atMost("overlap left", r.left_m, 1e-6, 1e6, "um"), reported("overlap", r.overlap_m, 1e3, "mm"),
            reported("fastest", r.speed_m_s, 1, "m/s"),
            reported("energy of the overlap in penalty contact", r.overlap_J, 1, "J")},
           ""});
    }
}

void proxyRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine({0.5e-3, 1e-3});
  for (const Mode mode : options.modes) {
    const auto r = dynamics::leadProxyThrough(settingsFor(options, mode, engine));
    table.add(
        {"the proxy never collides",
         nameOf(mode),
         {atMost("contacts", r.responses, 0, 1, ""), atMost("moves others", r.disturbed_m, 0, 1e6, "um"),
          within("part in hand above the plate", r.held_m, 0, 10e-6, 1e6, "um")},
         ""});
  }
}

void wallRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine({0.5e-3, 1e-3});
  for (const Mode mode : options.modes)
    for (const bool is_turned : {false, true}) {
      const auto r = dynamics::shootAtWall(settingsFor(options, mode, engine), 50, is_turned);
      // A corner that hits at 50 m/s rotates the block by more than Bullet's limit of pi / 4 a step, so that
      // its other end lands between two steps: the depth is reported, and staying in front is judged.
      Row row{is_turned ? "50 m/s at a 2 mm wall, corner first" : "50 m/s at a 2 mm wall, face on",
              nameOf(mode),
              {holds("stays in front", r.beyond_m < 0), reported("speed after", r.speed_m_s, 1, "m/s")},
              ""};
      row.figures.push_back(is_turned ? reported("penetration", r.deepest_m, 1e6, "um")
                                      : atMost("penetration", r.deepest_m, 10e-6, 1e6, "um"));
      table.add(row);
    }
}

}  // namespace

const std::vector<Case>& allCases() {
  static const std::vector<Case> cases = {
      {"peg", pegRow},           {"ladder", ladderRow},        {"ring", ringRow},
      {"nut", nutRow},           {"lock", nutFrictionRow},     {"massrest", massRestRow},
      {"impact", massImpactRow}, {"gears", gearRow},           {"heap", heapRow},
      {"longrest", longRestRow}, {"inside", createdInsideRow}, {"proxy", proxyRow},
      {"wall", wallRow},         {"query", queryRow},          {"shapes", shapesRow},
      {"pairs", pairQueryRow},   {"first", firstStepRow},      {"hulls", hullRow, true}};
  return cases;
}

}  // namespace vps::bench
