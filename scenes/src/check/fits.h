// SPDX-License-Identifier: BSD-3-Clause
// Fits between two parts: a shaft in a bore, a key in a slot, a screw in a nut.
#pragma once

#include <vector>

#include "check/flat_faces.h"
#include "check/placed_surface.h"
#include "check/round_faces.h"
#include "check/thread_faces.h"

namespace vps::scenes::inline v0 {

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
/// The clearance is at most a quarter of the size. O(faces of a x faces of b). Thread-safe.
void appendShaftFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);
void appendKeyFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);
/// Threads outside of one part in threads inside of the other, with a common axis and lead. Removes the fits
/// of the two parts that were appended before and are of the crests and roots of these threads.
void appendThreadFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out);

/// The greatest clearance of a fit, in its size. assumed: wider is not called a fit in any table of ISO 286.
inline constexpr double kMostClearance = 0.25;

}  // namespace vps::scenes::inline v0
