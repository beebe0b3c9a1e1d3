// SPDX-License-Identifier: BSD-3-Clause
#include "motion/screw_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/screw_sector.h"
#include "surface/around_axis.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr double kWholeTurn_rad = 2 * std::numbers::pi;
constexpr int kBins = 1024;
/// A triangle that spans a greater angle, or whose radii have a greater ratio, is halved, at most
/// kMostHalvings times. Triangles on the axis reach the limit of halvings.
constexpr double kMostTurn_rad = 0.3, kMostRatio = 1.5;
constexpr int kMostHalvings = 16;

Triangle placedTriangle(const PlacedSurface& part, std::uint32_t i) {
  Triangle t = part.surface->triangle(i);
  for (Vec3& p : t) p = part.X_WP * p;
  return t;
}

double farthest_m(const PlacedSurface& part, const Vec3& ahead_W) {
  double farthest_m = -1e300;
  for (const Vec3& p : part.surface->mesh().vertices)
    farthest_m = std::max(farthest_m, ahead_W.dot(part.X_WP * p));
  return farthest_m;
}

}  // namespace

/// A triangle, described by radius and phase of its corners. Between the corners, radius and phase are nearly
/// linear. The radius is at most its linear interpolation, since the distance from a line is convex, and at
/// least `shrink` times the interpolation. The phase deviates from its interpolation by `slack_m` at most.
struct ScrewProfile::Facet {
  double radius_m[3], phase_m[3];
  double shrink = 0, slack_m = 0;
  double nearest_m = 0;        // exact least distance from the axis
  bool is_everywhere = false;  // the phase has no bound: the triangle counts in all bins

  /// Least and greatest interpolated radius where the interpolated phase is between from_m and to_m.
  [[nodiscard]] std::array<double, 2> radii(double from_m, double to_m) const {
    std::array<double, 2> out = {1e300, -1e300};
    const auto add = [&](double r) { out = {std::min(out[0], r), std::max(out[1], r)}; };
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3;
      if (phase_m[i] >= from_m && phase_m[i] <= to_m) add(radius_m[i]);
      const double way_m = phase_m[k] - phase_m[i];
      if (way_m == 0) continue;
      for (const double at_m : {from_m, to_m})
        if (const double share = (at_m - phase_m[i]) / way_m; share >= 0 && share <= 1)
          add(radius_m[i] + share * (radius_m[k] - radius_m[i]));
    }
    return out;
  }
};

ScrewProfile::Facet ScrewProfile::seen(const Triangle& triangle_W) const {
  Facet out;
  double turn_rad[3];
  double least_m = 1e300, greatest_m = 0, along_m[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3 r = triangle_W[static_cast<std::size_t>(i)] - screw_.center;
    along_m[i] = screw_.direction.dot(r);
    out.radius_m[i] = std::hypot(r.dot(x_), r.dot(y_));
    turn_rad[i] = std::atan2(r.dot(y_), r.dot(x_));
    turn_rad[i] = turn_rad[0] + std::remainder(turn_rad[i] - turn_rad[0], kWholeTurn_rad);
    least_m = std::min(least_m, out.radius_m[i]);
    greatest_m = std::max(greatest_m, out.radius_m[i]);
  }
  for (int i = 0; i < 3; ++i) out.phase_m[i] = along_m[i] - screw_.forward_m * turn_rad[i];
  const double span_rad =
      std::max({turn_rad[0], turn_rad[1], turn_rad[2]}) - std::min({turn_rad[0], turn_rad[1], turn_rad[2]});
  if (span_rad > kMostTurn_rad || greatest_m > kMostRatio * least_m) {
    out.is_everywhere = true;
    out.nearest_m = axisExtent(triangle_W, screw_.center, screw_.direction, x_, y_).nearest_m;
    return out;
  }
  // A mean of three vectors of lengths a_i, at angles of at most s to each other, with weights w_i, has the
  // squared length sum w_i w_j a_i a_j cos s_ij >= (sum w_i a_i)^2 (1 - 2/3 (1 - cos s)).
  out.shrink = std::sqrt(1 - 2.0 / 3 * (1 - std::cos(span_rad)));
  out.slack_m = phaseSlack_m(screw_.forward_m, span_rad, greatest_m / least_m);
  return out;
}

