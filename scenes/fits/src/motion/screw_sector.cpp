// SPDX-License-Identifier: BSD-3-Clause
#include "motion/screw_sector.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr double kFullTurn_rad = 2 * std::numbers::pi;
/// Rounding of an angle, and of a phase relative to the advance per radian.
constexpr double kAngleRounding_rad = 1e-9;
/// Within this distance of the axis a facet counts as all around the axis, since its angles are rounding.
constexpr double kOnAxis_m = 1e-9;

}  // namespace

double phaseSlack_m(double forward_m, double span_rad, double ratio) {
  // The angle of the mean of vectors of lengths a_i with weights w_i is the mean of the angles with weights
  // w_i a_i, up to the deviation of the angle on a chord from a linear angle, s^3 / 24 for each of two
  // chords. The weights differ from w_i by up to (a_max / a_min - 1) / 4 for each of two weights.
  return std::abs(forward_m) * (span_rad * (ratio - 1) / 2 + std::pow(span_rad, 3) / 12);
}

ScrewSector screwSector(const Triangle& t, const Motion& screw, const Vec3& u, const Vec3& v,
                        double nearest_m) {
  constexpr double kMostSpan_rad = 0.3, kMostRatio = 1.5;  // beyond, the phases are bounded by z and angle
  if (nearest_m < kOnAxis_m) return ScrewSector::all();
  std::array<double, 3> turn_rad{}, along_m{}, radius_m{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 r = t[i] - screw.center;
    turn_rad[i] = std::atan2(r.dot(v), r.dot(u));
    // Seen along the axis, a triangle beside the axis spans less than half a turn.
    turn_rad[i] = turn_rad[0] + std::remainder(turn_rad[i] - turn_rad[0], kFullTurn_rad);
    along_m[i] = screw.direction.dot(r);
    radius_m[i] = std::hypot(r.dot(u), r.dot(v));
  }
  ScrewSector out;
  out.from_rad = *std::ranges::min_element(turn_rad) - kAngleRounding_rad;
  out.to_rad = *std::ranges::max_element(turn_rad) + kAngleRounding_rad;
  const double span_rad = out.to_rad - out.from_rad;
  if (span_rad > std::numbers::pi) return ScrewSector::all();
  const double f = screw.forward_m, rounding_m = std::abs(f) * kAngleRounding_rad;
  const auto [low_m, high_m] = std::ranges::minmax(along_m);
  const auto [of_from_m, of_to_m] = std::minmax({f * out.from_rad, f * out.to_rad});
  out.from_m = low_m - of_to_m;
  out.to_m = high_m - of_from_m;
  const auto [least_m, greatest_m] = std::ranges::minmax(radius_m);
  if (span_rad > kMostSpan_rad || greatest_m > kMostRatio * least_m) return out;
  const double slack_m = phaseSlack_m(f, span_rad, greatest_m / least_m) + rounding_m;
  std::array<double, 3> phase_m{};
  for (std::size_t i = 0; i < 3; ++i) phase_m[i] = along_m[i] - f * turn_rad[i];
  out.from_m = std::max(out.from_m, *std::ranges::min_element(phase_m) - slack_m);
  out.to_m = std::min(out.to_m, *std::ranges::max_element(phase_m) + slack_m);
  return out;
}

ScrewSector ScrewSector::all() {
  constexpr double kMuch = 1e300;
  return {-std::numbers::pi, std::numbers::pi, -kMuch, kMuch};
}

void ScrewSector::add(ScrewSector other, double forward_m) {
  if (from_rad > to_rad) {
    *this = other;
    return;
  }
  if (isAll() || other.isAll()) {
    *this = all();
    return;
  }
  const double turns = std::round(0.5 * (from_rad + to_rad - other.from_rad - other.to_rad) / kFullTurn_rad);
  const double shift_rad = turns * kFullTurn_rad, shift_m = -forward_m * shift_rad;
  from_rad = std::min(from_rad, other.from_rad + shift_rad);
  to_rad = std::max(to_rad, other.to_rad + shift_rad);
  from_m = std::min(from_m, other.from_m + shift_m);
  to_m = std::max(to_m, other.to_m + shift_m);
  if (isAll()) *this = all();
}

MeetingTime meetingTime(const ScrewSector& moving, const ScrewSector& held, double forward_m,
                        const TurnedAngles& turned, double within_m, double nearest_m) {
  if (moving.isAll() || held.isAll() || nearest_m <= within_m) return {};
  // Seen from the axis, points within this distance of each other are at most so many radians apart.
  const double apart_rad = std::asin(within_m / nearest_m) + kAngleRounding_rad;
  const double low_rad = held.from_rad - moving.to_rad - apart_rad,
               high_rad = held.to_rad - moving.from_rad + apart_rad;
  const auto [least_rad, most_rad] = std::minmax({turned.start_rad, turned.end_rad});
  // The angles meet k whole turns after low_rad to high_rad; of these, the phases leave some k.
  double first = std::ceil((least_rad - high_rad) / kFullTurn_rad),
         last = std::floor((most_rad - low_rad) / kFullTurn_rad);
  if (forward_m != 0) {
    const double apart_m = within_m + std::abs(forward_m) * apart_rad;
    const double lead_m = kFullTurn_rad * forward_m;
    const auto [from, to] = std::minmax(
        {(held.from_m - moving.to_m - apart_m) / lead_m, (held.to_m - moving.from_m + apart_m) / lead_m});
    first = std::max(first, std::ceil(from));
    last = std::min(last, std::floor(to));
  }
  if (first > last) return {1, 0};
  const double from_rad = std::max(least_rad, low_rad + first * kFullTurn_rad),
               to_rad = std::min(most_rad, high_rad + last * kFullTurn_rad);
  if (turned.start_rad <= turned.end_rad) return {from_rad - turned.start_rad, to_rad - turned.start_rad};
  return {turned.start_rad - to_rad, turned.start_rad - from_rad};
}

ScrewSectors::ScrewSectors(const PartSurface& part, const Motion& screw, const Vec3& zero,
                           const AxisExtents& extents)
    : nodes(part.tree().nodes().size()), triangles(part.mesh().triangles.size()) {
  const Vec3 v = screw.direction.cross(zero);
  StridedPoll poll;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    poll(), triangles[i] = screwSector(part.triangle(i), screw, zero, v, extents.triangles[i].nearest_m);
  const auto& tree = part.tree().nodes();
  for (std::size_t n = tree.size(); n-- > 0;) {  // child nodes follow their parents
    if (!tree[n].isLeaf()) {
      nodes[n].add(nodes[n + 1], screw.forward_m);
      nodes[n].add(nodes[tree[n].right], screw.forward_m);
      continue;
    }
    for (std::uint32_t i = tree[n].first; i < tree[n].end; ++i)
      nodes[n].add(triangles[part.tree().order()[i]], screw.forward_m);
  }
}

}  // namespace vps::scenes
