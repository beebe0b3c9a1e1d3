// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/selection/contact_selection.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "native_shapes/native_shape_adapter.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

void addArea(const Candidate& from, Candidate& to) {
  const double sum_m2 = to.area_m2 + from.area_m2;
  if (!(sum_m2 > 0)) return;
  const double share = from.area_m2 / sum_m2;
  const Vec3 apart_W = from.areaCenter_W() - to.areaCenter_W();
  const Eigen::Vector3f apart = apart_W.cast<float>();
  const auto part = static_cast<float>(share);
  to.area_spread +=
      part * (from.area_spread - to.area_spread) + part * (1 - part) * apart * apart.transpose();
  to.area_off_W += share * apart_W;
  to.area_m2 = sum_m2;
}

namespace {

using Moments = Eigen::Matrix<double, 10, 1>;

// Values of the polynomials of up to second degree.
Moments momentsAt(const Vec3& r) {
  Moments m;
  m << 1, r, r.cwiseAbs2(), r.x() * r.y(), r.y() * r.z(), r.z() * r.x();
  return m;
}

// Integrals of the polynomials of momentsAt() over the surface that a point represents.
Moments momentsOf(const Candidate& c, const Vec3& center, double length_m) {
  const Mat3 spread = c.area_spread.cast<double>() / (length_m * length_m);
  Moments m = momentsAt((c.areaCenter_W() - center) / length_m);
  m.tail<6>() +=
      (Eigen::Matrix<double, 6, 1>() << spread.diagonal(), spread(0, 1), spread(1, 2), spread(2, 0))
          .finished();
  return c.area_m2 * m;
}

bool touches(const Candidate& c) {
  return c.distance_m < kSamePlace_m;
}

std::size_t nearestOf(const std::vector<Candidate>& chosen, const Vec3& p_W, const Vec3& n_W) {
  std::size_t nearest = chosen.size();
  double nearest_m2 = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const double here_m2 = (chosen[k].p_W - p_W).squaredNorm();
    if (!(here_m2 < nearest_m2) || chosen[k].n_W.dot(n_W) < kCosSameFace) continue;
    nearest_m2 = here_m2;
    nearest = k;
  }
  return nearest;
}

// Side whose touching points have the smaller area. The points of both sides cover the contact area; points
// of the larger face also cover its surroundings.
std::uint8_t sideOfLess(const std::vector<Candidate>& all) {
  double area_m2[2] = {0, 0};
  for (const Candidate& c : all)
    if (touches(c)) area_m2[c.side] += c.area_m2;
  return area_m2[0] > 0 && (area_m2[0] <= area_m2[1] || !(area_m2[1] > 0)) ? 0 : 1;
}

// Moves the contacts of curved faces that lie flush in each other to the middle of their areas, as far as
// points touch there. Curved faces that lie flush need no contact at the rim against tipping, and a contact
// at the rim of a thread would hold more friction than the thread does.
void moveToMiddle(const std::vector<Candidate>& all, const std::vector<Candidate>& areas,
                  std::vector<Candidate>& chosen) {
  if (std::none_of(chosen.begin(), chosen.end(), [](const Candidate& c) { return c.is_flush; })) return;
  const std::vector<Candidate> from = chosen;
  std::vector<double> nearest_m2;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    nearest_m2.push_back((from[k].p_W - areas[k].areaCenter_W()).squaredNorm());
  for (const Candidate& c : all) {
    if (!c.is_flush) continue;
    const std::size_t k = nearestOf(from, c.p_W, c.n_W);
    if (k == from.size() || !from[k].is_flush || !(areas[k].area_m2 > 0)) continue;
    const double here_m2 = (c.p_W - areas[k].areaCenter_W()).squaredNorm();
    if (!(here_m2 < nearest_m2[k]) || c.distance_m > from[k].distance_m + kSamePlace_m) continue;
    nearest_m2[k] = here_m2;
    chosen[k] = c;
  }
}

// Corrects the areas to the wanted moments, by the least change relative to the areas.
void correct(std::vector<Candidate>& chosen, const Vec3& center, double length_m, const Moments& wanted) {
  constexpr double kLeast = 0.1;  // least share of an area that remains; assumed
  Eigen::Matrix<double, 10, 10> gram = Eigen::Matrix<double, 10, 10>::Zero();
  Moments missing = wanted;
  for (const Candidate& c : chosen) {
    const Moments m = momentsAt((c.p_W - center) / length_m);
    gram += c.area_m2 * m * m.transpose();
    missing -= c.area_m2 * m;
  }
  // In a plane some of the polynomials are linearly dependent.
  gram.diagonal().array() += kSettledShare * gram.trace();
  const Moments factors = gram.ldlt().solve(missing);
  if (!factors.allFinite()) return;
  for (Candidate& c : chosen)
    c.area_m2 *= std::max(1 + factors.dot(momentsAt((c.p_W - center) / length_m)), kLeast);
}

}  // namespace

void keepFacingShares(const PairView& pair, std::vector<Candidate>& points) {
  const SideView side[2] = {pair.side(0), pair.side(1)};
  const bool is_native[2] = {dynamic_cast<const NativeShapeAdapter*>(pair.shape[0]) != nullptr,
                             dynamic_cast<const NativeShapeAdapter*>(pair.shape[1]) != nullptr};
  for (Candidate& c : points) {
    if (c.isCrossing() || !side[c.side].shape) continue;
    if (is_native[c.side]) c.area_m2 = 0;  // corners of a native shape represent no area
    // The squared components of a direction along the normals of perpendicular faces add up to 1.
    const double facing = c.n_W.dot(side[c.side].X_WM.R * side[c.side].shape->models().shell->inward[c.id]);
    c.area_m2 *= facing * facing;
  }
}

void shareAreas(const std::vector<Candidate>& all, double length_m, std::vector<Candidate>& chosen) {
  if (chosen.empty()) return;
  const std::uint8_t side = sideOfLess(all);
  const Vec3 center = chosen.front().p_W;
  std::vector<Candidate> areas(chosen.size());
  Moments wanted = Moments::Zero();
  for (const Candidate& c : all) {
    if (c.side != side || !touches(c)) continue;
    const std::size_t k = nearestOf(chosen, c.areaCenter_W(), c.n_W);
    if (k == chosen.size()) continue;
    addArea(c, areas[k]);
    wanted += momentsOf(c, center, length_m);
  }
  moveToMiddle(all, areas, chosen);
  for (std::size_t k = 0; k < chosen.size(); ++k) chosen[k].area_m2 = areas[k].area_m2;
  if (wanted[0] > 0) correct(chosen, center, length_m, wanted);
  std::sort(chosen.begin(), chosen.end(),
            [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); });
}

}  // namespace vps::bullet
