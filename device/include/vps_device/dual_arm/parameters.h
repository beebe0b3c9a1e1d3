// SPDX-License-Identifier: BSD-3-Clause
// The parameters of the dual-arm device. Values and sources are in data/dual_arm.toml, which is built in; a
// user's file overrides single values.
#pragma once

#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_device/export.h"

namespace vps::device {

/// Defaults are the values of data/dual_arm.toml. Copies never allocate.
struct VPS_DEVICE_API DualArmParameters {
  DualArmParameters();

  // Geometry.
  Vec3 workspace_m = Vec3::Zero();     ///< box of the handle's origin, centred at D's origin
  double handle_m = 0;                 ///< L, distance between the gimbal centres
  Vec3 p_EH = Vec3::Zero();            ///< vector from the handle's midpoint to its centre of mass H, in E
  double base_m = 0;                   ///< distance from D's origin to each base, along y
  Vec3 right_shift_m = Vec3::Zero();   ///< shift of the right base from its nominal pose, in its frame
  Vec3 right_turn_rad = Vec3::Zero();  ///< rotation vector of the right base from its nominal pose
  double reach_min_m = 0, reach_max_m = 0;  ///< range of d3
  double plate_max_rad = 0;                 ///< limit of |t1| and |t2|
  double q2_max_rad = 0, q3_max_rad = 0;    ///< limits of |q2| and |q3|
  double link_radius_m = 0;                 ///< radius of a sliding link, for `armClearance_m`
  // Inertia and friction.
  double handle_kg = 0;
  Vec3 handle_kgm2 = Vec3::Zero();  ///< moments of inertia about H, along E's axes
  double plate_kgm2 = 0;            ///< inertia of plate, link and balance weight about each axis
  double link_kg = 0;               ///< mass of a sliding link with its tendon drive
  double rotor_kgm2 = 0;            ///< inertia of the handle's motor with its gear
  double motor_share = 0;           ///< share of plate_kgm2, link_kg and rotor_kgm2 on the motors' side
  double plate_damping_Nms = 0, link_damping_Ns_per_m = 0, rotor_damping_Nms = 0;
  double plate_coulomb_Nm = 0, link_coulomb_N = 0, rotor_coulomb_Nm = 0;
  // Structure: elasticity between the motors, where the encoders are, and the handle.
  double plate_Nm_per_rad = 0, link_N_per_m = 0, rotor_Nm_per_rad = 0;
  double gimbal_N_per_m = 0;       ///< stiffness of gimbal and handle on each side, in every direction
  double structure_damping_s = 0;  ///< damping over stiffness
  // Joint stops.
  double plate_stop_Nm_per_rad = 0, link_stop_N_per_m = 0, gimbal_stop_Nm_per_rad = 0;
  double stop_damping_s = 0;  ///< damping over stiffness
  // Encoders, on the motors' side: one step.
  double plate_step_rad = 0, link_step_m = 0, rotor_step_rad = 0;
  double noise_steps = 0;  ///< standard deviation before rounding, in steps
  /// Error of a reading, from which gains are derived; if the handle is tilted, the error of an angle may be
  /// greater.
  double resolution_m = 0, resolution_rad = 0;
  // Motors, continuous and peak.
  double plate_torque_Nm = 0, plate_peak_Nm = 0;
  double link_force_N = 0, link_peak_N = 0;
  double rotor_torque_Nm = 0, rotor_peak_Nm = 0;
  double thermal_s = 0;                      ///< time constant of a winding
  double force_N = 0, force_peak_N = 0;      ///< continuous and peak force on the handle
  double torque_Nm = 0, torque_peak_Nm = 0;  ///< continuous and peak torque on the handle
  // Protection.
  double speed_m_s = 0,
         turn_rad_s = 0;  ///< speeds of the handle above which its motion is a fault (SharpMotion)
  double jump_m = 0;      ///< greatest step of a gimbal centre between two readings
  double apart_m = 0;     ///< greatest difference between the gimbal centres' distance and L
  double watchdog_s = 0;  ///< longest time without a command or a new reading
  // Timing.
  double delay_ticks = 0;        ///< whole ticks between a wrench's reading and its effect, 0 to 8
  double velocity_filter_s = 0;  ///< time constant of the velocity estimate

 private:
  friend struct DualArmFileReader;
  struct Unset {};
  explicit DualArmParameters(Unset) {}
};

/// The source of a parameter.
struct ParameterNote {
  std::string section, key;
  std::vector<double> value;
  bool is_sourced = false;
  std::string words;  ///< the place in the paper, or the reason; empty for a plain number in a user's file
};

struct DualArmFile {
  DualArmParameters parameters;
  std::vector<ParameterNote> notes;  ///< one for each parameter, in the built-in file's order
};

/// The text of data/dual_arm.toml, embedded at build time.
VPS_DEVICE_API extern const char* const kDualArmToml;

/// data/dual_arm.toml, as built in. Allocates.
VPS_DEVICE_API const DualArmFile& builtInDualArm();

/// Reads a file whose values override the built-in ones. Throws LoadError with file, line, key, what was
/// found and what is expected.
VPS_DEVICE_API DualArmFile loadDualArm(const std::string& file);

/// As loadDualArm(), from text; `name` is the file's name in messages.
VPS_DEVICE_API DualArmFile parseDualArm(const std::string& text, const std::string& name);

}  // namespace vps::device
