// SPDX-License-Identifier: BSD-3-Clause
#include "vps/box.h"

#include <limits>

namespace vps {

bool overlap(const Box& a, const Box& b) noexcept {
  return !a.isEmpty() && !b.isEmpty() && (a.min.array() <= b.max.array()).all() &&
         (b.min.array() <= a.max.array()).all();
}

bool isWithin(const Box& inner, const Box& outer) noexcept {
  return inner.isEmpty() ||
         ((inner.min.array() >= outer.min.array()).all() && (inner.max.array() <= outer.max.array()).all());
}

Box grown(const Box& box, double by_m) noexcept {
  if (box.isEmpty()) return box;
  Box out = box;
  out.min.array() -= by_m;
  out.max.array() += by_m;
  return out;
}

double distance_m(const Box& a, const Box& b) noexcept {
  if (a.isEmpty() || b.isEmpty()) return std::numeric_limits<double>::infinity();
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0).norm();
}

Box moved(const Box& box, const Pose& X) noexcept {
  Box out;
  if (box.isEmpty()) return out;
  const Vec3 center = X * box.center(), half = X.R.cwiseAbs() * (0.5 * box.size());
  out.add(center - half);
  out.add(center + half);
  return out;
}

}  // namespace vps
