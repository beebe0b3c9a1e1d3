// SPDX-License-Identifier: BSD-3-Clause
// Interference fits: whether an overlap is the declared one, and what it takes to press the parts together.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// True for a pair whose state may follow from its fits: one with a declared press fit, and one whose meshes
/// overlap by no more than their facets are off the faces.
bool needsFit(const CheckedPair& pair);

/// Leaves out fits whose interference is more than the parts overlap: faces that have nothing to do with each
/// other.
void removeFalseFits(CheckResult& result);

/// Judges the pairs by the fits that were found. Radii come from the corners, which lie on the true faces; an
/// interference that the facets hide is thus a clash. An overlap of no more than declared is a press fit; its
/// fits then say pressure and force.
void judgeByFits(const std::vector<PlacedSurface>& parts, CheckResult& result);

/// Two thick-walled cylinders, one pressed into the other.
struct PressedRing {
  double joint_m = 0, hub_m = 0, hole_m = 0;  ///< diameters: of the joint, outside of the hub, shaft's hole
  double length_m = 0, friction = 0;
  double shaft_modulus_Pa = 0, shaft_ratio = 0;  ///< Young's modulus, Poisson's ratio
  double hub_modulus_Pa = 0, hub_ratio = 0;
};

/// Pressure in the joint for an interference in diameter [Pa]. Source: Lame; Shigley's Mechanical Engineering
/// Design, 10th ed., eq. (3-56).
double jointPressure(const PressedRing& ring, double interference_m);

}  // namespace vps::scenes
