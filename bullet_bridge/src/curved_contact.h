// SPDX-License-Identifier: BSD-3-Clause
// Where two curved faces are nearest: between the points of their shells.
#pragma once

#include "candidate.h"

namespace vps {

/// Faces whose normals are within 20 degrees of opposite touch flush.
inline constexpr double kCosFlush = 0.94;

/// Moves a face's point along its part's surface to where the gap to the other's curved surface is least, if
/// that is within the shell's spacing of it: p_W, distance and normal become those there, on the exact
/// surfaces. A ball of 5 mm with points 0.5 mm apart lies 12 um deeper between them, and the normals of
/// points beside the contact lean by 0.05 rad, which a hand that slides it feels.
/// @param c  corrected: its normal is the other's at the point's foot
/// @param most_gain_m  by how much the gap may be less there: candidates are found by their points' gaps, and
///                     what is nearer by more than the slack that they are looked for with would come and go
/// @return false: left as it was. Flat and conforming faces (a peg in its bore) cost one comparison or a look
/// at each surface; others three or four looks more.
/// Source: Newton's method for the common normal, with the curvature of both (Johnson, Contact Mechanics,
/// 1985, section 4.1: the gap between two surfaces).
bool moveToNearest(Candidate& c, const SideView& side, const SideView& other, double most_gain_m);

}  // namespace vps
