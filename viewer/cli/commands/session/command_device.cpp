// SPDX-License-Identifier: BSD-3-Clause
// vps device --characterise: Table 1 and figure 5 of Tripicchio et al. (see README.md) for the simulated dual
// arm. vps device --list: the kinds of device. vps device --session NAME: the process of the device in a run
// that vps render computes.
#include <cstdio>
#include <memory>
#include <optional>

#include "input/session_options.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_device/dual_arm/character.h"
#include "vps_scenes/network/nodes.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {

namespace {

struct DeviceArguments {
  bool is_characterise = false;
  bool is_list = false;
  std::string parameters;  ///< file of parameters that replace built-in ones; empty: none
  std::string plot =
      "figure5";  ///< figure 5 is written to plot + ".png" and plot + ".svg"; empty: not written
  std::string json;
  std::string session;  ///< empty: none
  scenes::SessionNetwork network;
  bool rearms = false, stays = false;
  std::string record;  ///< file for the recording of the run; empty: none
};

constexpr const char* kNone = "";

std::string range(double least, double greatest, int digits, double unit = 1) {
  return fixed(least * unit, digits) + " - " + fixed(greatest * unit, digits);
}

std::string range(const device::Extent& extent, int digits, double unit = 1) {
  return range(extent.least, extent.greatest, digits, unit);
}

/// Continuous and peak values in the format of Table 1.
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
  table.add({"workspace, x y z, nominal", "mm", box(c.workspace_m, 1), "400 x 600 x 400"});
  table.add({"  reachable with the handle straight", "mm", box(c.workspace_m, c.straight_scale), kNone});
  table.add({"  reachable with every tilt up to 45 deg", "mm", box(c.workspace_m, c.tilted_scale), kNone});
  table.add({"solid angle of the gimbal's range", "sr", fixed(c.gimbal_sr, 1), "about 12 (1)"});
  table.add(
      {"  at the centre, without collision of the arms", "sr", fixed(c.centre_solid_angle_sr, 1), kNone});
  table.add({"  over the workspace", "sr", range(c.solid_angle_sr, 1), kNone});
}

void addStrength(Table& table, const device::DualArmCharacter& c) {
  const device::DeviceLimits& limits = c.limits_1kHz;
  const std::string given_N = duty(limits.continuous_force_N, limits.peak_force_N);
  const std::string given_Nm = duty(limits.continuous_torque_Nm, limits.peak_torque_Nm);
  table.add({"greatest force on the handle", "N", given_N, "12.5 -> 30"});
  table.add(
      {"  motors, worst place and direction, straight", "N", least(c.straight_force_N), "12.5 -> 30 (2)"});
  table.add({"  the same with tilts up to 45 deg", "N", least(c.force_N), kNone});
  table.add({"  motors, typical", "N", typical(c.any_force_N), kNone});
  table.add({"upward force, worst place: left arm alone", "N", least(c.left_up_N), "5 (3)"});
  table.add({"  right arm alone", "N", least(c.right_up_N), "5 (3)"});
  table.add({"  both, handle carried", "N", least(c.up_N), "12"});
  table.add({"  both, the hand bears the couple", "N", least(c.sum_up_N), kNone});
  table.add({"greatest torque on the handle", "N m", given_Nm, "1 -> 2.5"});
  table.add(
      {"  motors, worst place and direction, straight", "N m", least(c.straight_torque_Nm, 2), "1 -> 2.5"});
  table.add({"  the same with tilts up to 45 deg", "N m", least(c.torque_Nm, 2), "1 -> 2.5 (4)"});
  table.add({"  motors, typical", "N m", typical(c.any_torque_Nm, 2), "1.8 -> 10 (5)"});
}

