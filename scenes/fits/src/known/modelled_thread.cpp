// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "fits/fits.h"
#include "fits/iso_sizes.h"
#include "known/known_overlap.h"
#include "pair/pair_measures.h"

namespace vps::scenes {

namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

/// The axis of a nut's thread in the world, with directions across it.
struct ThreadAxis {
  Vec3 p, axis, u, v;
};

/// Where the material of a thread is, along the axis: the phase [rad] of the middle of the facets that are
/// far from the axis, for the coordinate z - lead x angle / turn, of which a pitch is one turn.
double phaseOf(const KnownPart& of, const ThreadFace& thread, const ThreadAxis& around) {
  const double middle_m = 0.5 * (thread.least_m + thread.greatest_m);
  std::complex<double> sum = 0;
  for (const std::uint32_t i : thread.facets) {
    const Triangle t = of.part.surface->triangle(i);
    const Vec3 r = of.part.X_WP * Vec3((t[0] + t[1] + t[2]) / 3) - around.p;
    const double x = around.u.dot(r), y = around.v.dot(r);
    const double along_m = around.axis.dot(r) - thread.lead_m * std::atan2(y, x) / kTurn_rad;
    const double weight = (std::hypot(x, y) - middle_m) * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    sum += std::polar(1.0, kTurn_rad * along_m * thread.starts / std::abs(thread.lead_m)) * weight;
  }
  return std::arg(sum);
}

std::string threadName(const ThreadFace& face) {
  const std::string standard =
      face.starts == 1 ? metricThread(2 * face.greatest_m, face.lead_m).name : std::string();
  if (!standard.empty()) return standard;
  char text[96];
  std::snprintf(text, sizeof text, "%.3f mm, lead %.3f mm%s", 2e3 * face.greatest_m,
                1e3 * std::abs(face.lead_m), face.lead_m < 0 ? ", left-hand" : "");
  return text;
}

const char* handOf(const ThreadFace& face) {
  return face.lead_m < 0 ? "left-hand" : "right-hand";
}

/// A screw's thread and a nut's on one axis, which share some length and some radius.
struct ThreadPair {
  const KnownPart *screw, *nut;
  ThreadFace outside, inside;  ///< in the world
};

ThreadFace threadInWorldOf(const KnownPart& of, const ThreadFace& face) {
  ThreadFace out = face;
  out.axis = of.part.X_WP.R * face.axis;
  out.p = of.part.X_WP * face.p;
  return out;
}

std::optional<ThreadPair> engaged(const KnownPart& screw, const KnownPart& nut) {
  constexpr double kOffset = 0.05;  // distance of the axes, divided by the radius
  for (const ThreadFace& outside : screw.faces.threads)
    for (const ThreadFace& inside : nut.faces.threads) {
      if (outside.is_inside || !inside.is_inside) continue;
      ThreadPair pair{&screw, &nut, threadInWorldOf(screw, outside), threadInWorldOf(nut, inside)};
      const auto [from_m, to_m] = commonRange(pair.outside, pair.inside);
      const Vec3 r = pair.outside.p + 0.5 * (from_m + to_m) * pair.outside.axis - pair.inside.p;
      const bool is_coaxial =
          std::abs(pair.outside.axis.dot(pair.inside.axis)) > 0.999 &&
          (r - pair.inside.axis.dot(r) * pair.inside.axis).norm() < kOffset * outside.greatest_m;
      if (is_coaxial && to_m > from_m && outside.greatest_m > inside.least_m &&
          outside.least_m < inside.greatest_m)
        return pair;
    }
  return std::nullopt;
}

/// The screw turned about the nut's axis.
PlacedSurface turned(const PlacedSurface& screw, const ThreadAxis& around, double turn_rad) {
  const Mat3 R = rotationFromVector(turn_rad * around.axis);
  PlacedSurface out = screw;
  out.X_WP = Pose(R, around.p - R * around.p) * screw.X_WP;
  Box box;
  for (const Vec3& x : screw.surface->mesh().vertices) box.add(out.X_WP * x);
  out.box_W = box;
  return out;
}

/// The turn of the screw about its axis after which the parts do not overlap, the smallest first. It follows
/// from the phases of both threads and is verified by exact measure, with neighbouring turns, since the
/// phases come from facets.
std::optional<double> turnThatFits(const ThreadPair& pair, const ThreadAxis& around) {
  constexpr double kStep_rad = kTurn_rad / 180;
  const int starts = pair.inside.starts;
  const double off = std::remainder(
      phaseOf(*pair.nut, pair.inside, around) - phaseOf(*pair.screw, pair.outside, around), kTurn_rad);
  // A turn moves the thread along its axis by -lead x turn.
  const double turn_rad = (pair.inside.lead_m > 0 ? -1 : 1) * off / starts;
  for (const double more : {0.0, 1.0, -1.0, 2.0, -2.0, 4.0, -4.0}) {
    const double tried_rad = turn_rad + more * kStep_rad;
    const std::optional<CheckedPair> found =
        checkPair(turned(pair.screw->part, around, tried_rad), pair.nut->part, 0);
    if (!found || (found->state != PairState::Clash && !found->is_uncertain)) return tried_rad;
  }
  return std::nullopt;
}

/// Whether the parts overlap in their threads only: not after the screw's thread was cut down to the nut's
/// crests.
bool isOnlyInThread(const ThreadPair& pair) {
  const TightHole crests{pair.inside.axis,
                         pair.inside.p,
                         pair.inside.axis.dot(pair.outside.p - pair.inside.p) -
                             std::max(std::abs(pair.outside.from_m), std::abs(pair.outside.to_m)),
                         pair.inside.axis.dot(pair.outside.p - pair.inside.p) +
                             std::max(std::abs(pair.outside.from_m), std::abs(pair.outside.to_m)),
                         pair.outside.greatest_m,
                         pair.inside.least_m,
                         true};
  return isOnlyInHole(pair.screw->part, pair.nut->part, crests);
}

/// A coordinate without the rounding of a direction, so that no 1e-17 is printed.
double rounded(double x) {
  return std::round(1e6 * x) / 1e6 + 0.0;
}

KnownOverlap outOfPhase(const ThreadPair& pair) {
  // The sign of an axis is free; the chosen direction has a positive greatest component, as a reader expects.
  int greatest = 0;
  pair.inside.axis.cwiseAbs().maxCoeff(&greatest);
  const Vec3 axis = pair.inside.axis[greatest] > 0 ? pair.inside.axis : Vec3(-pair.inside.axis);
  const Vec3 u = axis.unitOrthogonal();
  const ThreadAxis around{pair.inside.p, axis, u, axis.cross(u)};
  const std::string name = threadName(pair.outside);
  const std::optional<double> turn_rad = turnThatFits(pair, around);
  if (!turn_rad)
    return {.words = "threads " + name + " and " + threadName(pair.inside) +
                     " of one lead: no turn about the axis was found after which they do not overlap",
            .size = name};
  if (!isOnlyInThread(pair))
    return {.words = "threads " + name + " out of phase, but the parts overlap outside of the threads too",
            .size = name};
  char text[200];
  std::snprintf(text, sizeof text,
                ", both modelled, out of phase: '%s' fits, by exact measure, after a turn of %.0f degrees "
                "about (%.3g, %.3g, %.3g), or a shift of %.3f mm along it",
                pair.screw->part.name.c_str(), *turn_rad * 360 / kTurn_rad, rounded(around.axis.x()),
                rounded(around.axis.y()), rounded(around.axis.z()),
                -1e3 * pair.inside.lead_m * *turn_rad / kTurn_rad);
  return {PairState::Thread, "threads " + name + text, pair.screw->part.name, name, 0};
}

}  // namespace

KnownOverlap modelledThread(const KnownPart& a, const KnownPart& b) {
  constexpr double kSameLead = 0.03;  // as for the fit of a screw in a nut
  std::optional<ThreadPair> pair = engaged(a, b);
  if (!pair) pair = engaged(b, a);
  if (!pair) return {};
  const ThreadFace &screw = pair->outside, &nut = pair->inside;
  const std::string both = threadName(screw) + " in " + threadName(nut);
  if ((screw.lead_m < 0) != (nut.lead_m < 0))
    return {.words = both + ": a " + handOf(screw) + " thread in a " + handOf(nut) + " one",
            .size = threadName(screw)};
  if (std::abs(screw.lead_m - nut.lead_m) > kSameLead * std::abs(screw.lead_m) ||
      screw.starts != nut.starts) {
    char text[120];
    std::snprintf(text, sizeof text, ": different threads, a lead of %.3f mm in one of %.3f mm",
                  1e3 * std::abs(screw.lead_m), 1e3 * std::abs(nut.lead_m));
    return {.words = both + text, .size = threadName(screw)};
  }
  return outOfPhase(*pair);
}

}  // namespace vps::scenes
