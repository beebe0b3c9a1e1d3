// SPDX-License-Identifier: BSD-3-Clause
// B: the height of a bounce does not depend on the length of the step, nor on the time within the step at
// which the body hits the plate.
//
// After an impact with restitution e the speed is e times, and so the height e^2 times, that before.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "families/family.h"
#include "families/impacts/impact_world.h"
#include "support/random_draw.h"

namespace vps::families {
namespace {

using dynamics::Placed;
using test::Random;

constexpr double kGravity_m_s2 = dynamics::World::kGravity_m_s2;
const Vec3 kCube_m(20e-3, 20e-3, 10e-3);

/// A cube dropped onto a plate. After k bounces the cube rises to e^(2k) of its initial height.
struct Bounces {
  double e = 1, height_m = 20e-3, dt_s = 1e-3;

  static constexpr std::array<double, 3> kRates_hz{240, 1000, 4000};

  explicit Bounces(int member) {
    Random random(0xb4 + static_cast<std::uint64_t>(member));
    dt_s = 1 / kRates_hz[static_cast<std::size_t>(member % 3)];
    if (member < 3) return;
    height_m = random.uniform(10e-3, 40e-3);
    e = random.chance(0.3) ? 1 : random.uniform(0.3, 1);
  }
  // The number of bounces that are faster than Bullet's threshold of restitution, 0.2 m/s, by more than
  // gravity adds in two steps.
  [[nodiscard]] int count() const {
    const double least_m_s = 0.2 + 2 * kGravity_m_s2 * dt_s;
    int k = 0;
    for (double v_m_s = std::sqrt(2 * kGravity_m_s2 * height_m); k < 5 && v_m_s > least_m_s; v_m_s *= e) ++k;
    return k;
  }
  /// Height of each peak over e^(2k) times the height at the start, less 1. The positions of a body in flight
  /// lie on a parabola, so three of them give its peak.
  [[nodiscard]] std::vector<double> errors() const {
    ImpactWorld scene;
    scene.addFixed(boxPart(Vec3(0.2, 0.2, 0.02)), Pose::translation(Vec3(0, 0, -0.01)), 1, 0);
    const double half_m = 0.5 * kCube_m.z();
    const Placed body = scene.add(boxPart(kCube_m), Pose::translation(Vec3(0, 0, half_m + height_m)), e, 0);
    // Bullet's first step moves the body by g dt^2, so the parabola of its positions has its peak half a step
    // before the start.
    const double top_m = height_m + kGravity_m_s2 * dt_s * dt_s / 8;
    std::array<double, 3> z_m{height_m, height_m, height_m};
    std::vector<double> found;
    const int most = static_cast<int>(2 / dt_s);
    for (int i = 0; i < most && static_cast<int>(found.size()) < count(); ++i) {
      scene.world.step(1, dt_s);
      z_m = {z_m[1], z_m[2], body.pose().p.z() - half_m};
      const double bend_m = z_m[2] - 2 * z_m[1] + z_m[0], rise_m = z_m[2] - z_m[0];
      if (i < 3 || !(z_m[1] > z_m[0]) || !(z_m[1] >= z_m[2])) continue;
      const double peak_m = z_m[1] - rise_m * rise_m / (8 * bend_m);
      found.push_back(peak_m / (top_m * std::pow(e, 2.0 * static_cast<double>(found.size() + 1))) - 1);
    }
    found.resize(static_cast<std::size_t>(count()), -1);
    return found;
  }
  /// The greatest error by magnitude.
  [[nodiscard]] double error() const {
    double worst = 0;
    for (const double one : errors()) worst = std::max(worst, std::abs(one));
    return worst;
  }
  [[nodiscard]] std::string words() const {
    char text[200];
    int length =
        std::snprintf(text, sizeof text, "from %.3f mm, e %.2f, %.3g ms:", 1e3 * height_m, e, 1e3 * dt_s);
    for (const double one : errors())
      length += std::snprintf(text + length, sizeof text - static_cast<std::size_t>(length), " %+.2g", one);
    return text;
  }
};

/// The mean of the signed errors over 12 heights. The mean is near zero if the time of the impact within the
/// step does not matter.
double meanBounceError(int member) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 12; ++i) {
    Bounces bounces(3 + i);
    bounces.dt_s = 1 / Bounces::kRates_hz[static_cast<std::size_t>(member % 3)];
    bounces.e = std::array<double, 3>{0.5, 0.8, 1}[static_cast<std::size_t>(member / 3)];
    for (const double one : bounces.errors()) sum += one, ++count;
  }
  return std::abs(sum / std::max(count, 1));
}

}  // namespace

std::vector<Family> bounceFamilies() {
  return {
      {"B_heights", "error of a height after 1 to 5 bounces, relative to e^(2k) h", 0.002, 60, 4,
       [](int i) { return Bounces(i).error(); }, [](int i) { return Bounces(i).words(); }},
      {"B_mean_heights", "mean error of heights, relative to e^(2k) h", 5e-4, 9, 4, meanBounceError},
  };
}

}  // namespace vps::families
