// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <string>

#include "lossy_hand.h"
#include "procedure/assembly_run.h"
#include "rows.h"

namespace vps::bench {

namespace {

struct Case {
  double physics_rate_hz;
  int delay_ticks;
  double lost;
};

Row runScene(const std::string& name, const Case& c) {
  scenes::Scene scene = scenes::loadScene(std::string(VPS_SCENE_FOLDER) + "/" + name + "/scene.toml");
  scene.fidelity.physics_rate_hz = c.physics_rate_hz;
  LossyHand hand(scene, {c.delay_ticks, c.lost, 1});
  const device::LoopSettings settings = scenes::loopSettings(scene, hand.device());
  const scenes::AssembleResult result = scenes::runProcedure(scene, hand, nullptr, settings, {});
  const auto done = std::count_if(result.steps.begin(), result.steps.end(),
                                  [](const scenes::StepResult& s) { return s.completed; });
  return {text("injected_J, %s, physics %.0f Hz, %d ticks, %.0f%% lost", name.c_str(), c.physics_rate_hz,
               c.delay_ticks, 100 * c.lost),
          text("%.2f kN/m, real encoders", settings.gains.k_N_per_m / 1000),
          {atMost("at the handle", hand.energy().injected_J, 1e-3, 1e3, "mJ"),
           atMost("as the loop reports it", result.energy.injected_J, 1e-3, 1e3, "mJ"),
           reported("to hand", result.energy.to_hand_J, 1e3, "mJ"),
           reported("from hand", result.energy.from_hand_J, 1e3, "mJ"),
           reported(text("steps done of %zu:", result.steps.size()), static_cast<double>(done), 1, ""),
           reported("simulated", result.simulated_s, 1, "s")},
          ""};
}

}  // namespace

void injectedRow(const HapticOptions& options, Table& table) {
  for (const std::string name : {"peg_in_hole", "bearing_block"})
    for (const double physics_rate_hz : {1000.0, 100.0})
      for (int ticks = 0; ticks <= 3; ++ticks) {
        if (options.is_short && (name != "peg_in_hole" || ticks % 3 != 0)) continue;
        table.add(runScene(name, {physics_rate_hz, ticks, 0.05}));
      }
}

}  // namespace vps::bench
