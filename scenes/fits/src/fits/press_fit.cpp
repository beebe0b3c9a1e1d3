// SPDX-License-Identifier: BSD-3-Clause
#include "fits/press_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "surface/around_axis.h"

namespace vps::scenes {

namespace {

/// Relative difference between the sizes of one face in files that keep six digits.
constexpr double kPressFitRounding = 2e-6;

bool isOf(const CheckedFit& fit, const CheckedPair& pair) {
  return (fit.shaft == pair.a && fit.bore == pair.b) || (fit.shaft == pair.b && fit.bore == pair.a);
}

double interferenceOf(const CheckedFit& fit) {
  const double beyond_m = fit.error_m + kPressFitRounding * fit.shaft_m + kOverlapCertain_m;
  return fit.diametral_clearance_m < -beyond_m ? -fit.diametral_clearance_m : 0;
}

constexpr double kMiddle = 0.25;  // examined share of the length to each side of the middle, without chamfers
constexpr double kFacingOut = 0.1;  // least radial part of the normal of a facet that bounds the ring

double hubOf(const CheckedFit& fit, const PlacedSurface& hub) {
  double least_m = std::numeric_limits<double>::max();
  NearAxis(fit.axis_W, fit.at_W, hub, kMiddle * fit.length_m)
      .forEachFacet([&](double from_m, double, double outward, std::uint32_t) {
        if (outward > kFacingOut && from_m > 0.5 * fit.bore_m) least_m = std::min(least_m, from_m);
      });
  return 2 * least_m;
}

double holeOf(const CheckedFit& fit, const PlacedSurface& shaft) {
  double most_m = 0;
  NearAxis(fit.axis_W, fit.at_W, shaft, kMiddle * fit.length_m)
      .forEachFacet([&](double, double to_m, double outward, std::uint32_t) {
        if (outward < -kFacingOut && to_m < 0.5 * fit.shaft_m) most_m = std::max(most_m, to_m);
      });
  return 2 * most_m;
}

CheckedPress pressOf(const CheckedFit& fit, const PlacedSurface& shaft, const PlacedSurface& hub,
                     double declared_m) {
  PressedRing ring{fit.shaft_m,
                   hubOf(fit, hub),
                   holeOf(fit, shaft),
                   fit.length_m,
                   std::sqrt(shaft.drawn->friction * hub.drawn->friction),
                   shaft.drawn->youngs_modulus_Pa,
                   shaft.drawn->poissons_ratio,
                   hub.drawn->youngs_modulus_Pa,
                   hub.drawn->poissons_ratio};
  CheckedPress press;
  press.hub_m = ring.hub_m;
  press.hole_m = ring.hole_m;
  press.shaft_modulus_Pa = ring.shaft_modulus_Pa;
  press.hub_modulus_Pa = ring.hub_modulus_Pa;
  press.friction = ring.friction;
  const double area_m2 = std::numbers::pi * ring.joint_m * ring.length_m;
  press.pressure_Pa = jointPressure(ring, -fit.diametral_clearance_m);
  press.force_N = press.pressure_Pa * area_m2 * ring.friction;
  press.declared_force_N = jointPressure(ring, declared_m) * area_m2 * ring.friction;
  // Tresca at the bore: hoop stress p (D2 + d2) / (D2 - d2), radial stress -p.
  const double share = std::pow(ring.joint_m / ring.hub_m, 2);
  press.hub_stress_Pa = press.pressure_Pa * 2 / (1 - share);
  return press;
}

void judge(const std::vector<PlacedSurface>& parts, CheckedPair& pair, std::vector<CheckedFit>& fits) {
  const bool is_contact = pair.state == PairState::Contact;
  bool is_declared = true;
  double hidden_m = 0;  // greatest radial interference that the facets hide
  const double facets_off_m = pair.error_m;
  double depth_limit_m = pair.press_fit_m;
  for (CheckedFit& fit : fits) {
    const double of_fit_m = interferenceOf(fit);
    if (of_fit_m == 0 || !isOf(fit, pair)) continue;
    depth_limit_m = 0.5 * pair.press_fit_m;  // the declared length is in diameter or width: half to each side
    is_declared = is_declared && of_fit_m - fit.error_m <= pair.press_fit_m;
    const bool is_hidden = is_contact && fit.kind == FitKind::Shaft && fit.offset_m < 0.5 * of_fit_m;
    if (is_hidden) {
      const RingVolume ring = ringVolume(fit, named(parts, fit.shaft), named(parts, fit.bore), facets_off_m);
      pair.interference_volume_m3 += ring.volume_m3;
      pair.volume_error_m3 += ring.error_m3;
    }
    if (is_hidden && 0.5 * of_fit_m > hidden_m) {
      hidden_m = pair.interference_depth_m = 0.5 * of_fit_m;
      pair.error_m = 0.5 * fit.error_m + fit.offset_m;
      pair.clearance_m = 0;
      pair.at_W = fit.at_W + 0.5 * fit.shaft_m * fit.axis_W.unitOrthogonal();
    }
    if (pair.press_fit_m > 0 && fit.kind == FitKind::Shaft)
      fit.press = pressOf(fit, named(parts, fit.shaft), named(parts, fit.bore), pair.press_fit_m);
  }
  if (is_contact && (hidden_m == 0 || !pair.isBeyondContact())) return;
  pair.state =
      pair.press_fit_m > 0 && is_declared && pair.interference_depth_m - pair.error_m <= depth_limit_m
          ? PairState::PressFit
          : PairState::Clash;
}

}  // namespace

double jointPressure(const PressedRing& ring, double interference_m) {
  const auto ratio = [](double outer_m, double inner_m) {
    const double share = std::pow(inner_m / outer_m, 2);
    return (1 + share) / (1 - share);
  };
  const double give = (ratio(ring.hub_m, ring.joint_m) + ring.hub_ratio) / ring.hub_modulus_Pa +
                      (ratio(ring.joint_m, ring.hole_m) - ring.shaft_ratio) / ring.shaft_modulus_Pa;
  return interference_m / (ring.joint_m * give);
}

bool needsFit(const CheckedPair& pair) {
  return pair.state == PairState::Contact ? pair.error_m > kOverlapCertain_m
                                          : pair.state == PairState::Clash && pair.press_fit_m > 0;
}

void removeFalseFits(CheckResult& result) {
  std::erase_if(result.fits, [&](const CheckedFit& fit) {
    const double interference_m = interferenceOf(fit);
    if (interference_m == 0) return false;
    const auto pair = std::ranges::find_if(result.pairs, [&](const CheckedPair& p) { return isOf(fit, p); });
    return pair == result.pairs.end() ||
           0.5 * interference_m > pair->interference_depth_m + pair->error_m + fit.error_m;
  });
}

void judgeByFits(const std::vector<PlacedSurface>& parts, CheckResult& result) {
  for (CheckedPair& pair : result.pairs)
    if (needsFit(pair)) judge(parts, pair, result.fits);
}

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
