// SPDX-License-Identifier: BSD-3-Clause
#include "overlaps/drawn_overlaps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "fits/faces.h"
#include "text/words.h"

namespace vps::scenes {

namespace {

constexpr double kRounding =
    2e-6;  // relative to the size of a face: rounding of the size in files with six digits

bool isLineToLine(const CheckedFit& fit) {
  return fit.kind == FitKind::Shaft &&
         std::abs(fit.diametral_clearance_m) <= fit.error_m + kRounding * fit.shaft_m;
}

/// True if the pair has a choice, or may overlap, or one of its parts is left out or resized by another
/// choice.
bool isSettled(const CheckedFit& fit, const CheckResult& checked, const std::vector<OverlapChoice>& others) {
  const auto isOfPair = [&](const std::string& a, const std::string& b) {
    return (fit.shaft == a && fit.bore == b) || (fit.shaft == b && fit.bore == a);
  };
  const auto isOne = [&](const std::string& name) { return name == fit.shaft || name == fit.bore; };
  return std::ranges::any_of(others,
                             [&](const OverlapChoice& other) {
                               return isOfPair(other.a, other.b) || isOne(other.left_out) ||
                                      (isOne(other.changed) && other.resized);
                             }) ||
         std::ranges::any_of(checked.pairs, [&](const CheckedPair& pair) {
           return isOfPair(pair.a, pair.b) && (pair.is_allowed || pair.press_fit_m > 0);
         });
}

std::string wordsOf(const OverlapChoice& choice, const std::vector<std::string>& bores) {
  char sizes[120];
  std::snprintf(sizes, sizeof sizes,
                "(%.3f mm): assumed to be a sliding fit; its diameter is reduced to %.3f mm",
                2e3 * choice.resized->from_radius_m, 2e3 * choice.resized->to_radius_m);
  return "'" + choice.a + "' is drawn exactly as wide as its " + (bores.size() == 1 ? "hole" : "holes") +
         " in " + listed(bores, bores.size()) + " " + sizes + " so that it can pass";
}

}  // namespace

std::optional<Resized> thinnerShaft(const PlacedSurface& shaft, const CheckedFit& fit, double to_radius_m) {
  const Vec3 axis_P = shaft.X_WP.R.transpose() * fit.axis_W, at_P = shaft.X_WP.inverse() * fit.at_W;
  const double radius_m = 0.5 * fit.shaft_m, same_m = 1e-5 * fit.shaft_m + fit.error_m;
  std::optional<Resized> out;
  for (const RoundFace& face : shaft.surface->round()) {
    const Vec3 r = at_P - face.p;
    const bool is_on_axis = std::abs(face.axis.dot(axis_P)) > 0.999 &&
                            (r - face.axis.dot(r) * face.axis).norm() <= 1e-3 * fit.shaft_m;
    if (face.is_bore || !is_on_axis || std::abs(face.radius_m - radius_m) > same_m) continue;
    if (!out) out = Resized{axis_P, at_P, 0, 0, radius_m, to_radius_m};
    for (const double end_m : {face.from_m, face.to_m}) {
      const double along_m = axis_P.dot(face.p + end_m * face.axis - at_P);
      out->from_m = std::min(out->from_m, along_m);
      out->to_m = std::max(out->to_m, along_m);
    }
  }
  return out;
}

std::vector<OverlapChoice> lineToLineChoices(const std::vector<PlacedSurface>& parts,
                                             const CheckResult& checked,
                                             const std::vector<OverlapChoice>& others) {
  std::vector<OverlapChoice> out;
  std::vector<std::vector<std::string>> bores;
  for (const CheckedFit& fit : checked.fits) {
    if (!isLineToLine(fit) || isSettled(fit, checked, others)) continue;
    const auto shaft = std::ranges::find(parts, fit.shaft, &PlacedSurface::name);
    const std::optional<Resized> resized = thinnerShaft(*shaft, fit, 0.5 * fit.shaft_m - kPassingRoom_m);
    if (!resized) continue;
    const auto known = std::ranges::find_if(out, [&](const OverlapChoice& choice) {
      const Vec3 r = resized->p - choice.resized->p;
      return choice.a == fit.shaft &&
             std::abs(choice.resized->from_radius_m - resized->from_radius_m) < 1e-6 &&
             r.cross(resized->axis).norm() <= 1e-3 * fit.shaft_m;
    });
    if (known != out.end()) {
      bores[static_cast<std::size_t>(known - out.begin())].push_back(fit.bore);
      continue;
    }
    OverlapChoice& choice = out.emplace_back();
    choice.a = choice.changed = fit.shaft;
    choice.b = fit.bore;
    choice.kind = OverlapKind::LineToLine;
    choice.resized = resized;
    bores.push_back({fit.bore});
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].words = wordsOf(out[i], bores[i]);
  return out;
}

}  // namespace vps::scenes
