// SPDX-License-Identifier: BSD-3-Clause
#include "record/run_record.h"

#include <charconv>

#include "record/scene_archive.h"
#include "vps/version.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kRingEntries = 1 << 15;  // assumed: 8 s of a run by the clock at 1 kHz

std::string exact(double x) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr};
}

/// What a person and a tool want to know; the replay takes it from the scene.
std::map<std::string, std::string> aboutRun(const Scene& scene, const CouplingGains& gains,
                                            const std::string& scene_bytes, const AssembleOptions& options) {
  const Fidelity& f = scene.fidelity;
  std::map<std::string, std::string> about = {
      {"program", "vps assemble"},
      {"version", programVersion()},
      {"scene", scene.name},
      {"scene_hash", contentHash(scene_bytes)},
      {"seed", std::to_string(scene.hand.seed)},
      {"real_time", options.is_real_time ? "1" : "0"},
      {"keeps_going", options.keep_going ? "1" : "0"},
      {"models_everything", options.models_everything ? "1" : "0"},
      {"fidelity.voxel_m", exact(f.voxel_m)},
      {"fidelity.spacing_m", exact(f.spacing_m)},
      {"fidelity.sides", toText(f.sides)},
      {"fidelity.gradient", toText(f.gradient)},
      {"fidelity.contact", toText(scene.contact)},
      {"fidelity.contact_limit", std::to_string(f.contact_limit)},
      {"fidelity.haptic_rate_hz", exact(f.haptic_rate_hz)},
      {"fidelity.physics_rate_hz", exact(f.physics_rate_hz)},
      {"fidelity.solver_iterations", std::to_string(f.solver_iterations)},
      {"chosen.k_N_per_m", exact(gains.k_N_per_m)},
      {"chosen.b_Ns_per_m", exact(gains.b_Ns_per_m)},
      {"chosen.k_Nm_per_rad", exact(gains.k_Nm_per_rad)},
      {"chosen.b_Nms_per_rad", exact(gains.b_Nms_per_rad)},
      {"chosen.max_force_N", exact(gains.max_force_N)},
      {"chosen.max_torque_Nm", exact(gains.max_torque_Nm)},
  };
  if (!scene.fidelity_choice.empty()) about["chosen.fidelity"] = scene.fidelity_choice;
  for (const ScenePart& part : scene.parts)
    about["mesh_hash." + part.part.name] = contentHash(part.part.mesh);
  return about;
}

device::RecordingHead headOf(const Scene& scene, const device::Device& device, const CouplingGains& gains,
                             const AssembleOptions& options) {
  Scene chosen = scene;
  chosen.coupling = {gains.k_N_per_m,     gains.b_Ns_per_m,  gains.k_Nm_per_rad,
                     gains.b_Nms_per_rad, gains.max_force_N, gains.max_torque_Nm};
  device::RecordingHead head;
  head.device = device.name();
  head.limits = device.limits();
  head.attachments = {{kSceneAttachment, "application/octet-stream", sceneToBytes(chosen)}};
  head.about = aboutRun(scene, gains, head.attachments[0].data, options);
  return head;
}

}  // namespace

RunRecord::RunRecord(const std::string& file, const Scene& scene, const device::Device& device,
                     const CouplingGains& gains, const AssembleOptions& options)
    : recorder_(file, headOf(scene, device, gains, options), kRingEntries),
      warn_(options.warn),
      waits_(!options.is_real_time) {}

RunRecord::~RunRecord() {
  if (is_finished_ || !has_read_ || !warn_) return;
  warn_("the recording was not finished; up to here it stands in " + recorder_.unfinished());
}

void RunRecord::add(const device::LogEntry& entry) noexcept {
  has_read_ = has_read_ || std::holds_alternative<device::DeviceSample>(entry);
  if (waits_) recorder_.waitForRoom();
  recorder_.add(entry);
}

void RunRecord::finish() {
  recorder_.finish();
  is_finished_ = true;
}

std::string programVersion() {
#ifdef VPS_BULLET_DOUBLE
  const char* precision = "double";
#else
  const char* precision = "float";
#endif
  return std::string(VPS_VERSION_STRING) + ", compiler " + __VERSION__ + ", Bullet " + precision;
}

}  // namespace vps::scenes
