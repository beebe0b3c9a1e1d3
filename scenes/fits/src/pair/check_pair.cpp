// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vps/box_intersection.h"

namespace vps::scenes {

namespace {

/// Error of a part's coordinates: rounding in sums of coordinates, rounding in the part's file, and half the
/// width of closed cracks, since the surface lies between a crack's sides.
double uncertainty_m(const PlacedSurface& part) {
  const double greatest_m = part.box_W.min.cwiseAbs().cwiseMax(part.box_W.max.cwiseAbs()).maxCoeff();
  return 16 * std::numeric_limits<double>::epsilon() * greatest_m + part.drawn->rounding_m +
         0.5 * part.surface->solid().report().joined_m;
}

/// Distance of the meshes from the faces that they approximate, where the parts are near each other.
struct FaceError {
  double chord_m = 0;       ///< chord errors of both parts, added
  double most_chord_m = 0;  ///< the greater of the parts' chord errors
  double crack_m = 0;       ///< widths of cracks, either side of which may be the face
};

FaceError faceError(const PlacedSurface& a, const PlacedSurface& b, double near_m) {
  FaceError error;
  for (const auto& [part, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    const Box box_P = moved(grown(other->box_W, near_m), part->X_WP.inverse());
    const double chord_m = part->surface->chordIn(box_P);
    error.chord_m += chord_m;
    error.most_chord_m = std::max(error.most_chord_m, chord_m);
    error.crack_m += part->surface->crackIn(box_P);
  }
  return error;
}

/// The overlap of solids whose edges all lie on each other's surface, such as a part that is drawn twice. No
/// edge shows such an overlap, so some points below the middles of facets of a are measured, and the deepest
/// is returned.
Overlap flushOverlap(const PlacedSurface& a, const PlacedSurface& b) {
  constexpr std::uint32_t kFacets = 16;
  const PartSurface& of = *a.surface;
  const Pose X_BA = b.X_WP.inverse() * a.X_WP;
  const double size_m = of.box().size().norm();
  const auto count = static_cast<std::uint32_t>(of.mesh().triangles.size());
  Overlap deepest;
  for (std::uint32_t k = 0; k < std::min(kFacets, count); ++k) {
    const auto i = static_cast<std::uint32_t>(std::uint64_t{count} * k / std::min(kFacets, count));
    const Triangle t = of.triangle(i);
    for (double below_m = 0.25 * size_m; below_m > 1e-4 * size_m; below_m *= 0.5) {
      const Vec3 p_A = (t[0] + t[1] + t[2]) / 3 - below_m * of.normal(i);
      const double in_a_m = -of.solid().signedDistance(p_A);
      if (in_a_m <= deepest.depth_m) continue;
      const double in_both_m = std::min(in_a_m, -b.surface->solid().signedDistance(X_BA * p_A));
      if (in_both_m > deepest.depth_m) deepest = {in_both_m, a.X_WP * p_A};
    }
  }
  return deepest;
}

/// The depth of parts with cracks. At a crack it is not certain which points are inside, so a search for the
/// deepest point would end at a crack. The depth is therefore the depth of the edges, or the thickness if it
/// is clearly greater.
OverlapDepth depthOfTorn(const PlacedSurface& a, const PlacedSurface& b, const Overlap& found,
                         double error_m) {
  const Overlap ball = SharedBalls(a, b).greatest();
  if (const double thick_m = 2 * ball.depth_m; thick_m > found.depth_m + error_m)
    return {thick_m, thick_m + kOverlapCertain_m, ball.p_W, true};
  return {found.depth_m, found.depth_m + kOverlapCertain_m, found.p_W};
}

OverlapDepth deepestOf(const PlacedSurface& a, const PlacedSurface& b, double error_m, bool has_cracks) {
  const Overlap found = deepestOverlap(a.surface->overlap(), a.X_WP, b.surface->overlap(), b.X_WP);
  if (found.depth_m > error_m)
    return has_cracks ? depthOfTorn(a, b, found, error_m)
                      : overlapDepth(a, b, {found.depth_m, found.depth_m, found.p_W});
  const Box both = intersection(a.box_W, b.box_W);
  if (!both.isEmpty() && both.size().minCoeff() > error_m)
    for (const auto& [inner, outer] : {std::pair{&a, &b}, std::pair{&b, &a}})
      if (const Overlap flush = flushOverlap(*inner, *outer); flush.depth_m > error_m)
        return overlapDepth(a, b, {flush.depth_m, flush.depth_m, flush.p_W});
  return {found.depth_m, found.depth_m + kOverlapCertain_m, found.p_W};
}

/// Parts that are nearer to each other than this touch: coordinates in a file are rounded more coarsely, and
/// all reports write such a gap as 0.00 um.
constexpr double kLeastGap_m = 5e-9;

std::optional<CheckedPair> measured(const PlacedSurface& a, const PlacedSurface& b, double near_m) {
  CheckedPair pair{.a = a.name, .b = b.name};
  pair.is_allowed = a.drawn->allow_overlap || b.drawn->allow_overlap;
  pair.press_fit_m = std::max(a.drawn->press_fit_m, b.drawn->press_fit_m);
  FaceError faces = faceError(a, b, near_m);
  double chord_m = faces.chord_m, round_m = uncertainty_m(a) + uncertainty_m(b) + faces.crack_m;
  pair.error_m = chord_m + round_m;
  const OverlapDepth overlap = deepestOf(a, b, pair.error_m + kOverlapCertain_m, faces.crack_m > 0);
  if (overlap.depth_m > 0) {
    if (overlap.depth_m > near_m) {
      // The surface nearest to a deep point may be as far away as the depth.
      faces = faceError(a, b, overlap.most_m);
      round_m = uncertainty_m(a) + uncertainty_m(b) + faces.crack_m;
      chord_m = faces.chord_m;
    }
    // A ball between two facets of one part can grow by the chord errors of both facets.
    if (overlap.is_thickness) chord_m = std::max(chord_m, 2 * faces.most_chord_m);
    pair.error_m = chord_m + round_m + kOverlapCertain_m;
    pair.interference_depth_m = overlap.depth_m;
    pair.at_W = overlap.p_W;
    double unsettled_m = overlap.most_m - overlap.depth_m - kOverlapCertain_m;
    if (chord_m > 0) {
      // Where flat faces overlap, the error of adjacent round faces does not count.
      const CertainOverlap certain = certainOverlap(a, b);
      const double error_m = certain.error_m + round_m + kOverlapCertain_m;
      const bool is_only_one = !pair.isBeyondContact() && certain.depth_m > error_m + kContactDepth_m;
      if (is_only_one || (error_m < pair.error_m && certain.depth_m > overlap.depth_m - kOverlapCertain_m)) {
        pair.interference_depth_m = certain.depth_m;
        pair.error_m = error_m;
        pair.at_W = certain.p_W;
        unsettled_m = 0;
      }
    }
    pair.state = pair.isBeyondContact() ? PairState::Clash : PairState::Contact;
    pair.error_m += unsettled_m;
    if (pair.state == PairState::Contact) return pair;
    const OverlapVolume shared = overlapVolume(*a.surface, *b.surface, a.X_WP.inverse() * b.X_WP);
    pair.interference_volume_m3 = shared.volume_m3;
    pair.volume_error_m3 = shared.error_m3 + shared.faces_error_m3 + shared.area_m2 * round_m;
    return pair;
  }
  const double most_m = near_m + pair.error_m;
  const SurfaceGap gap = surfaceGap(*a.surface, *b.surface, a.X_WP.inverse() * b.X_WP, most_m);
  if (!(gap.distance_m < most_m)) return std::nullopt;
  pair.clearance_m = gap.distance_m;
  pair.at_W = a.X_WP * (0.5 * (gap.p_A + gap.p_B));
  pair.state = gap.distance_m > pair.error_m + kLeastGap_m ? PairState::Apart : PairState::Contact;
  return pair;
}

}  // namespace

double faceError_m(const PlacedSurface& part) {
  const PartSurface& surface = *part.surface;
  return surface.mostChordBound_m() + surface.crackIn(surface.box()) + uncertainty_m(part);
}

double meshError_m(const PlacedSurface& a, const PlacedSurface& b) {
  double error_m = kOverlapCertain_m;
  for (const PlacedSurface* part : {&a, &b}) {
    if (!part->surface->isClosed()) return std::numeric_limits<double>::infinity();
    error_m += faceError_m(*part);
  }
  return error_m;
}

std::optional<CheckedPair> checkPair(const PlacedSurface& a, const PlacedSurface& b, double near_m) {
  std::optional<CheckedPair> pair = measured(a, b, near_m);
  const bool have_inside = a.surface->noInside().empty() && b.surface->noInside().empty();
  if (have_inside || !overlap(a.box_W, b.box_W) || (pair && pair->state == PairState::Clash)) return pair;
  if (!pair) pair = CheckedPair{.a = a.name, .b = b.name, .clearance_m = near_m};
  pair->is_uncertain = true;
  return pair;
}

SurfaceGap surfaceGap(const PartSurface& a, const PartSurface& b, const Pose& X_AB, double most_m) {
  SurfaceGap best{most_m, {}, {}};
  visitPairs(
      a.tree(), b.tree(), [&](const Box& box) { return moved(box, X_AB); },
      [](const Box& of_a, const Box& of_b) { return distance2(of_a, of_b); },
      [&] { return best.distance_m * best.distance_m; },
      [&](std::uint32_t i, std::uint32_t k) {
        const Triangle of_a = a.triangle(i), of_b = b.triangle(k);
        const TriangleGap gap = triangleGap(of_a, {X_AB * of_b[0], X_AB * of_b[1], X_AB * of_b[2]});
        if (gap.distance_m < best.distance_m) best = {gap.distance_m, gap.p_a, gap.p_b};
      });
  return best;
}

}  // namespace vps::scenes
