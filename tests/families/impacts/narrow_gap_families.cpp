// SPDX-License-Identifier: BSD-3-Clause
// C: restitution in gaps below a step's travel. The depth must be that of the same run without restitution,
// after every step and at poses within it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "families/family.h"
#include "families/impacts/impact_world.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"

namespace vps::families {
namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using test::Random;

constexpr std::array<double, 4> kSteps_s{0.25e-3, 0.5e-3, 1e-3, 2e-3};
constexpr double kToUm = 1e6;

const PartMesh& ballPart(double radius_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {radius_m}, [&] { return dynamics::makePart(makeSphere(radius_m, 4)); });
}
const PartMesh& tubePart(double outer_m, double inner_m, double height_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {outer_m, inner_m, height_m},
                            [&] { return dynamics::makePart(makeTube(outer_m, inner_m, height_m, 128)); });
}
const PartMesh& pinPart(double radius_m, double height_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {radius_m, height_m},
                            [&] { return dynamics::makePart(makeCylinder(radius_m, height_m, 128)); });
}

/// Greatest depth [um] of a body in a fixed one: after each step, and at poses within the step, whose motion
/// is a straight line and one rotation.
double deepest_um(ImpactWorld& scene, const Placed& body, const Placed& fixed, int steps, double dt_s,
                  int places = 4) {
  double deepest_m = -1;
  for (int k = 0; k < steps; ++k) {
    const Pose from = body.pose();
    scene.world.step(1, dt_s);
    const Pose to = body.pose();
    for (int i = 1; i <= places; ++i)
      deepest_m =
          std::max(deepest_m, dynamics::penetration_m(body.part, interpolate(from, to, double(i) / places),
                                                      fixed.part, fixed.pose()));
  }
  return kToUm * deepest_m;
}

/// A ball or a pin that flies sideways in a bore.
struct Bore {
  bool is_pin = false;
  double inner_m = 15e-3, wall_m = 5e-3, gap_m = 1e-3;
  double speed_m_s = 5, restitution = 0.9, friction = 0.15, dt_s = 1e-3;
  double direction_rad = 0.1;
  Vec3 w_rad_s = Vec3::Zero();

  Bore(int member, bool pin) : is_pin(pin) {
    if (pin) {
      inner_m = 5e-3;
      gap_m = 0.05e-3;
      speed_m_s = 2;
    }
    if (member == 0) return;
    if (!pin && member < 3) {
      speed_m_s = member == 1 ? 20 : 50;
      return;
    }
    Random random((pin ? 0xc1 : 0xc0) + 2 * static_cast<std::uint64_t>(member));
    constexpr std::array<double, 3> kInner_m{5e-3, 10e-3, 15e-3};
    constexpr std::array<double, 3> kGaps_m{0.05e-3, 0.2e-3, 1e-3};
    inner_m = kInner_m[static_cast<std::size_t>(random.index(pin ? 2 : 3))];
    gap_m = kGaps_m[static_cast<std::size_t>(random.index(pin ? 2 : 3))];
    wall_m = random.chance(0.5) ? 5e-3 : 1e-3;
    speed_m_s = random.logUniform(0.3, pin ? 5 : 60);
    restitution = random.chance(0.2) ? 1 : random.uniform(0.1, 1);
    friction = random.chance(0.3) ? 0 : 0.3;
    dt_s = kSteps_s[static_cast<std::size_t>(random.index(4))];
    direction_rad = random.uniform(0, 6.2);
    if (!pin) w_rad_s = random.uniform(0, 20) * random.direction();
  }
  [[nodiscard]] double depth_um(double e) const {
    ImpactWorld scene;
    scene.world.setGravity(Vec3::Zero());
    const double height_m = 20e-3;
    const Placed tube = scene.addFixed(tubePart(inner_m + wall_m, inner_m, height_m), Pose(), 1, friction);
    const PartMesh& part = is_pin ? pinPart(inner_m - gap_m, 30e-3) : ballPart(inner_m - gap_m);
    const Placed body = scene.add(part, Pose(), e, friction);
    setVelocity(body, speed_m_s * Vec3(std::cos(direction_rad), std::sin(direction_rad), is_pin ? 0.05 : 0),
                w_rad_s);
    double deepest = deepest_um(scene, body, tube, 60, dt_s);
    // The body must still be within the bore.
    const Vec3 p = body.pose().p;
    if (std::hypot(p.x(), p.y()) > 2 * gap_m && std::abs(p.z()) < height_m / 2)
      deepest = std::max(deepest, kToUm * std::hypot(p.x(), p.y()));
    return deepest;
  }
  [[nodiscard]] std::string words() const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "bore r %.3g mm, wall %.3g, gap %.3g mm, %.3g m/s, e %.2f, mu %.2f, %.2g ms; without "
                  "restitution %.3g um",
                  1e3 * inner_m, 1e3 * wall_m, 1e3 * gap_m, speed_m_s, restitution, friction, 1e3 * dt_s,
                  depth_um(0));
    return text;
  }
};

double ballDepth_um(int member) {
  const Bore bore(member, false);
  return bore.depth_um(bore.restitution);
}
double pinDepth_um(int member) {
  const Bore bore(member, true);
  return bore.depth_um(bore.restitution);
}

}  // namespace

std::vector<Family> narrowGapFamilies() {
  const std::string depth = "depth after and within steps [um]";
  return {
      {"C_balls", depth, 10, 80, 13, ballDepth_um, [](int i) { return Bore(i, false).words(); }},
      {"C_pins", depth, 10, 50, 10, pinDepth_um, [](int i) { return Bore(i, true).words(); }},
  };
}

}  // namespace vps::families
