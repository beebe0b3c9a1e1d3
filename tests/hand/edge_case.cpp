// SPDX-License-Identifier: BSD-3-Clause
#include "edge_case.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "search/faults.h"

namespace vps::hand {

namespace {

constexpr double kPress_s = 5;  // timeout for a peg that is too large, which needs no long trial

PegFit fitOf(bool is_round, int size_mm, bool has_chamfer, int clearance_um) {
  PegFit fit;
  fit.is_round = is_round;
  fit.size_m = 1e-3 * size_mm;
  fit.longer_m = is_round ? 0 : 0.5 * fit.size_m;
  fit.clearance_m = 1e-6 * clearance_um;
  fit.chamfer_m = has_chamfer ? 0.5e-3 : 0;
  fit.depth_m = 1.25 * fit.size_m;
  fit.outer_m = 0.5 * fit.size_m + 5e-3;
  fit.hole_turn_rad = is_round ? std::numbers::pi / kFlats : 0;
  return fit;
}

}  // namespace

std::vector<EdgeCase> edgeCases(std::uint64_t seed) {
  std::vector<EdgeCase> cases;
  for (const bool is_round : {true, false})
    for (const int size_mm : {4, 8, 12, 16})
      for (const bool has_chamfer : {false, true})
        for (const bool is_faulty : {false, true})
          for (int clearance_um = -50; clearance_um <= 50; clearance_um += 5)
            cases.push_back({fitOf(is_round, size_mm, has_chamfer, clearance_um), is_faulty, seed++});
  return cases;
}

std::string rowName(const EdgeCase& edge) {
  char text[80];
  std::snprintf(text, sizeof text, "%s %.0f mm %s %s", edge.fit.is_round ? "round" : "rectangular",
                1e3 * edge.fit.size_m, edge.fit.chamfer_m > 0 ? "chamfered" : "sharp",
                edge.is_faulty ? "faulty" : "closed");
  return text;
}

std::string caseName(const EdgeCase& edge) {
  char text[32];
  std::snprintf(text, sizeof text, " %.0f um", 1e6 * edge.fit.clearance_m);
  return rowName(edge) + text;
}

scenes::Scene edgeScene(const EdgeCase& edge) {
  Mesh hole = holeMesh(edge.fit), peg = pegMesh(edge.fit);
  if (edge.is_faulty) {
    test::Random random(edge.seed);
    hole = search::withFaults(hole, random);
    peg = search::withFaults(peg, random);
  }
  scenes::Scene scene =
      pegScene(caseName(edge), std::move(hole), std::move(peg), edge.fit.depth_m, edge.seed);
  if (edge.fit.clearance_m < 0) scene.steps[0].timeout_s = kPress_s;
  return scene;
}

double edgeBand_m(const EdgeCase& edge) {
  return 2e-6 + 2 * chord_m(edge.fit);
}

EdgeOutcome outcomeOf(const EdgeCase& edge, scenes::Verdict verdict) {
  const double clearance_m = edge.fit.clearance_m, band_m = edgeBand_m(edge);
  const bool is_within = std::abs(clearance_m) <= band_m;
  if (verdict == scenes::Verdict::NotShown)
    return is_within ? EdgeOutcome::NotShown : clearance_m > 0 ? EdgeOutcome::MissedFit : EdgeOutcome::Wrong;
  if (is_within) return EdgeOutcome::Right;
  return (verdict == scenes::Verdict::Fits) == (clearance_m > 0) ? EdgeOutcome::Right : EdgeOutcome::Wrong;
}

}  // namespace vps::hand
