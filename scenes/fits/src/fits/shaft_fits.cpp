// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "fits/fits.h"
#include "fits/iso_sizes.h"

namespace vps::scenes {

namespace {

/// Greatest distance of a shaft's axis from the bore's, divided by the diameter; drawings are not always
/// exact.
constexpr double kMostOffset = 0.02;
constexpr double kLeastLength = 1e-3;  // least length of a fit, divided by the diameter

/// Fills the fit of a shaft in a bore, both given in the world frame; returns false if shaft and bore form no
/// fit.
bool fitOf(const RoundFace& shaft, const RoundFace& bore, CheckedFit& fit) {
  const double d_m = 2 * shaft.radius_m, clearance_m = 2 * (bore.radius_m - shaft.radius_m);
  if (std::abs(clearance_m) > mostClearance_m(d_m)) return false;
  if (std::abs(shaft.axis.dot(bore.axis)) < 0.99) return false;
  const auto [from_m, to_m] = commonRange(shaft, bore);
  const double length_m = to_m - from_m;
  if (!(length_m > kLeastLength * d_m)) return false;
  double offset_m = 0;
  for (const double along_m : {from_m, to_m}) {
    const Vec3 p = shaft.p + along_m * shaft.axis, r = p - bore.p;
    const double off_m = (r - bore.axis.dot(r) * bore.axis).norm();
    if (off_m > kMostOffset * d_m + 0.5 * std::abs(clearance_m)) return false;
    offset_m = std::max(offset_m, off_m);
  }
  fit.kind = FitKind::Shaft;
  fit.axis_W = shaft.axis;
  fit.at_W = shaft.p + 0.5 * (from_m + to_m) * shaft.axis;
  fit.shaft_m = d_m;
  fit.bore_m = 2 * bore.radius_m;
  fit.along_W = shaft.axis;
  fit.length_m = length_m;
  fit.diametral_clearance_m = clearance_m;
  fit.offset_m = offset_m;
  fit.error_m = 2 * (shaft.residual_m + bore.residual_m);
  fit.iso_286 = isoFit(fit.bore_m, fit.shaft_m);
  return true;
}

RoundFace inWorld(const RoundFace& face, const Pose& X_WP) {
  RoundFace out = face;
  out.axis = X_WP.R * face.axis;
  out.p = X_WP * face.p;
  // The sign of an axis is free; the chosen direction has a positive greatest component, as a reader expects.
  int greatest = 0;
  out.axis.cwiseAbs().maxCoeff(&greatest);
  if (out.axis[greatest] > 0) return out;
  out.axis = -out.axis;
  std::swap(out.from_m, out.to_m);
  out.from_m = -out.from_m;
  out.to_m = -out.to_m;
  return out;
}

/// Faces that a keyway or a groove divides give the same fit more than once; the longest fit is kept.
void addOnce(const CheckedFit& fit, std::size_t first, std::vector<CheckedFit>& out) {
  for (std::size_t i = first; i < out.size(); ++i) {
    CheckedFit& other = out[i];
    const Vec3 r = fit.at_W - other.at_W;
    const double same_m = 1e-5 * fit.shaft_m + fit.error_m + other.error_m;
    const bool is_same = other.shaft == fit.shaft && std::abs(other.shaft_m - fit.shaft_m) <= same_m &&
                         std::abs(other.bore_m - fit.bore_m) <= same_m &&
                         (r - fit.axis_W.dot(r) * fit.axis_W).norm() <= 1e-3 * fit.shaft_m &&
                         std::abs(fit.axis_W.dot(other.axis_W)) > 0.999;
    if (!is_same) continue;
    if (fit.length_m > other.length_m) other = fit;
    return;
  }
  out.push_back(fit);
}

}  // namespace

void appendShaftFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out) {
  const std::size_t first = out.size();
  for (const auto& [inner, outer] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (const RoundFace& shaft : inner->faces.round) {
      if (shaft.is_bore) continue;
      const RoundFace shaft_W = inWorld(shaft, inner->part.X_WP);
      for (const RoundFace& bore : outer->faces.round) {
        if (!bore.is_bore) continue;
        CheckedFit fit;
        fit.shaft = inner->part.name;
        fit.bore = outer->part.name;
        if (fitOf(shaft_W, inWorld(bore, outer->part.X_WP), fit)) addOnce(fit, first, out);
      }
    }
}

}  // namespace vps::scenes
