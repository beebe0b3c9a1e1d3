// SPDX-License-Identifier: BSD-3-Clause
// Fits between two parts: a shaft in a bore, a key in a slot, a screw in a nut; and the tolerance that a fit
// gives a part whose step states none.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "fits/faces.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// A part at its pose, with its faces.
struct FittedPart {
  const PlacedSurface& part;
  const FitFaces& faces;
};

/// Appends the fits of a shaft in a bore (two cylinders with a common axis) or of a key in a slot (two
/// parallel faces of one part between two of the other part). The clearance of a fit is at most
/// mostClearance_m(). O(faces of a x faces of b). Thread-safe.
void appendShaftFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);
void appendKeyFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);
/// Appends the fits of an external thread of one part in an internal thread of the other, with a common axis
/// and lead. Removes the shaft fits that were appended before and belong to crests and roots of the threads.
void appendThreadFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);

/// The range in which two faces with nearly parallel axes overlap along the axis of a, as two distances from
/// a.p. The faces do not overlap if the second distance is not greater than the first.
template <class Face, class OtherFace>
std::array<double, 2> commonRange(const Face& a, const OtherFace& b) {
  const double shift_m = a.axis.dot(b.p - a.p), sign = a.axis.dot(b.axis) > 0 ? 1 : -1;
  const double end_m = shift_m + sign * b.from_m, other_end_m = shift_m + sign * b.to_m;
  return {std::max(a.from_m, std::min(end_m, other_end_m)), std::min(a.to_m, std::max(end_m, other_end_m))};
}

/// The greatest clearance at which two faces count as a fit. assumed: a quarter of the size, but at least
/// 0.18 mm, the clearance of H11/c11 in the smallest range of ISO 286 (up to 3 mm), and no more than the size
/// itself.
inline double mostClearance_m(double size_m) {
  return std::max(0.25 * size_m, std::min(0.18e-3, size_m));
}

/// Greatest tolerance that a fit gives a part, apart from the play within the fit. assumed: a usual position
/// tolerance
inline constexpr double kFitTolerance_m = 0.1e-3;
/// Tolerance of a part that no fit guides and that the operator places by eye: five standard deviations of
/// device::OperatorHabits::see_error_m.
inline constexpr double kSightTolerance_m = 0.5e-3;
/// Length added to the clearance of a fit: depths up to 10 um count as contact, and a part may touch on both
/// sides.
inline constexpr double kContactOnBothSides_m = 20e-6;

/// The tolerance of a part's position that a fit of the given clearance gives; a negative clearance counts as
/// 0. A part in a loose rectangular hole may lie in a corner of the hole, off by half of the clearance in two
/// directions. A part in the corner still counts as in place.
inline double fitTolerance_m(double diametral_clearance_m) {
  const double clearance_m = std::max(0.0, diametral_clearance_m);
  constexpr double kToCorner = 0.70710678118654752;  // half of the square root of two
  const double play_m = std::min(kSightTolerance_m, kToCorner * clearance_m + kContactOnBothSides_m);
  return std::max(std::min(kFitTolerance_m, clearance_m + kContactOnBothSides_m), play_m);
}

}  // namespace vps::scenes
