// SPDX-License-Identifier: BSD-3-Clause
// Fits between two parts: a shaft in a bore, a key in a slot, a screw in a nut.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "fits/flat_faces.h"
#include "fits/round_faces.h"
#include "fits/thread_faces.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// The faces of a part that fits can have.
struct FitFaces {
  std::vector<RoundFace> round;
  std::vector<FlatFace> flat;
  std::vector<ThreadFace> threads;
};
FitFaces fitFaces(const PartSurface& surface);

/// A part in place, with its faces.
struct FittedPart {
  const PlacedSurface& part;
  const FitFaces& faces;
};

/// Cylinders of which one is in the other with a common axis, and pairs of parallel faces between two others.
/// The clearance is at most mostClearance_m(). O(faces of a x faces of b). Thread-safe.
void appendShaftFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);
void appendKeyFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);
/// Threads outside of one part in threads inside of the other, with a common axis and lead. Removes the fits
/// of the two parts that were appended before and are of the crests and roots of these threads.
void appendThreadFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);

/// From where to where two faces around nearly parallel axes are beside each other: along the axis of a, from
/// a.p. Nowhere if the second is not more than the first.
template <class Face, class OtherFace>
std::array<double, 2> commonRange(const Face& a, const OtherFace& b) {
  const double shift_m = a.axis.dot(b.p - a.p), sign = a.axis.dot(b.axis) > 0 ? 1 : -1;
  const double end_m = shift_m + sign * b.from_m, other_end_m = shift_m + sign * b.to_m;
  return {std::max(a.from_m, std::min(end_m, other_end_m)), std::min(a.to_m, std::max(end_m, other_end_m))};
}

/// The greatest clearance that is called a fit. assumed: a quarter of the size; below 3 mm, the smallest
/// sizes of ISO 286, that of H11/c11 there, 0.18 mm, and no more than the size itself.
inline double mostClearance_m(double size_m) {
  return std::max(0.25 * size_m, std::min(0.18e-3, size_m));
}

}  // namespace vps::scenes
