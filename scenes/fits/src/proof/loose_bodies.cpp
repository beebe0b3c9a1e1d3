// SPDX-License-Identifier: BSD-3-Clause
#include "proof/places.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "fits/fits.h"

namespace vps::scenes {

namespace {

/// Disjoint sets of numbers (union-find).
class Sets {
 public:
  explicit Sets(std::size_t count) : up_(count) { std::iota(up_.begin(), up_.end(), std::size_t{0}); }
  [[nodiscard]] std::size_t of(std::size_t i) const {
    while (up_[i] != i) i = up_[i];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    up_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> up_;
};

}  // namespace

double MovableBody::mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion) const {
  return mostMoved_m(motion, box_W);
}

double MovableBody::mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion, const Box& of_W) const {
  const Pose X = movedPose(Pose(), loose, motion);
  double most_m = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p_W = cornerOf(of_W, i);
    most_m = std::max(most_m, (X * p_W - p_W).norm());
  }
  return most_m;
}

bool MovableBody::allows(const Eigen::Matrix<double, 6, 1>& motion) const {
  if (mostMoved_m(motion) > allowed_m) return false;
  const Pose X = movedPose(Pose(), loose, motion);
  return std::ranges::all_of(limits, [&](const FitLimit& limit) {
    return std::ranges::all_of(
        limit.ends_W, [&](const Vec3& p_W) { return limit.limited(X * p_W - p_W).norm() <= limit.most_m; });
  });
}

void MovableBody::appendLimits(std::size_t variable, const Eigen::Matrix<double, 6, 1>& motion,
                               std::vector<GapRow>& rows) const {
  // The limit of a shaft is a circle; a polygon inside it has planes that are nearer to its middle by 2 %.
  constexpr int kSides = 16;
  const double inside = std::cos(std::numbers::pi / kSides);
  const Pose X = movedPose(Pose(), loose, motion);
  for (const FitLimit& limit : limits) {
    std::vector<Vec3> normals_W = {limit.axis_W, -limit.axis_W};
    if (!limit.is_key) {
      const Vec3 u_W = limit.axis_W.unitOrthogonal(), v_W = limit.axis_W.cross(u_W);
      normals_W.clear();
      for (int k = 0; k < kSides; ++k) {
        const double a = 2 * std::numbers::pi * k / kSides;
        normals_W.emplace_back(std::cos(a) * u_W + std::sin(a) * v_W);
      }
    }
    for (const Vec3& end_W : limit.ends_W)
      for (const Vec3& n_W : normals_W) {
        const Vec3 p_W = X * end_W;
        rows.push_back({variable, GapRow::kHeld, p_W, -n_W, inside * limit.most_m - n_W.dot(p_W - end_W)});
      }
  }
}

double MovableBody::mostTurn(double most_m) const {
  // Two corners whose distance across the axis is d move by 2 d sin(turn / 2) relative to each other, which
  // is at most 2 most_m. No axis is parallel to both of the longer edges, so d is at least the second longest
  // edge divided by the root of two.
  std::array<double, 3> edges = {box_W.size().x(), box_W.size().y(), box_W.size().z()};
  std::ranges::sort(edges);
  const double across_m = edges[1] / std::numbers::sqrt2;
  return across_m > most_m ? 2 * std::asin(most_m / across_m) : std::numbers::pi;
}

std::vector<MovableBody> looseBodies(const std::vector<PlacedSurface>& parts, const CheckResult& checked) {
  std::unordered_map<std::string_view, std::size_t> index_of;
  for (std::size_t i = 0; i < parts.size(); ++i) index_of.emplace(parts[i].name, i);
  Sets sets(parts.size());
  std::size_t first_fixed = parts.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].drawn->is_fixed) continue;
    if (first_fixed == parts.size()) first_fixed = i;
    sets.join(first_fixed, i);
  }
  for (const CheckedPair& pair : checked.pairs)
    if (pair.state == PairState::PressFit) sets.join(index_of.at(pair.a), index_of.at(pair.b));
  std::vector<std::vector<FitLimit>> limits(parts.size());
  for (const CheckedFit& fit : checked.fits) {
    // A fit within a body, such as a bushing pressed into a lever, does not position the body.
    if (sets.of(index_of.at(fit.shaft)) == sets.of(index_of.at(fit.bore))) continue;
    const Vec3 half_W = 0.5 * fit.length_m * fit.along_W;
    const FitLimit limit{{fit.at_W - half_W, fit.at_W + half_W},
                         fit.axis_W,
                         fit.kind == FitKind::Key,
                         fitTolerance_m(fit.diametral_clearance_m)};
    for (const std::string& name : {fit.shaft, fit.bore}) limits[index_of.at(name)].push_back(limit);
  }
  std::vector<MovableBody> bodies;
  std::vector<std::size_t> at(parts.size(), parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::size_t& body = at[sets.of(i)];
    if (body == parts.size()) {
      body = bodies.size();
      bodies.emplace_back().allowed_m = kSightTolerance_m;
    }
    MovableBody& of = bodies[body];
    of.parts.push_back(i);
    of.is_fixed = of.is_fixed || parts[i].drawn->is_fixed;
    of.limits.insert(of.limits.end(), limits[i].begin(), limits[i].end());
    of.box_W.add(parts[i].box_W.min);
    of.box_W.add(parts[i].box_W.max);
  }
  for (MovableBody& body : bodies) {
    if (body.is_fixed) body.allowed_m = 0, body.limits.clear();
    body.loose = {body.box_W.center(), 0.5 * body.box_W.size().norm(), body.allowed_m};
  }
  return bodies;
}

std::vector<std::size_t> bodyOfPart(const std::vector<MovableBody>& bodies, std::size_t part_count) {
  std::vector<std::size_t> out(part_count);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (const std::size_t part : bodies[i].parts) out[part] = i;
  return out;
}

}  // namespace vps::scenes
