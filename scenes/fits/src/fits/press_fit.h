// SPDX-License-Identifier: BSD-3-Clause
// Interference fits: whether an overlap is the declared one, its volume, and the force that presses the parts
// together.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Whether the pair's state can depend on its fits: the pair clashes and has a declared press fit, or its
/// meshes touch or overlap by no more than the distance of the facets from the true faces.
bool needsFit(const CheckedPair& pair);

/// Removes fits whose interference is greater than the overlap of the parts. The two faces of such a fit do
/// not belong together.
void removeFalseFits(CheckResult& result);

/// Judges the pairs by the fits that were found. The radii of a fit come from corners, which lie on the true
/// faces, so an interference that the facets hide is found and is a clash. An overlap of no more than the
/// declared interference is a press fit, and its fits receive pressure and force.
void judgeByFits(const std::vector<PlacedSurface>& parts, CheckResult& result);

/// Two thick-walled cylinders, one pressed into the other.
struct PressedRing {
  double joint_m = 0, hub_m = 0, hole_m = 0;  ///< diameters: of the joint, outside of the hub, shaft's hole
  double length_m = 0, friction = 0;
  double shaft_modulus_Pa = 0, shaft_ratio = 0;  ///< Young's modulus, Poisson's ratio
  double hub_modulus_Pa = 0, hub_ratio = 0;
};

/// Pressure in the joint for a diametral interference [Pa]. Source: Lame; Shigley's Mechanical Engineering
/// Design, 10th ed., eq. (3-56).
double jointPressure(const PressedRing& ring, double interference_m);

/// The volume shared by a shaft and a bore with interference, and a bound of its error.
struct RingVolume {
  double volume_m3 = 0, error_m3 = 0;
};

/// The volume shared by the true cylinders of a fit with interference: pi / 4 (shaft^2 - bore^2) length,
/// times the share of the ring in which both parts have material. The share with material is sampled at 64
/// angles and 16 places along the axis. The error consists of the error of the diameters and of the cells
/// between a sample with material and a sample without material. A keyway or groove narrower than a cell is
/// missed.
/// @param aside_m distance of the samples from the cylinders, greater than the distance of the meshes from
/// the cylinders
RingVolume ringVolume(const CheckedFit& fit, const PlacedSurface& shaft, const PlacedSurface& bore,
                      double aside_m);

}  // namespace vps::scenes