/// Calls visit(bin, least radius, greatest radius) for each bin that the facet's phase may reach, with bounds
/// of the facet's radius there. The loop ends when visit returns false, and the function then returns false.
template <class Visit>
bool ScrewProfile::forEachBin(const Facet& facet, Visit visit) const {
  const auto [least, greatest] = std::minmax({facet.radius_m[0], facet.radius_m[1], facet.radius_m[2]});
  const auto [from_m, to_m] = std::minmax({facet.phase_m[0], facet.phase_m[1], facet.phase_m[2]});
  const double bin_m = lead_m_ / kBins;
  const double first = std::floor((from_m - facet.slack_m) / bin_m),
               last = std::floor((to_m + facet.slack_m) / bin_m);
  if (facet.is_everywhere || last - first + 1 >= kBins) {
    for (int bin = 0; bin < kBins; ++bin)
      if (!visit(bin, facet.is_everywhere ? facet.nearest_m : facet.shrink * least, greatest)) return false;
    return true;
  }
  for (double i = first; i <= last; ++i) {
    const auto [low, high] = facet.radii(i * bin_m - facet.slack_m, (i + 1) * bin_m + facet.slack_m);
    if (low > high) continue;
    const int bin = static_cast<int>(i - kBins * std::floor(i / kBins));
    if (!visit(bin, facet.shrink * low, high)) return false;
  }
  return true;
}

template <class Visit>
bool ScrewProfile::forEachBin(const Triangle& triangle_W, Visit visit, int halvings) const {
  const Facet facet = seen(triangle_W);
  if (!facet.is_everywhere || halvings == kMostHalvings) return forEachBin(facet, visit);
  const auto& t = triangle_W;
  std::size_t i = 0;
  for (const std::size_t k : {1, 2})
    if ((t[(k + 1) % 3] - t[k]).squaredNorm() > (t[(i + 1) % 3] - t[i]).squaredNorm()) i = k;
  const Vec3 middle = 0.5 * (t[i] + t[(i + 1) % 3]);
  const Vec3 &from = t[i], &to = t[(i + 1) % 3], &apex = t[(i + 2) % 3];
  return forEachBin(Triangle{from, middle, apex}, visit, halvings + 1) &&
         forEachBin(Triangle{middle, to, apex}, visit, halvings + 1);
}

ScrewProfile::ScrewProfile(const PlacedSurface& nut, const Motion& screw)
    : ScrewProfile(nut, screw, Vec3::Zero(), 0) {}

ScrewProfile::ScrewProfile(const PlacedSurface& nut, const Motion& screw, const PlacedSurface& part,
                           const Vec3& ahead_W)
    : ScrewProfile(nut, screw, ahead_W, farthest_m(part, ahead_W)) {}

/// Builds the profile without the facets beyond `end_m`, a distance along ahead_W.
ScrewProfile::ScrewProfile(const PlacedSurface& nut, const Motion& screw, const Vec3& ahead_W, double end_m)
    : screw_(screw),
      x_(screw.direction.unitOrthogonal()),
      y_(screw.direction.cross(x_)),
      lead_m_(std::abs(screw.forward_m) * kWholeTurn_rad),
      least_m_(kBins, 1e300) {
  for (std::uint32_t i = 0; i < nut.surface->mesh().triangles.size(); ++i) {
    pollStop();
    const Triangle triangle = placedTriangle(nut, i);
    if (std::ranges::all_of(triangle, [&](const Vec3& p) { return ahead_W.dot(p) > end_m; })) continue;
    forEachBin(triangle, [&](int bin, double least, double) {
      double& of_bin = least_m_[static_cast<std::size_t>(bin)];
      of_bin = std::min(of_bin, least);
      return true;
    });
  }
}

std::vector<std::uint8_t> ScrewProfile::passing(const PlacedSurface& part) const {
  std::vector<std::uint8_t> out(part.surface->mesh().triangles.size(), 1);
  for (std::uint32_t i = 0; i < out.size(); ++i) {
    pollStop();
    forEachBin(placedTriangle(part, i), [&](int bin, double, double greatest) {
      if (greatest < least_m_[static_cast<std::size_t>(bin)]) return true;
      out[i] = 0;
      return false;
    });
  }
  return out;
}

}  // namespace vps::scenes
