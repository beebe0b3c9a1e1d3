// SPDX-License-Identifier: BSD-3-Clause
#include "rows.h"

#include <cmath>

#include "dynamics/heavy_block.h"
#include "dynamics/nut.h"
#include "dynamics/peg.h"
#include "dynamics/ring.h"

namespace vps::bench {

namespace {

using dynamics::Mode;
using dynamics::SceneSettings;

// One engine for each resolution, so that all modes share the models.
SceneSettings settingsFor(const Options& options, Mode mode, const dynamics::Engine& engine) {
  return {mode, options.is_short, engine};
}

void pegRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine();
  for (const Mode mode : options.modes) {
    const auto r = dynamics::dropPeg(settingsFor(options, mode, engine));
    table.add({"peg 10x30, 50 um",
               nameOf(mode),
               {holds("seats", r.isSeated()), reported("height error", r.height_error_m, 1e6, "um"),
                atMost("penetration", r.deepest_m, 10e-6, 1e6, "um"),
                atMost("jitter", r.jitter_m_s, 1e-6, 1, "m/s"), atMost("step", r.step_ms, 0.15, 1, "ms")},
               ""});
  }
}

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

void nutRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine({0.2e-3, 0.3e-3});
  for (const auto& [name, size] :
       {std::pair{"nut M10x1.5", dynamics::kM10}, std::pair{"nut M16x2", dynamics::kM16}})
    for (const Mode mode : options.modes) {
      const SceneSettings settings = settingsFor(options, mode, engine);
      const auto r = dynamics::runNut(settings, size);
      const auto again = dynamics::runNut(settings, size);
      table.add({text("%s, no friction", name),
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

void ringRow(const Options& options, Table& table) {
  const dynamics::Engine engine = dynamics::vpsEngine();
  for (const Mode mode : options.modes) {
    const auto r = dynamics::dropRing(settingsFor(options, mode, engine));
    table.add({"ring over peg",
               nameOf(mode),
               {within("height error", r.height_error_m, 0, 20e-6, 1e6, "um"),
                reported("penetration", r.deepest_m, 1e6, "um"), reported("jitter", r.jitter_m_s, 1, "m/s"),
                reported("step", r.step_ms, 1, "ms"), reported("contact steps", r.contact_steps, 1, "")},
               ""});
  }
}

}  // namespace

const std::vector<Case>& allCases() {
  static const std::vector<Case> cases = {{"peg", pegRow},           {"ladder", ladderRow},
                                          {"ring", ringRow},         {"nut", nutRow},
                                          {"lock", nutFrictionRow},  {"massrest", massRestRow},
                                          {"impact", massImpactRow}, {"longrest", longRestRow}};
  return cases;
}

}  // namespace vps::bench
