// SPDX-License-Identifier: BSD-3-Clause
// Axis-aligned boxes.
#pragma once

#include "vps/export.h"
#include "vps/pose.h"

namespace vps {

/// An axis-aligned box [m]. Its faces belong to it. A new box is empty.
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

/// True if the boxes share a point. An empty box shares none.
[[nodiscard]] VPS_API bool overlap(const Box& a, const Box& b) noexcept;
/// True if the point lies in the box. No point lies in an empty box.
[[nodiscard]] inline bool isWithin(const Vec3& p, const Box& box) noexcept {
  return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
}
/// True if all of `inner` lies in `outer`. An empty box lies in every box.
[[nodiscard]] VPS_API bool isWithin(const Box& inner, const Box& outer) noexcept;
/// The box grown by `by_m` on every side. An empty box stays empty.
[[nodiscard]] VPS_API Box grown(const Box& box, double by_m) noexcept;
/// Distance of the nearest points; 0 where they overlap, infinite for an empty box.
[[nodiscard]] VPS_API double distance_m(const Box& a, const Box& b) noexcept;
/// The smallest box around a box that was moved by X. An empty box stays empty.
[[nodiscard]] VPS_API Box moved(const Box& box, const Pose& X) noexcept;

}  // namespace vps
