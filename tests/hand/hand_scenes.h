// SPDX-License-Identifier: BSD-3-Clause
// Scenes for the virtual operator: pegs and blind holes with a known clearance, and nuts above threaded rods.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::hand {

/// A peg that stands upright in a blind hole, whose mouth is at z = 0.
struct PegFit {
  bool is_round = true;      ///< else rectangular
  double size_m = 8e-3;      ///< diameter, or the shorter side, of the peg
  double longer_m = 0;       ///< the longer side of a rectangle less the shorter one
  double clearance_m = 0;    ///< diametral; negative: the peg is too large
  double chamfer_m = 0;      ///< at 45 degrees, of peg and hole; 0: sharp edges
  double depth_m = 10e-3;    ///< of the hole; the peg is 2.5 times as long
  double outer_m = 12e-3;    ///< from the axis to the outer side of the part with the hole
  double hole_turn_rad = 0;  ///< of the hole about its axis
  bool has_wall = true;      ///< false: only the bottom of the hole is left, a plate
};

/// Round parts are drawn with this many flats. The hole's flats touch its circle from outside and the peg's
/// corners lie on its own circle, so that the clearance of the drawn parts is never less than that of the
/// circles, and equals it where the corners point at the middle of the flats.
inline constexpr int kFlats = 128;
/// Distance of the middle of a flat from its circle, at the radius.
double chord_m(const PegFit& fit);

Mesh holeMesh(const PegFit& fit);
Mesh pegMesh(const PegFit& fit);
/// The peg starts 8 mm above the mouth.
scenes::Scene pegScene(const std::string& name, Mesh hole, Mesh peg, double depth_m, std::uint64_t seed);

struct PegScene {
  const char* name;
  const char* description;
  scenes::Scene (*make)(std::uint64_t seed);
};

/// round: 8 mm, 20 um of diametral clearance, 0.5 mm chamfers at 45 degrees, 10 mm deep.
/// rectangular: 4 mm square, 50 um of clearance on each side, sharp edges, 8 mm deep.
const std::vector<PegScene>& pegScenes();

/// A nut with a coarse right-hand thread (12 mm, pitch 3 mm) above an upright rod. The target is depth_m
/// below the height at which the nut meets the rod.
scenes::Scene coarseThread(double depth_m, std::uint64_t seed);

/// coarseThread(), aimed with a standard deviation of six degrees, so that the nut may start crossed.
scenes::Scene leaningNut(double depth_m, std::uint64_t seed);

/// The nut of coarseThread() over a smooth rod, on which no thread catches.
scenes::Scene smoothRod(double depth_m, std::uint64_t seed);

/// The nut and bolt in the folder $VPS_CAD_DIR/thread-m16-loose, from above the first thread. Throws
/// LoadError without this folder.
scenes::Scene looseM16(double depth_m, std::uint64_t seed);

/// coarse_thread: two turns; leaning_nut: one; smooth_rod; m16: 10 mm down, five turns.
const std::vector<PegScene>& threadScenes();

}  // namespace vps::hand
