// SPDX-License-Identifier: BSD-3-Clause
#include "rows.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dynamics/scenes.h"
#include "rivals.h"

namespace vps::bench {

namespace {

using dynamics::Mode;
using dynamics::RingResult;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::vector<Figure> ringFigures(const RingResult& r) {
  return {reported("height error", r.height_error_m, 1e6, "um"),
          reported("penetration", r.deepest_m, 1e6, "um"), reported("jitter", r.jitter_m_s, 1, "m/s"),
          reported("step", r.step_ms, 1, "ms")};
}

// GImpact's shapes touch at twice their margin; with a margin that is too small, triangles pass through each
// other between steps. The best margin is the one with the least height error at rest.
double bestGimpactMargin() {
  double best_m = 0, least_m = 1e300;
  for (const double margin_m : {1e-6, 5e-6, 20e-6, 50e-6}) {
    const RingResult r = dynamics::dropRing({Mode::ConstraintStock, true, gimpactEngine(margin_m)});
    std::fprintf(stderr, "GImpact margin %.0f um: height error %.0f um, penetration %.0f um\n",
                 margin_m * 1e6, r.height_error_m * 1e6, r.deepest_m * 1e6);
    if (std::abs(r.height_error_m) >= least_m) continue;
    least_m = std::abs(r.height_error_m);
    best_m = margin_m;
  }
  return best_m;
}

}  // namespace

void ringRow(const Options& options, Table& table) {
  const double margin_m = bestGimpactMargin();
  const dynamics::Engine ours = dynamics::vpsEngine(), theirs = gimpactEngine(margin_m);
  for (const Mode mode : options.modes) {
    RingResult vps, gimpact;
    std::vector<double> ratios;
    for (int repeat = 0; repeat < (options.is_short ? 1 : 3); ++repeat) {  // alternating, 0.6 s each
      vps = dynamics::dropRing({mode, true, ours});
      gimpact = dynamics::dropRing({Mode::ConstraintStock, true, theirs});
      ratios.push_back(gimpact.step_ms / vps.step_ms);
    }
    if (!options.is_short) vps = dynamics::dropRing({mode, false, ours});
    Row row{
        "ring over peg", nameOf(mode), {within("height error", vps.height_error_m, 0, 20e-6, 1e6, "um")}, ""};
    const double ratio = median(ratios);
    row.figures.push_back({text("%.1f times as fast as GImpact", ratio), ">= 10 times", ratio >= 10});
    row.figures.push_back(reported("penetration", vps.deepest_m, 1e6, "um"));
    row.figures.push_back(reported("jitter", vps.jitter_m_s, 1, "m/s"));
    row.figures.push_back(reported("step", vps.step_ms, 1, "ms"));
    table.add(row);
    if (mode == options.modes.front())
      table.addRival(
          {"ring over peg", text("GImpact, margin %.0f um", margin_m * 1e6), ringFigures(gimpact), ""});
  }
}

// The peg in its bore, which is decomposed into convex hulls.
void hullRow(const Options& options, Table& table) {
  constexpr double kConcavity_m = 50e-6;  // the clearance of the fit
  const std::optional<dynamics::Engine> hulls = hacdEngine(kConcavity_m);
  Row row{"peg 10x30, 50 um", "HACD, concavity 50 um", {}, ""};
  if (hulls) {
    const double start_s = dynamics::threadTime_s();
    hulls->makeShape(dynamics::borePart(50e-6), true);
    hulls->makeShape(dynamics::pegPart(), false);
    const double cut_s = dynamics::threadTime_s() - start_s;
    const auto r = dynamics::dropPeg({Mode::ConstraintStock, options.is_short, *hulls});
    row.figures = {{r.isSeated() ? "seats" : "does not seat", "", true},
                   reported("height error", r.height_error_m, 1e3, "mm"),
                   reported("penetration", r.deepest_m, 1e6, "um"),
                   reported("jitter", r.jitter_m_s, 1, "m/s"),
                   reported("step", r.step_ms, 1, "ms"),
                   reported("cutting", cut_s, 1, "s")};
  } else {
    row.figures.push_back({"not built", "", true});
  }
  table.addRival(row);
}

void queryRow(const Options& options, Table& table) {
  const dynamics::PartMesh &nut = dynamics::nutPart(dynamics::kM16, 96),
                           &rod = dynamics::rodPart(dynamics::kM16, 96);
  // Poses of the nut on the thread, 20 um deep in the lower flanks, each rotated slightly further along the
  // helix.
  std::vector<Pose> poses;
  const double axial_gap_m = 0.1e-3 * std::tan(M_PI / 6);
  for (int i = 0; i < (options.is_short ? 3 : 15); ++i) {
    const double turn_rad = 0.05 * i;
    poses.emplace_back(rotationFromVector(Vec3(0, 0, turn_rad)),
                       Vec3(0, 0, dynamics::kM16.pitch_m * turn_rad / (2 * M_PI) - axial_gap_m - 20e-6));
  }
  std::vector<double> truth_m;
  for (const Pose& X : poses) truth_m.push_back(penetration_m(rod, Pose(), nut, X));
  std::vector<PairQuery> all = {bulletQuery(dynamics::vpsEngine({0.2e-3, 0.3e-3}), rod, nut),
                                bulletQuery(gimpactEngine(1e-6), rod, nut), fclQuery(rod.mesh, nut.mesh),
                                odeQuery(rod.mesh, nut.mesh)};
  all[0].name = "VPS";
  std::vector<std::vector<double>> times_s(all.size());
  std::vector<PairQuery::Answer> last(all.size());
  std::vector<double> worst_error_m(all.size(), 0);
  for (std::size_t p = 0; p < poses.size(); ++p)  // the engines alternate at each pose
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (!all[k].query) continue;
      const double start_s = dynamics::threadTime_s();
      last[k] = all[k].query(poses[p]);
      times_s[k].push_back(dynamics::threadTime_s() - start_s);
      worst_error_m[k] = std::max(worst_error_m[k], std::abs(last[k].deepest_m - truth_m[p]));
    }
  for (std::size_t k = 0; k < all.size(); ++k) {
    Row row{"query, M16 nut on bolt", all[k].name, {}, ""};
    if (!all[k].query) {
      row.figures.push_back({"not built", "", true});
    } else {
      row.figures = {reported("time", median(times_s[k]), 1e3, "ms"),
                     reported("over VPS", median(times_s[k]) / median(times_s[0]), 1, "times"),
                     reported("contacts", last[k].contacts, 1, ""),
                     reported("depth", last[k].deepest_m, 1e6, "um"),
                     reported("worst error of depth", worst_error_m[k], 1e6, "um")};
    }
    if (k == 0)
      row.note = text("%zu + %zu triangles; true depth of vertices %.3g um", rod.mesh.triangles.size(),
                      nut.mesh.triangles.size(), truth_m.back() * 1e6);
    table.addRival(row);
  }
}

}  // namespace vps::bench
