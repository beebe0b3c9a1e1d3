// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "fits/fits.h"
#include "fits/iso_sizes.h"

namespace vps::scenes {

namespace {

constexpr double kSameLead = 0.03;      // greatest relative difference of the leads
constexpr double kLeastTurns = 0.5;     // least length of engagement in pitches
constexpr double kMostCrestGap = 0.25;  // greatest relative gap of the major diameters; assumed
// Greatest distance between the axes, divided by the diameter, since a loose nut hangs on its bolt.
constexpr double kThreadOffset = 0.05;

ThreadFace threadInWorld(const ThreadFace& face, const Pose& X_WP) {
  ThreadFace out = face;
  out.axis = X_WP.R * face.axis;
  out.p = X_WP * face.p;
  return out;
}

/// Fills the fit of a screw in a nut, both given in the world frame; returns false if screw and nut form no
/// fit.
bool fitOf(const ThreadFace& screw, const ThreadFace& nut, CheckedFit& fit) {
  if (std::abs(screw.axis.dot(nut.axis)) < 0.99) return false;
  if (std::abs(screw.lead_m - nut.lead_m) > kSameLead * std::abs(screw.lead_m) || screw.starts != nut.starts)
    return false;
  // The crests of each thread must reach into the grooves of the other thread.
  if (screw.greatest_m <= nut.least_m || screw.greatest_m > (1 + 0.5 * kMostCrestGap) * nut.greatest_m ||
      nut.greatest_m > (1 + kMostCrestGap) * screw.greatest_m)
    return false;
  const auto [from_m, to_m] = commonRange(screw, nut);
  if (!(to_m - from_m > kLeastTurns * std::abs(screw.lead_m) / screw.starts)) return false;
  for (const double along_m : {from_m, to_m}) {
    const Vec3 r = screw.p + along_m * screw.axis - nut.p;
    fit.offset_m = std::max(fit.offset_m, (r - nut.axis.dot(r) * nut.axis).norm());
  }
  if (fit.offset_m > kThreadOffset * 2 * screw.greatest_m) return false;
  fit.kind = FitKind::Thread;
  fit.axis_W = fit.along_W = screw.axis;
  fit.at_W = screw.p + 0.5 * (from_m + to_m) * screw.axis;
  fit.length_m = to_m - from_m;
  fit.shaft_m = 2 * screw.greatest_m;
  fit.bore_m = 2 * nut.greatest_m;
  fit.diametral_clearance_m = fit.bore_m - fit.shaft_m;
  fit.error_m = 2 * (screw.residual_m + nut.residual_m);
  fit.lead_m = 0.5 * (screw.lead_m + nut.lead_m);
  fit.starts = screw.starts;
  if (fit.starts > 1) return true;
  const MetricThread standard = metricThread(fit.shaft_m, fit.lead_m);
  fit.thread = standard.name;
  if (!standard.name.empty()) fit.lead_m = std::copysign(standard.pitch_m, fit.lead_m);
  return true;
}

/// Whether a round fit belongs to a thread: same axis, between the thread's least and greatest radius, and
/// within its length.
bool isPartOf(const CheckedFit& round, const CheckedFit& thread, double least_m) {
  const Vec3 r = round.at_W - thread.at_W;
  const double along_m = thread.axis_W.dot(r);
  const bool is_same_pair = (round.shaft == thread.shaft && round.bore == thread.bore) ||
                            (round.shaft == thread.bore && round.bore == thread.shaft);
  return is_same_pair && round.kind == FitKind::Shaft && std::abs(round.axis_W.dot(thread.axis_W)) > 0.99 &&
         (r - along_m * thread.axis_W).norm() < kThreadOffset * thread.shaft_m &&
         std::abs(along_m) < 0.5 * (thread.length_m + round.length_m) && round.shaft_m > 0.99 * 2 * least_m &&
         round.shaft_m < 1.01 * thread.bore_m;
}

}  // namespace

void appendThreadFits(const FittedPart& a, const FittedPart& b, std::vector<CheckedFit>& out) {
  for (const auto& [inner, outer] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (const ThreadFace& screw : inner->faces.threads) {
      if (screw.is_inside) continue;
      const ThreadFace screw_W = threadInWorld(screw, inner->part.X_WP);
      for (const ThreadFace& nut : outer->faces.threads) {
        if (!nut.is_inside) continue;
        CheckedFit fit;
        fit.shaft = inner->part.name;
        fit.bore = outer->part.name;
        if (!fitOf(screw_W, threadInWorld(nut, outer->part.X_WP), fit)) continue;
        std::erase_if(out, [&](const CheckedFit& round) { return isPartOf(round, fit, screw.least_m); });
        out.push_back(fit);
      }
    }
}

}  // namespace vps::scenes
