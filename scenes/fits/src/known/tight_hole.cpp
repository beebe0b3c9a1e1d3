// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "fits/fits.h"
#include "known/known_overlap.h"
#include "pair/pair_measures.h"
#include "vps_scenes/fits/resized.h"

namespace vps::scenes {

namespace {

/// A round face or the crests of a thread, in the world.
struct RoundPiece {
  Vec3 axis, p;
  double from_m, to_m, radius_m;
  bool is_thread;
};

/// The cylinders of a part on one side of its material: holes, or shafts.
std::vector<RoundPiece> piecesOf(const KnownPart& of, bool is_hole) {
  std::vector<RoundPiece> out;
  const Pose& X = of.part.X_WP;
  for (const RoundFace& face : of.faces.round)
    if (face.is_bore == is_hole)
      out.push_back({X.R * face.axis, X * face.p, face.from_m, face.to_m, face.radius_m, false});
  for (const ThreadFace& face : of.faces.threads)
    if (face.is_inside == is_hole)
      out.push_back({X.R * face.axis, X * face.p, face.from_m, face.to_m,
                     is_hole ? face.least_m : face.greatest_m, true});
  return out;
}

constexpr double kSameSize_m = 1e-6;

/// Whether the shaft is in the hole: nearly one axis, and a common length.
bool isIn(const RoundPiece& shaft, const RoundPiece& hole) {
  constexpr double kOffset = 0.02;  // greatest distance of the axes, divided by the shaft's radius
  if (std::abs(shaft.axis.dot(hole.axis)) < 0.999) return false;
  const auto [from_m, to_m] = commonRange(shaft, hole);
  if (!(to_m - from_m > kSameSize_m)) return false;
  const Vec3 r = shaft.p + 0.5 * (from_m + to_m) * shaft.axis - hole.p;
  return (r - hole.axis.dot(r) * hole.axis).norm() < kOffset * shaft.radius_m;
}

}  // namespace

std::vector<TightHole> tightHoles(const KnownPart& inner, const KnownPart& outer) {
  std::vector<TightHole> out;
  const std::vector<RoundPiece> shafts = piecesOf(inner, false), holes = piecesOf(outer, true);
  for (const RoundPiece& shaft : shafts)
    for (const RoundPiece& hole : holes) {
      if (shaft.is_thread && hole.is_thread) continue;
      if (hole.radius_m > shaft.radius_m - kSameSize_m || !isIn(shaft, hole)) continue;
      TightHole found{
          hole.axis, hole.p, 0, 0, shaft.radius_m, hole.radius_m, shaft.is_thread || hole.is_thread};
      const double at_m = hole.axis.dot(shaft.p - hole.p), sign = hole.axis.dot(shaft.axis) > 0 ? 1 : -1;
      found.from_m = at_m + std::min(sign * shaft.from_m, sign * shaft.to_m);
      found.to_m = at_m + std::max(sign * shaft.from_m, sign * shaft.to_m);
      out.push_back(found);
    }
  return out;
}

std::vector<TightHole> holesAround(const KnownPart& inner, const KnownPart& outer) {
  std::vector<TightHole> out;
  std::vector<RoundPiece> of_inner = piecesOf(inner, false);
  std::ranges::move(piecesOf(inner, true), std::back_inserter(of_inner));
  for (const RoundPiece& hole : piecesOf(outer, true)) {
    if (std::ranges::none_of(of_inner, [&](const RoundPiece& piece) { return isIn(piece, hole); })) continue;
    TightHole& found = out.emplace_back(
        TightHole{hole.axis, hole.p, 1e300, -1e300, hole.radius_m, hole.radius_m, hole.is_thread});
    for (const Vec3& x : inner.part.surface->mesh().vertices) {
      const double along_m = hole.axis.dot(inner.part.X_WP * x - hole.p);
      found.from_m = std::min(found.from_m, along_m);
      found.to_m = std::max(found.to_m, along_m);
    }
  }
  return out;
}

bool isOnlyInHole(const PlacedSurface& inner, const PlacedSurface& outer, const TightHole& hole) {
  // Room between the thinner shaft and the hole, so that crossing facets do not matter. It is also the
  // greatest distance of the axes: a shaft that is farther off still overlaps.
  constexpr double kRoom_m = 25e-6;
  if (!inner.surface->isClosed() || !outer.surface->isClosed() || !(hole.hole_m > 2 * kRoom_m)) return false;
  const Pose X_PW = inner.X_WP.inverse();
  DrawnPart thinner = *inner.drawn;
  thinner.mesh = inner.surface->mesh();
  resize(thinner.mesh, {X_PW.R * hole.axis_W, X_PW * hole.p_W, hole.from_m, hole.to_m, hole.shaft_m,
                        hole.hole_m - kRoom_m});
  thinner.press_fit_m = 0;
  const std::vector<DrawnPart> drawn = {thinner};
  const std::vector<PlacedSurface> placed = placedSurfaces(drawn, {});
  const std::optional<CheckedPair> pair = checkPair(placed.front(), outer, 0);
  return !pair || (pair->state != PairState::Clash && !pair->is_uncertain);
}

}  // namespace vps::scenes
