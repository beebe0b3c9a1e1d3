// SPDX-License-Identifier: BSD-3-Clause
// What the points of a shell do not say about the curved face between them.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/pair_view.h"

namespace vps::bullet {

/// Greatest and least curvature of a curved surface [1/m]; convex is positive, a plane has none.
struct Curvature {
  double most_per_m = 0, least_per_m = 0;

  Curvature() = default;
  /// @param turn_per_m  turn of the outward normal along ways in its plane: symmetric, zero along the normal
  explicit Curvature(const Mat3& turn_per_m);
};

/// How much nearer two bodies may be between points of a shell than at the nearest of these [m]. Every place
/// has a point of its face within the spacing; there the gap of two surfaces has risen by this parabola at
/// most.
/// @param curvature_per_m  greatest sum of both surfaces' curvatures
inline double samplingError_m(double spacing_m, double curvature_per_m) {
  return 0.5 * spacing_m * spacing_m * std::max(curvature_per_m, 0.0);
}

/// The same of points whose readings alone are known: their own face curves as it does around them, and the
/// other's as it does most around its own near points.
class SamplingError {
 public:
  /// @param near  points of both sides
  SamplingError(const PairView& pair, std::span<const Candidate> near);
  /// Zero of points on edges, of crossings and of parts without surfaces.
  [[nodiscard]] double of_m(const Candidate& c) const;

 private:
  const PairView& pair_;
  std::array<double, 2> most_per_m_{0, 0};
};

}  // namespace vps::bullet
