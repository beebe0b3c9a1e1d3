// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "haptic_rig.h"
#include "rows.h"
#include "vps_device/operator.h"

namespace vps::bench {

namespace {

using dynamics::Mode;
using dynamics::PartMesh;
using dynamics::Placed;

struct RigDevice {
  const char* name;
  device::SimulatedDualArmSettings settings;
  bool is_judged;
};

std::vector<RigDevice> devices() {
  return {{"ideal", device::idealDualArm(), true}, {"real", realDualArm(), false}};
}

// Results with real encoders and structure are reported, but not judged.
Figure judged(const RigDevice& device, const std::string& what, double value, double bar, double scale,
              const std::string& unit) {
  return device.is_judged ? atMost(what, value, bar, scale, unit) : reported(what, value, scale, unit);
}

RigSettings rigFor(const RigDevice& device, Mode mode, double stiffness_N_per_m3 = 1e12,
                   double spacing_m = 0.5e-3) {
  bullet::Settings bullet;
  bullet.stiffness_N_per_m3 = stiffness_N_per_m3;
  RigSettings settings;
  settings.scene.mode = mode;
  settings.scene.engine = dynamics::vpsEngine({0.25e-3, spacing_m}, bullet);
  settings.device = device.settings;
  return settings;
}

const PartMesh& plate() {
  static const PartMesh part = dynamics::makePart(makeBox(Vec3(60e-3, 60e-3, 10e-3)));
  return part;
}
const Vec3 kBlock_m(20e-3, 20e-3, 20e-3);
const PartMesh& block() {
  static const PartMesh part = dynamics::makePart(makeBox(kBlock_m));
  return part;
}

struct Press {
  double worst = 0;  ///< greatest |force - K depth| / force, for forces of 2 N and more
  double most_N = 0;
};

// The plate's top is z = 0. The block starts 1 mm above the plate and is pressed down at 2 mm/s.
Press pressBlock(const RigSettings& settings, double stiffness_N_per_m3, double speed_m_s) {
  HapticRig rig(settings);
  rig.world().add(plate(), Pose::translation(Vec3(0, 0, -5e-3)), true);
  const double gap_m = 1e-3, start_m = kBlock_m.z() / 2 + gap_m;
  rig.take(rig.world().add(block(), Pose::translation(Vec3(0, 0, start_m))));
  const bool is_compliant = settings.scene.mode == Mode::Penalty;
  const double k = rig.gains().k_N_per_m;
  const double contact = stiffness_N_per_m3 * kBlock_m.x() * kBlock_m.y();
  const double series = is_compliant ? k * contact / (k + contact) : k;
  Press result;
  const int ticks = static_cast<int>(8e-3 / speed_m_s / HapticRig::kStep_s);
  double depth_m = 0;
  for (int i = 0; i < ticks; ++i) {
    const double z = start_m - speed_m_s * HapticRig::kStep_s * i;
    rig.lead(Vec3(0, 0, z), Vec3::Zero(), {Vec3::Zero(), Vec3(0, 0, -speed_m_s)});
    // The force of this tick was computed from the handle's pose before this millisecond.
    const double force_N = rig.felt().f.z();
    if (force_N > 2) {
      result.worst = std::max(result.worst, std::abs(force_N - series * depth_m) / force_N);
      result.most_N = std::max(result.most_N, force_N);
    }
    depth_m = kBlock_m.z() / 2 - rig.trueGrasp().p.z();
  }
  return result;
}

}  // namespace

void pressRow(const HapticOptions& options, Table& table) {
  const double speed_m_s = options.is_short ? 5e-3 : 2e-3;
  for (const RigDevice& device : devices())
    for (const auto& [mode, k, name] :
         {std::tuple{Mode::Constraint, 1e12, "rigid"}, std::tuple{Mode::Penalty, 1e12, "penalty, 1e12 N/m3"},
          std::tuple{Mode::Penalty, 1e8, "penalty, 1e8 N/m3"}}) {
      const Press press = pressBlock(rigFor(device, mode, k), k, speed_m_s);
      table.add({text("slow press on a flat wall, %s, %s arm", name, device.name),
                 text("%.0f mm/s", speed_m_s * 1e3),
                 {judged(device, "force error", press.worst, 0.01, 100, "%"),
                  reported("force up to", press.most_N, 1, "N")},
                 ""});
    }
}

namespace {

constexpr double kProbe_m = 5e-3;   // radius of the ball in hand
constexpr double kRound_m = 20e-3;  // radius of cylinder and sphere
const PartMesh& probe() {
  static const PartMesh part = dynamics::makePart(makeSphere(kProbe_m, 5));
  return part;
}

struct Surface {
  const char* name;
  const PartMesh& part;
  bool is_round;
};

std::vector<Surface> surfaces() {
  static const PartMesh flat = dynamics::makePart(makeBox(Vec3(60e-3, 60e-3, 10e-3)));
  // The cylinder is along y, so that the ball slides around it. The cylinder's flats are 20 mm (1 - cos(pi /
  // 512)) = 0.4 um inside the circle.
  static const PartMesh cylinder = dynamics::makePart(transformed(
      makeCylinder(kRound_m, 60e-3, 512), Pose(rotationFromVector(Vec3(M_PI / 2, 0, 0)), Vec3::Zero())));
  static const PartMesh sphere = dynamics::makePart(makeSphere(kRound_m, 6));
  return {{"plane", flat, false}, {"cylinder", cylinder, true}, {"sphere", sphere, true}};
}

struct Slide {
  double worst = 0;  ///< |change of force from tick to tick| / force
  double median = 0;
  double force_N = 0;
};

// The hand moves the ball along x, 3 mm too deep, at 20 mm/s: on round surfaces by 0.4 rad to each side. The
// surface is rotated by 0.1 rad about z and is not aligned with the grid.
Slide slideOver(const RigSettings& settings, const Surface& surface, double length_m) {
  HapticRig rig(settings);
  const double drop_m = surface.is_round ? kRound_m : 5e-3;
  rig.world().add(surface.part, Pose(rotationFromVector(Vec3(0, 0, 0.1)), Vec3(0.11e-3, 0.07e-3, -drop_m)),
                  true);
  const double start_m = kProbe_m + 0.5e-3, press_m = 3e-3, speed_m_s = 20e-3;
  const auto placeAt = [&](double along_m, double height_m) {
    if (!surface.is_round) return Vec3(along_m, 0, height_m);
    const double r = kRound_m + height_m, a = along_m / kRound_m;
    return Vec3(r * std::sin(a), 0, r * std::cos(a) - kRound_m);
  };
  const Vec3 begin = placeAt(-length_m / 2, start_m);
  rig.take(rig.world().add(probe(), Pose::translation(begin)));
  const int down = 600, run_up = 300, ticks = static_cast<int>(length_m / speed_m_s / HapticRig::kStep_s);
  Slide result;
  std::vector<double> jumps;
  Vec3 before_N = Vec3::Zero(), place = begin;
  for (int i = 0; i < down + ticks; ++i) {
    const double height_m = start_m - (press_m + 0.5e-3) * device::minimumJerk(static_cast<double>(i) / down);
    const double along_m = -length_m / 2 + speed_m_s * HapticRig::kStep_s * std::max(0, i - down);
    const Vec3 next = placeAt(along_m, height_m);
    rig.lead(next, Vec3::Zero(), {Vec3::Zero(), (next - place) / HapticRig::kStep_s});
    place = next;
    const Vec3 force_N = rig.felt().f;
    if (i > down + run_up) {
      jumps.push_back((force_N - before_N).norm() / force_N.norm());
      result.force_N = force_N.norm();
    }
    before_N = force_N;
  }
  std::sort(jumps.begin(), jumps.end());
  result.worst = jumps.back();
  result.median = jumps[jumps.size() / 2];
  return result;
}

}  // namespace

void slideRow(const HapticOptions& options, Table& table) {
  const double length_m = options.is_short ? 10e-3 : 20e-3;
  for (const RigDevice& device : devices())
    for (const Surface& surface : surfaces())
      for (const auto& [mode, spacing_m] :
           {std::pair{Mode::Constraint, 0.5e-3}, std::pair{Mode::Penalty, 0.5e-3},
            std::pair{Mode::Penalty, 0.25e-3}}) {
        const Slide slide = slideOver(rigFor(device, mode, 1e12, spacing_m), surface, length_m);
        table.add({text("sliding over a %s, %s arm", surface.name, device.name),
                   text("%s, points %.2f mm apart", dynamics::nameOf(mode), 1e3 * spacing_m),
                   {judged(device, "worst jump a tick", slide.worst, 0.005, 100, "% of the force"),
                    reported("median", slide.median, 100, "%"), reported("force", slide.force_N, 1, "N")},
                   ""});
      }
}

namespace {

// Moves a part of 63 g by 0.2 m in a second, like a person, and rotates it by 0.5 rad.
double freeMotion_N(const RigSettings& settings, double& speed_m_s) {
  HapticRig rig(settings);
  rig.take(rig.world().add(block(), Pose{}));
  const double mass_kg = block().frame.mass_kg, duration_s = 1;
  const Vec3 way_m(0.12, 0.14, 0.08), turn_rad(0.3, 0, 0.4);
  const Vec3 weight_N(0, 0, settings.has_gravity ? -9.81 * mass_kg : 0);
  double worst_N = 0;
  Vec3 v_before = Vec3::Zero(), a = Vec3::Zero();
  for (int i = 0; i < 1500; ++i) {
    const double s = i * HapticRig::kStep_s / duration_s;
    rig.lead(device::minimumJerk(s) * way_m, device::minimumJerk(s) * turn_rad,
             {device::minimumJerkRate(s) / duration_s * turn_rad,
              device::minimumJerkRate(s) / duration_s * way_m});
    // The hand should feel only the part's weight and inertia: the force of the device on the hand is m (g -
    // a) of the last step.
    if (i > 300) worst_N = std::max(worst_N, (rig.felt().f - (weight_N - mass_kg * a)).norm());
    const Vec3 v = rig.part().V_W.v;
    a = (v - v_before) / HapticRig::kStep_s;
    v_before = v;
    speed_m_s = std::max(speed_m_s, v.norm());
  }
  return worst_N;
}

}  // namespace

void freeMotionRow(const HapticOptions&, Table& table) {
  for (const RigDevice& device : devices()) {
    RigSettings settings = rigFor(device, Mode::Constraint);
    settings.has_gravity = true;
    double speed_m_s = 0;
    const double force_N = freeMotion_N(settings, speed_m_s);
    table.add({text("free motion, %s arm", device.name),
               text("block of %.0f g, 0.2 m in 1 s", 1e3 * block().frame.mass_kg),
               {judged(device, "felt beyond the part's weight and inertia", force_N, 0.05, 1, "N"),
                reported("speed up to", speed_m_s, 1, "m/s")},
               ""});
  }
}

}  // namespace vps::bench
