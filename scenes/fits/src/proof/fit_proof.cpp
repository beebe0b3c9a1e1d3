// SPDX-License-Identifier: BSD-3-Clause
#include "proof/blocked_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fits/faces.h"
#include "fits/fits.h"
#include "surface/around_axis.h"

namespace vps::scenes {

namespace {

/// The axis of a face in the world: a point and a direction.
struct Axis {
  Vec3 at_W, along_W;
};

Axis axisOf(const PlacedSurface& part, const RoundFace& face) {
  return {part.X_WP * face.p, part.X_WP.R * face.axis};
}

Vec3 fromAxis(const Axis& axis, const Vec3& p_W) {
  const Vec3 r = p_W - axis.at_W;
  return r - axis.along_W.dot(r) * axis.along_W;
}

/// The greatest angle around a face's axis that contains no point of the face, in the slice through at_W.
double greatestGap(const PlacedSurface& part, const RoundFace& face, const Vec3& at_W) {
  const Axis axis = axisOf(part, face);
  const Vec3 u = axis.along_W.unitOrthogonal(), v = axis.along_W.cross(u);
  std::vector<double> angles;
  for (const std::uint32_t i : face.facets) {
    const Triangle t = part.surface->triangle(i);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = part.X_WP * t[k] - at_W, b = part.X_WP * t[(k + 1) % 3] - at_W;
      const double high_a = axis.along_W.dot(a), high_b = axis.along_W.dot(b);
      if ((high_a >= 0) == (high_b >= 0)) continue;
      const Vec3 r = fromAxis(axis, at_W + a + high_a / (high_a - high_b) * (b - a));
      angles.push_back(std::atan2(v.dot(r), u.dot(r)));
    }
  }
  if (angles.empty()) return 2 * std::numbers::pi;
  std::ranges::sort(angles);
  double most = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) most = std::max(most, angles[i] - angles[i - 1]);
  return most;
}

/// Area (angle times length) that a polygon covers on a cylinder around the third axis. The polygon must not
/// contain the axis.
double unrolledArea(const std::vector<Vec3>& polygon) {
  double area = 0, angle = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.head<2>().dot(b.head<2>()));
    area += 0.5 * (angle * b.z() - (angle + turn) * a.z());
    angle += turn;
  }
  return std::abs(area);
}

/// Whether a shaft's face is complete all around, half_m to each side of a point along its axis, and only
/// material lies below it, down to the distance down_to_m from the axis.
bool isRoundAndFull(const PlacedSurface& shaft, const RoundFace& face, const Vec3& at_W, double half_m,
                    double down_to_m) {
  constexpr double kNone = 1e-5;  // share of the area that counts as zero, because of rounding
  const Axis axis = axisOf(shaft, face);
  const NearAxis slab(axis.along_W, at_W - fromAxis(axis, at_W), shaft, half_m);
  double covered = 0;
  for (const std::uint32_t i : face.facets)
    if (const std::vector<Vec3> polygon = slab.clippedFacet(i); polygon.size() > 2)
      covered += unrolledArea(polygon);
  if (std::abs(covered / (4 * std::numbers::pi * half_m) - 1) > kNone) return false;
  bool is_full = true;
  slab.forEachFacet([&](double from_m, double to_m, double, std::uint32_t i) {
    if (to_m < down_to_m || from_m > face.radius_m) return;
    is_full = is_full && std::ranges::binary_search(face.facets, i);
  });
  return is_full;
}

/// The round faces of a part that can be the face of the fit.
std::vector<RoundFace> facesOf(const PlacedSurface& part, bool is_bore, double size_m, const Vec3& at_W,
                               double beside_m) {
  const double same_m = 1e-9 * size_m;
  std::vector<RoundFace> faces = part.surface->round();
  std::erase_if(faces, [&](const RoundFace& face) {
    return face.is_bore != is_bore || std::abs(2 * face.radius_m - size_m) > same_m ||
           fromAxis(axisOf(part, face), at_W).norm() > beside_m + same_m;
  });
  return faces;
}

}  // namespace

double mayMove_m(const PlacedSurface& part) {
  return part.drawn->is_fixed ? 0 : kSightTolerance_m;
}

bool isProvenByFit(const std::vector<PlacedSurface>& parts, const CheckedFit& fit) {
  if (fit.kind != FitKind::Shaft) return false;
  const PlacedSurface &shaft = named(parts, fit.shaft), &bore = named(parts, fit.bore);
  if (!shaft.surface->isClosed() || !bore.surface->isClosed()) return false;
  // kContactDepth_m counts on both sides of the diameter. A declared press fit does not block.
  const double beyond_m =
      fit.error_m + 2 * kContactDepth_m + std::max(shaft.drawn->press_fit_m, bore.drawn->press_fit_m);
  if (!(-fit.diametral_clearance_m > beyond_m)) return false;
  constexpr double kMostOffset_m = 0.1 * kSightTolerance_m, kMostTilt = 0.01;
  if (fit.offset_m > kMostOffset_m) return false;
  // A point of the bore may lie outside the shaft's box, by at most its displacement. A rotation of the shaft
  // then moves this point by up to a quarter more than the box's corners.
  constexpr double kBeside = 1.25;
  const double by_m = kBeside * (mayMove_m(shaft) + mayMove_m(bore)) + fit.offset_m;
  // The slice turns by an angle whose sine is at most by_m / radius plus the tilt. The proof's condition t <
  // radius cos(turn) holds if the radius is at least 1.42 by_m.
  if (!(0.5 * fit.bore_m > 1.5 * by_m)) return false;
  constexpr double kSurrounds = 2 * std::numbers::pi / 3;
  for (const RoundFace& of_bore : facesOf(bore, true, fit.bore_m, fit.at_W, fit.offset_m))
    for (const RoundFace& of_shaft : facesOf(shaft, false, fit.shaft_m, fit.at_W, fit.offset_m)) {
      const Axis axis = axisOf(shaft, of_shaft);
      if (axis.along_W.cross(axisOf(bore, of_bore).along_W).norm() > kMostTilt) continue;
      const double half_m = by_m + kMostTilt * 0.5 * fit.bore_m, down_to_m = 0.5 * fit.bore_m - by_m;
      for (const double share : {0.0, -0.25, 0.25}) {
        const Vec3 at_W = fit.at_W + share * fit.length_m * axis.along_W;
        if (greatestGap(bore, of_bore, at_W) <= kSurrounds &&
            isRoundAndFull(shaft, of_shaft, at_W, half_m, down_to_m))
          return true;
      }
    }
  return false;
}

}  // namespace vps::scenes
