// SPDX-License-Identifier: BSD-3-Clause
// vps device --characterise: this device's own Table 1 next to the paper's, and its figure 5.
// vps device --list: the kinds of device.
#include <cstdio>
#include <numbers>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "table.h"
#include "terminal.h"
#include "vps/load_error.h"
#include "vps_device/device_kinds.h"
#include "vps_device/dual_arm/character.h"
#include "vps_viewer/device_plot.h"

namespace vps::viewer {

namespace {

constexpr const char* kNone = "";

std::string range(double least, double greatest, int digits, double unit = 1) {
  return fixed(least * unit, digits) + " - " + fixed(greatest * unit, digits);
}

std::string range(const device::Extent& extent, int digits, double unit = 1) {
  return range(extent.least, extent.greatest, digits, unit);
}

/// Continuous and peak, as Table 1 writes them.
std::string duty(double continuous, double peak, int digits = 1) {
  return fixed(continuous, digits) + " -> " + fixed(peak, digits);
}
std::string least(const device::Duty& d, int digits = 1) {
  return duty(d.continuous.least, d.peak.least, digits);
}
std::string typical(const device::Duty& d, int digits = 1) {
  return duty(d.continuous.median, d.peak.median, digits);
}

std::string box(const Vec3& size_m, double scale) {
  const Vec3 mm = 1e3 * scale * size_m;
  return fixed(mm.x(), 0) + " x " + fixed(mm.y(), 0) + " x " + fixed(mm.z(), 0);
}

void addWorkspace(Table& table, const device::DualArmCharacter& c) {
  table.add({"workspace, x y z, as stated", "mm", box(c.workspace_m, 1), "400 x 600 x 400"});
  table.add({"  reached with the handle straight", "mm", box(c.workspace_m, c.straight_scale), kNone});
  table.add({"  reached with every tilt to 45 deg", "mm", box(c.workspace_m, c.tilted_scale), kNone});
  table.add({"solid angle the gimbal leaves", "sr", fixed(c.gimbal_sr, 1), "about 12 (1)"});
  table.add({"  at the centre, arms kept apart", "sr", fixed(c.centre_solid_angle_sr, 1), kNone});
  table.add({"  over the workspace", "sr", range(c.solid_angle_sr, 1), kNone});
}

void addStrength(Table& table, const device::DualArmCharacter& c) {
  const device::DeviceLimits& limits = c.limits_1kHz;
  const std::string given_N = duty(limits.continuous_force_N, limits.peak_force_N);
  const std::string given_Nm = duty(limits.continuous_torque_Nm, limits.peak_torque_Nm);
  table.add({"force given out at most", "N", given_N, "12.5 -> 30"});
  table.add(
      {"  motors, worst place and direction, straight", "N", least(c.straight_force_N), "12.5 -> 30 (2)"});
  table.add({"  the same with tilts to 45 deg", "N", least(c.force_N), kNone});
  table.add({"  motors, typical", "N", typical(c.any_force_N), kNone});
  table.add({"upward, worst place: left arm alone", "N", least(c.left_up_N), "5 (3)"});
  table.add({"  right arm alone", "N", least(c.right_up_N), "5 (3)"});
  table.add({"  both, handle carried", "N", least(c.up_N), "12"});
  table.add({"  both, the hand bears the couple", "N", least(c.sum_up_N), kNone});
  table.add({"torque given out at most", "N m", given_Nm, "1 -> 2.5"});
  table.add(
      {"  motors, worst place and direction, straight", "N m", least(c.straight_torque_Nm, 2), "1 -> 2.5"});
  table.add({"  the same with tilts to 45 deg", "N m", least(c.torque_Nm, 2), "1 -> 2.5 (4)"});
  table.add({"  motors, typical", "N m", typical(c.any_torque_Nm, 2), "1.8 -> 10 (5)"});
}

void addReading(Table& table, const device::DualArmCharacter& c) {
  const auto um = [](const device::Extent& e) { return fixed(1e6 * e.greatest, 0); };
  const auto rad = [](const device::Extent& e) { return fixed(e.greatest, 4); };
  table.add({"resolution, worst: to 45 deg from straight", "um", um(c.resolution_m), "100 (7)"});
  table.add({"  every direction the gimbal leaves", "um", um(c.far_resolution_m), kNone});
  table.add({"angular resolution, worst: to 45 deg", "rad", rad(c.resolution_rad), kNone});
  table.add({"  every direction the gimbal leaves", "rad", rad(c.far_resolution_rad), "0.005 (7)"});
  table.add({"dry friction, straight", "N", range(c.friction_N, 2), kNone});
  const std::string ratio = duty(c.force_ratio, c.peak_force_ratio, 0);
  table.add({"greatest force over typical friction", "", ratio, "nearly 100 (8)"});
}

void addMechanics(Table& table, const device::DualArmCharacter& c) {
  table.add({"stiffness, handle's direction held", "N/mm", range(c.held_stiffness_N_per_m, 1, 1e-3),
             "14 - 18 (6)"});
  table.add({"  handle free to turn", "N/mm", range(c.free_stiffness_N_per_m, 1, 1e-3), kNone});
  addReading(table, c);
  table.add({"evenness of motor torque over places: one arm", "", fixed(c.arm_isotropy, 2), kNone});
  table.add({"  both", "", fixed(c.pair_isotropy, 2), "better than one"});
  table.add({"isotropy over directions: one arm", "", range(c.arm_ellipsoid_isotropy, 2), kNone});
  table.add({"  both", "", range(c.ellipsoid_isotropy, 2), kNone});
  table.add({"manipulability of an arm, sqrt det(J J^T)", "m^2", range(c.arm_manipulability_m2, 2), kNone});
  table.add({"mean force of both, geometric", "N", range(c.pair_force_mean_N, 1), kNone});
  table.add({"reflected mass", "kg", range(c.mass_kg, 2), kNone});
  table.add({"reflected inertia", "g m^2", range(c.inertia_kgm2, 2, 1e3), kNone});
  table.add({"arms apart at least: straight", "mm", fixed(1e3 * c.straight_clearance_m, 0), "never meet"});
  table.add({"  tilts to 45 deg", "mm", fixed(1e3 * c.tilted_clearance_m, 0), kNone});
  table.add(
      {"  every direction the gimbal leaves", "mm", fixed(1e3 * c.far_clearance_m, 0), "never meet (1)"});
}

void addCoupling(Table& table, const char* rate, const device::DeviceLimits& limits,
                 const CouplingGains& gains) {
  const std::string at = std::string(" at ") + rate;
  table.add({"coupling, derived" + at + ": stiffness", "N/mm", fixed(1e-3 * gains.k_N_per_m, 2), kNone});
  table.add({"  damping (the device has " + fixed(limits.damping_Ns_per_m, 1) + ")", "N s/m",
             fixed(gains.b_Ns_per_m, 2), kNone});
  table.add({"  rotational stiffness", "N m/rad", fixed(gains.k_Nm_per_rad, 2), kNone});
  table.add({"  damping (the device has " + fixed(1e3 * limits.damping_Nms_per_rad, 1) + ")", "mN m s/rad",
             fixed(1e3 * gains.b_Nms_per_rad, 2), kNone});
}

constexpr const char* kNotes = R"(
Continuous -> peak. Every figure is computed from the model; parameters the paper does not give are
assumed, and why stands beside each in data/dual_arm.toml. Where this device and the paper differ:
(1) The paper writes rad, of a solid angle. The gimbal leaves 12 sr by the choice of its range. Near
    end for end the arms would meet, which costs what is missing at the centre; there the distance
    is negative.
(2) In its worst direction a force asks most of the motors at once, beside the handle's weight:
    there the limit on the handle is not quite reached, and the wrench is scaled down whole.
(3) An arm alone is weakest where it is longest. The paper's 5 N is for one arm in a workspace of
    its own; at the far side of this one an arm of the same motors gives more. Without a couple the
    pair gives twice its weaker arm.
(4) The paper does not say which directions its worst case covers. A tilt that brings the gimbal
    near its singularity makes the arms take 1 / cos q2 times the torque about the handle; straight,
    the worst case is the paper's.
(5) From continuous to peak the paper's other figures grow 2.4 to 2.5 times, as motors do; its
    typical torque grows 5.6 times, which no motor that gives the rest can follow. What is given out
    is held to the worst-case figures.
(6) The paper does not say how it was loaded. With the hand holding the handle's direction both arms
    add; a handle that may turn gives way at its softer end.
(7) Each encoder half a step off, all in the worst sense; their noise adds a fifth. The encoders are
    assumed, and finer than the paper's figures ask for.
(8) A force below dry friction is not felt: that is taken as the force resolution. Friction is
    assumed; with a fifth less of it the peak would be the paper's two decades.
)";

void print(const device::DualArmCharacter& c) {
  Table table({"<dual arm", "<unit", "this device", "the paper"});
  addWorkspace(table, c);
  addStrength(table, c);
  addMechanics(table, c);
  addCoupling(table, "1 kHz", c.limits_1kHz, c.gains_1kHz);
  addCoupling(table, "4 kHz", c.limits_4kHz, c.gains_4kHz);
  std::fputs(table.text().c_str(), stdout);
  std::fputs(kNotes, stdout);
}

int listKinds() {
  Table table({"<kind", "<what it is", "<available"});
  for (const device::DeviceKind& kind : device::deviceKinds()) {
    const std::string missing = kind.missing();
    const std::string remedy = missing.empty() ? "yes" : "no: " + missing + "; " + std::string(kind.remedy);
    table.add({std::string(kind.name), std::string(kind.description), remedy});
  }
  std::fputs(table.text().c_str(), stdout);
  return kGood;
}

}  // namespace

int runDevice(const DeviceArguments& given) {
  if (given.is_list) return listKinds();
  if (!given.is_characterise)
    throw LoadError(
        "", "",
        "device is not ready yet as a node of its own; ready is: vps device --characterise, the dual "
        "arm's figures beside the paper's");
  const std::vector<std::string> inputs = {given.parameters};
  OutputFile json(given.json, inputs);
  const device::DualArmFile file =
      given.parameters.empty() ? device::builtInDualArm() : device::loadDualArm(given.parameters);
  ProgressBar bar;
  const device::DualArmCharacter character = device::characterise(file.parameters, bar.progress());
  const PlotOutcome plot = given.plot.empty()
                               ? PlotOutcome{true, {}}
                               : plotVerticalForces(device::verticalForces(file.parameters), given.plot);
  json.write(toJson(character, file));
  bar.clear();
  print(character);
  if (!plot) warn("no picture of figure 5: " + plot.failure_reason);
  if (plot && !given.plot.empty())
    std::printf("figure 5: %s.png, %s.svg\n", given.plot.c_str(), given.plot.c_str());
  return kGood;
}

}  // namespace vps::viewer
