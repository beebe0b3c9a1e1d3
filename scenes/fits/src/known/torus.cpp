// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "known/known_overlap.h"

namespace vps::scenes {

namespace {

constexpr double kPi = std::numbers::pi;

/// The axis about which a body of revolution has its one moment of inertia that differs from both others.
std::optional<Vec3> axisOf(const MassProperties& mass) {
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(mass.inertia_m5);
  const Vec3 moments = principal.eigenvalues();  // ascending; a ring's greatest is about its axis
  constexpr double kSame = 0.01, kOther = 0.05;
  if (moments[1] - moments[0] > kSame * moments[1] || moments[2] < (1 + kOther) * moments[1])
    return std::nullopt;
  return principal.eigenvectors().col(2);
}

}  // namespace

std::optional<Torus> torusOf(const PartSurface& part) {
  constexpr double kOff = 0.01, kRounding_m = 2e-6, kVolume = 0.1;
  if (!part.isClosed()) return std::nullopt;
  const MassProperties mass = massProperties(part.mesh());
  if (!(mass.volume_m3 > 0)) return std::nullopt;
  const std::optional<Vec3> axis = axisOf(mass);
  if (!axis) return std::nullopt;
  const auto fromAxis = [&](const Vec3& x) {
    const Vec3 r = x - mass.com;
    return (r - axis->dot(r) * *axis).norm();
  };
  double least_m = std::numeric_limits<double>::max(), most_m = 0, high_m = 0;
  for (const Vec3& x : part.mesh().vertices) {
    least_m = std::min(least_m, fromAxis(x));
    most_m = std::max(most_m, fromAxis(x));
    high_m = std::max(high_m, std::abs(axis->dot(x - mass.com)));
  }
  // The corners of the section need not lie at its innermost and outermost points, so both widths count.
  Torus out{*axis, mass.com, 0.5 * (least_m + most_m), std::max(0.5 * (most_m - least_m), high_m)};
  if (!(out.ring_m > out.section_m)) return std::nullopt;
  const bool is_on = std::ranges::all_of(part.mesh().vertices, [&](const Vec3& x) {
    const double off_m = std::hypot(fromAxis(x) - out.ring_m, axis->dot(x - mass.com)) - out.section_m;
    return std::abs(off_m) < kOff * out.section_m + kRounding_m;
  });
  const double whole_m3 = 2 * kPi * kPi * out.ring_m * out.section_m * out.section_m;
  // Only a whole ring has its middle on its axis; the volume excludes a tube.
  if (!is_on || std::abs(mass.volume_m3 - whole_m3) > kVolume * whole_m3) return std::nullopt;
  return out;
}

Squash::Squash(const PlacedSurface& seal, const Torus& torus, const PlacedSurface& other)
    : in_m_(static_cast<std::size_t>(kTurns) * kDirections), section_m_(torus.section_m) {
  constexpr int kSteps = 16, kHalvings = 12;
  const Pose X_OS = other.X_WP.inverse() * seal.X_WP;
  const Solid& solid = other.surface->solid();
  const Vec3 u = torus.axis.unitOrthogonal(), v = torus.axis.cross(u);
  for (int i = 0; i < kTurns; ++i) {
    const double turn_rad = 2 * kPi * (i + 0.5) / kTurns;
    const Vec3 out = std::cos(turn_rad) * u + std::sin(turn_rad) * v, middle = torus.p + torus.ring_m * out;
    for (int k = 0; k < kDirections; ++k) {
      const double across_rad = 2 * kPi * k / kDirections;
      const Vec3 way = std::cos(across_rad) * out + std::sin(across_rad) * torus.axis;
      const auto isIn = [&](double share) {
        return solid.isInside(X_OS * (middle + share * section_m_ * way));
      };
      double& in_m = in_m_[static_cast<std::size_t>(i) * kDirections + k];
      int step = 0;
      while (step <= kSteps && !isIn(static_cast<double>(step) / kSteps)) ++step;
      if (step > kSteps) continue;
      double free = std::max(0, step - 1) / static_cast<double>(kSteps),
             inside = step / static_cast<double>(kSteps);
      for (int n = 0; n < kHalvings && inside > free; ++n)
        (isIn(0.5 * (free + inside)) ? inside : free) = 0.5 * (free + inside);
      in_m = (1 - inside) * section_m_;
    }
  }
}

void Squash::add(const Squash& other) {
  for (std::size_t i = 0; i < in_m_.size(); ++i) in_m_[i] = std::max(in_m_[i], other.in_m_[i]);
}

bool Squash::isAllAround() const {
  constexpr double kLeast = 0.5;
  double least_m = std::numeric_limits<double>::max(), most_m = 0;
  for (auto at = in_m_.begin(); at != in_m_.end(); at += kDirections) {
    const double deepest_m = *std::max_element(at, at + kDirections);
    least_m = std::min(least_m, deepest_m);
    most_m = std::max(most_m, deepest_m);
  }
  return most_m > 0 && least_m >= kLeast * most_m;
}

double Squash::share() const {
  double most_m = 0;
  for (std::size_t i = 0; i < in_m_.size(); ++i) {
    const std::size_t first = i - i % kDirections, k = i % kDirections;
    most_m = std::max(most_m, in_m_[i] + in_m_[first + (k + kDirections / 2) % kDirections]);
    if (in_m_[i] >= section_m_) return 1;
  }
  return most_m / (2 * section_m_);
}

}  // namespace vps::scenes
