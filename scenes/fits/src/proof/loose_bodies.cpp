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
  std::vector<double> allowed_m(parts.size(), kSightTolerance_m);
  for (const CheckedFit& fit : checked.fits) {
    // A fit within a body, such as a bushing pressed into a lever, does not position the body.
    if (sets.of(index_of.at(fit.shaft)) == sets.of(index_of.at(fit.bore))) continue;
    for (const std::string& name : {fit.shaft, fit.bore}) {
      double& least_m = allowed_m[index_of.at(name)];
      least_m = std::min(least_m, fitTolerance_m(fit.diametral_clearance_m));
    }
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
    of.allowed_m = std::min(of.allowed_m, allowed_m[i]);
    of.box_W.add(parts[i].box_W.min);
    of.box_W.add(parts[i].box_W.max);
  }
  for (MovableBody& body : bodies) {
    if (body.is_fixed) body.allowed_m = 0;
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
