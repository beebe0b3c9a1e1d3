// SPDX-License-Identifier: BSD-3-Clause
// Curves and rates of a live run.
#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "view/timeline.h"

namespace vps::viewer {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::string ratesOf(const char* name, std::uint64_t count, std::uint64_t since, double elapsed_s,
                    double p99_us, std::uint64_t missed) {
  char words[120];
  std::snprintf(words, sizeof words, "%s: %.0f a second, p99 %.0f µs, %llu missed", name,
                elapsed_s > 0 ? static_cast<double>(count - since) / elapsed_s : 0, p99_us,
                static_cast<unsigned long long>(missed));
  return words;
}

}  // namespace

std::vector<Curve> liveCurves() {
  return {{"force", "N", {}},   {"torque", "N m", {}},   {"depth", "um", {}},
          {"contacts", "", {}}, {"clearance", "um", {}}, {"energy injected", "mJ", {}}};
}

void addInstant(Timeline& line, const scenes::Snapshot& shot, std::optional<double> clearance_m) {
  double depth_m = 0;
  for (const scenes::ContactMark& mark : shot.contacts) depth_m = std::max(depth_m, mark.depth_m);
  line.time_s.push_back(shot.time_s);
  line.end_s = shot.time_s;
  const std::array<double, 6> values = {shot.has_hand ? shot.F_hand_W.f.norm() : 0,
                                        shot.has_hand ? shot.F_hand_W.tau.norm() : 0,
                                        depth_m * 1e6,
                                        static_cast<double>(shot.contacts.size()),
                                        clearance_m ? *clearance_m * 1e6 : kUnknown,
                                        shot.figures ? shot.figures->injected_J * 1e3 : kUnknown};
  for (std::size_t i = 0; i < std::min(values.size(), line.curves.size()); ++i)
    line.curves[i].values.push_back(static_cast<float>(values[i]));
}

void addChapters(Timeline& line, std::size_t step, double time_s,
                 const std::function<std::string(std::size_t step)>& name) {
  for (std::size_t i = line.chapters.size() - 1; i <= step; ++i)
    line.chapters.push_back({name(i), time_s, ""});
}

std::vector<std::string> figureLines(const scenes::RunFigures& now, const scenes::RunFigures& before,
                                     double elapsed_s) {
  // The energies take two lines, since one would be too long for the panel, and ImGui breaks lines within a
  // number.
  char energy[80], injected[80];
  std::snprintf(energy, sizeof energy, "energy: %.3g mJ to the hand, %.3g from it", 1e3 * now.to_hand_J,
                1e3 * now.from_hand_J);
  std::snprintf(injected, sizeof injected, "energy injected: %.3g mJ", 1e3 * now.injected_J);
  return {ratesOf("haptic ticks", now.ticks, before.ticks, elapsed_s, now.tick_p99_us, now.missed),
          ratesOf("physics steps", now.physics_steps, before.physics_steps, elapsed_s, now.step_p99_us,
                  now.physics_missed),
          energy, injected};
}

}  // namespace vps::viewer
