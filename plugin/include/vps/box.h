// SPDX-License-Identifier: BSD-3-Clause
// Axis-aligned boxes.
#pragma once

#include "vps/pose.h"

namespace vps {

/// An axis-aligned box [m], including its faces. A new box is empty.
struct Box {
  Vec3 min = Vec3::Constant(1e300);
  Vec3 max = Vec3::Constant(-1e300);
  void add(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  [[nodiscard]] bool isEmpty() const { return (min.array() > max.array()).any(); }
  [[nodiscard]] Vec3 center() const { return 0.5 * (min + max); }
  [[nodiscard]] Vec3 size() const { return max - min; }
};

/// True if the boxes share a point. An empty box shares no point with any box.
[[nodiscard]] inline bool overlap(const Box& a, const Box& b) noexcept {
  return !a.isEmpty() && !b.isEmpty() && (a.min.array() <= b.max.array()).all() &&
         (b.min.array() <= a.max.array()).all();
}
/// True if the point lies in the box. No point lies in an empty box.
[[nodiscard]] inline bool isWithin(const Vec3& p, const Box& box) noexcept {
  return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
}
/// True if all of `inner` lies in `outer`. An empty box lies in every box.
[[nodiscard]] inline bool isWithin(const Box& inner, const Box& outer) noexcept {
  return inner.isEmpty() ||
         ((inner.min.array() >= outer.min.array()).all() && (inner.max.array() <= outer.max.array()).all());
}
/// The box grown by `by_m` on every side. An empty box stays empty.
[[nodiscard]] inline Box grown(const Box& box, double by_m) noexcept {
  if (box.isEmpty()) return box;
  Box out = box;
  out.min.array() -= by_m;
  out.max.array() += by_m;
  return out;
}
/// Squared distance [m^2] of the boxes' nearest points; 0 where they overlap, infinite if one of the boxes is
/// a new Box, which is empty.
[[nodiscard]] inline double distance2(const Box& a, const Box& b) noexcept {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).squaredNorm();
}
/// The smallest box around a box that was moved by X. An empty box stays empty.
[[nodiscard]] inline Box moved(const Box& box, const Pose& X) noexcept {
  Box out;
  if (box.isEmpty()) return out;
  const Vec3 center = X * box.center(), half = X.R.cwiseAbs() * (0.5 * box.size());
  out.add(center - half);
  out.add(center + half);
  return out;
}

}  // namespace vps
