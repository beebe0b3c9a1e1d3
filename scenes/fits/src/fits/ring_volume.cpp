// SPDX-License-Identifier: BSD-3-Clause
#include "fits/ring_volume.h"

#include <array>
#include <cmath>
#include <numbers>

namespace vps::scenes {

RingVolume ringVolume(const CheckedFit& fit, const PlacedSurface& shaft, const PlacedSurface& bore,
                      double aside_m) {
  constexpr int kAngles = 64, kPlaces = 16;
  const Vec3 u = fit.axis_W.unitOrthogonal(), v = fit.axis_W.cross(u);
  const auto hasMaterial = [](const PlacedSurface& part, const Vec3& p_W) {
    return part.surface->solid().isInside(part.X_WP.inverse() * p_W);
  };
  std::array<std::array<bool, kAngles>, kPlaces> is_shared{};
  int shared = 0, mixed = 0;
  for (int k = 0; k < kPlaces; ++k)
    for (int i = 0; i < kAngles; ++i) {
      const double turn_rad = 2 * std::numbers::pi * (i + 0.5) / kAngles;
      const Vec3 out = std::cos(turn_rad) * u + std::sin(turn_rad) * v;
      const Vec3 middle_W = fit.at_W + ((k + 0.5) / kPlaces - 0.5) * fit.length_m * fit.axis_W;
      is_shared[k][i] = hasMaterial(shaft, middle_W + (0.5 * fit.shaft_m - aside_m) * out) &&
                        hasMaterial(bore, middle_W + (0.5 * fit.bore_m + aside_m) * out);
      shared += is_shared[k][i] ? 1 : 0;
    }
  for (int k = 0; k < kPlaces; ++k)
    for (int i = 0; i < kAngles; ++i) {
      mixed += is_shared[k][i] != is_shared[k][(i + 1) % kAngles] ? 1 : 0;
      mixed += k > 0 && is_shared[k][i] != is_shared[k - 1][i] ? 1 : 0;
    }
  constexpr double kCells = kAngles * kPlaces;
  const double ring_m3 =
      std::numbers::pi / 4 * (fit.shaft_m * fit.shaft_m - fit.bore_m * fit.bore_m) * fit.length_m;
  const double surface_m2 = std::numbers::pi * fit.shaft_m * fit.length_m;
  return {ring_m3 * shared / kCells, ring_m3 * mixed / kCells + surface_m2 * 0.5 * fit.error_m};
}

}  // namespace vps::scenes