void addReading(Table& table, const device::DualArmCharacter& c) {
  const auto um = [](const device::Extent& e) { return fixed(1e6 * e.greatest, 0); };
  const auto rad = [](const device::Extent& e) { return fixed(e.greatest, 4); };
  table.add({"resolution, worst case: tilts up to 45 deg", "um", um(c.resolution_m), "100 (7)"});
  table.add({"  every direction in the gimbal's range", "um", um(c.far_resolution_m), kNone});
  table.add({"angular resolution, worst case: up to 45 deg", "rad", rad(c.resolution_rad), kNone});
  table.add({"  every direction in the gimbal's range", "rad", rad(c.far_resolution_rad), "0.005 (7)"});
  table.add({"dry friction, straight", "N", range(c.friction_N, 2), kNone});
  const std::string ratio = duty(c.force_ratio, c.peak_force_ratio, 0);
  table.add({"greatest force / typical friction", "", ratio, "nearly 100 (8)"});
}

void addMechanics(Table& table, const device::DualArmCharacter& c) {
  table.add({"stiffness, direction of the handle held", "N/mm", range(c.held_stiffness_N_per_m, 1, 1e-3),
             "14 - 18 (6)"});
  table.add({"  handle free to turn", "N/mm", range(c.free_stiffness_N_per_m, 1, 1e-3), kNone});
  addReading(table, c);
  table.add({"uniformity of motor torque over places: one arm", "", fixed(c.arm_isotropy, 2), kNone});
  table.add({"  both", "", fixed(c.pair_isotropy, 2), "better than one"});
  table.add({"isotropy over directions: one arm", "", range(c.arm_ellipsoid_isotropy, 2), kNone});
  table.add({"  both", "", range(c.ellipsoid_isotropy, 2), kNone});
  table.add({"manipulability of an arm, sqrt det(J J^T)", "m^2", range(c.arm_manipulability_m2, 2), kNone});
  table.add({"geometric mean force of both", "N", range(c.pair_force_mean_N, 1), kNone});
  table.add({"reflected mass", "kg", range(c.mass_kg, 2), kNone});
  table.add({"reflected inertia", "g m^2", range(c.inertia_kgm2, 2, 1e3), kNone});
  table.add(
      {"least clearance of the arms: straight", "mm", fixed(1e3 * c.straight_clearance_m, 0), "never meet"});
  table.add({"  tilts up to 45 deg", "mm", fixed(1e3 * c.tilted_clearance_m, 0), kNone});
  table.add(
      {"  every direction in the gimbal's range", "mm", fixed(1e3 * c.far_clearance_m, 0), "never meet (1)"});
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
Continuous -> peak. All figures are computed from the model. Parameters that the paper does not give are
assumed; data/dual_arm.toml states the reason for each. Differences between this device and the paper by Tripicchio et al.:
(1) The paper gives a solid angle in rad. The range of the gimbal was chosen for 12 sr. The arms would collide
    near the reversed direction of the handle, which reduces the solid angle at the centre; the clearance is
    negative there.
(2) In its worst direction a force loads most of the motors at once, in addition to the handle's weight. The
    limit on the handle is then not quite reached, and the wrench is scaled down as a whole.
(3) A single arm is weakest where it is longest. The paper's 5 N are for an arm in a workspace of its own; an
    arm with the same motors gives more at the far side of this workspace. Without a couple, the pair gives
    twice the force of its weaker arm.
(4) The paper does not state which directions its worst case covers. Near a singularity of the gimbal the arms
    need 1 / cos q2 times the torque about the handle. With the handle straight, the worst case is the paper's.
(5) From continuous to peak the paper's other figures grow 2.4 to 2.5 times, as motors do. Its typical torque
    grows 5.6 times, which no motor that gives the other figures can do. The device is limited to the
    worst-case figures.
(6) The paper does not state the load case. If the hand holds the handle's direction, the stiffnesses of both
    arms add; a handle that can turn gives way at its softer end.
(7) Every encoder is off by half a step in the worst combination; their noise adds a fifth. The encoders are
    assumed, and finer than the paper's figures require.
(8) A force below dry friction cannot be felt, so friction is taken as the force resolution. Friction is
    assumed; with a fifth less of it the peak ratio would be the paper's two decades.
)";

void print(const device::DualArmCharacter& c) {
  Table table({"<dual arm", "<unit", "this device", "Tripicchio et al."});
  addWorkspace(table, c);
  addStrength(table, c);
  addMechanics(table, c);
  addCoupling(table, "1 kHz", c.limits_1kHz, c.gains_1kHz);
  addCoupling(table, "4 kHz", c.limits_4kHz, c.gains_4kHz);
  std::fputs(table.text().c_str(), stdout);
  std::fputs(kNotes, stdout);
}

int listKinds() {
  Table table({"<kind", "<description", "<available"});
  for (const device::DeviceKind& kind : device::deviceKinds()) {
    const std::string missing = kind.missing();
    const std::string remedy = missing.empty() ? "yes" : "no: " + missing + "; " + std::string(kind.remedy);
    table.add({std::string(kind.name), std::string(kind.description), remedy});
  }
  std::fputs(table.text().c_str(), stdout);
  return kGood;
}

int runNode(const DeviceArguments& given) {
  limitStacks();
  scenes::DeviceNodeOptions options;
  options.session = given.session;
  options.network = given.network;
  options.stop = &stopRequested();
  options.say = [](const std::string& words) { say(words); };
  options.rearms = given.rearms;
  options.stays = given.stays;
  std::optional<scenes::SessionRecording> recording;
  if (!given.record.empty()) {
    options.before_hello = [&] {
      if (recording) return;  // the recording ended when an earlier connection was lost
      recording.emplace(recordingOptions(given.session, given.network, given.record));
      requireAsked(*recording, "--record");
    };
  }
  const scenes::DeviceNodeResult result = scenes::deviceNode(options);
  std::printf("%llu ticks, %llu periods missed, %llu safety faults, %llu messages refused\n",
              static_cast<unsigned long long>(result.ticks), static_cast<unsigned long long>(result.missed),
              static_cast<unsigned long long>(result.faults),
              static_cast<unsigned long long>(result.refused));
  return recording ? finishRecording(*recording, given.record) : kGood;
}

int runDevice(const DeviceArguments& given) {
  if (given.is_list) return listKinds();
  if (!given.session.empty()) return runNode(given);
  if (!given.is_characterise)
    throw LoadError("", "",
                    "give --session NAME to join a run of vps render, --list for the kinds of device, or "
                    "--characterise for the dual arm's figures");
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

}  // namespace

std::function<int()> addDevice(CLI::App& command) {
  const auto given = std::make_shared<DeviceArguments>();
  CLI::Option* characterise =
      command.add_flag("--characterise", given->is_characterise,
                       "compute Table 1 and figure 5 of the paper by Tripicchio, Avizzano and "
                       "Bergamasco for the dual arm");
  command.add_flag("--list", given->is_list, "print the device kinds that a scene may name in [device] kind")
      ->excludes(characterise);
  command.add_option("--parameters", given->parameters, "parameters that replace the built-in ones")
      ->type_name("FILE.toml")
      ->needs(characterise);
  command.add_option("--plot", given->plot, "figure 5 as .png and .svg; '' for none")
      ->capture_default_str()
      ->type_name("NAME")
      ->needs(characterise);
  CLI::Option* session =
      addSessionOption(command, given->session)->excludes(characterise)->excludes("--list");
  addNetworkOption(command, given->network)->needs(session);
  command
      .add_flag(
          "--auto-rearm", given->rearms,
          "re-arm the device automatically when a lost render node is back; simulated devices always do this")
      ->needs(session);
  addRecordOption(command, given->record)->needs(session)->excludes("--list");
  command.add_flag("--stay", given->stays, "when a session has ended, wait for the next session")
      ->needs(session);
  addJsonOption(command, given->json);
  command.get_option("--json")->needs(characterise);
  return [given] { return runDevice(*given); };
}

}  // namespace vps::viewer
