// SPDX-License-Identifier: BSD-3-Clause
#include "record/run_record.h"

#include <charconv>

#include "record/scene_archive.h"
#include "vps/version.h"
#include "vps_scenes/scene/settings_fields.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kRingEntries = 1 << 15;  // size of the ring. assumed: 8 s of a real-time run at 1 kHz

std::string inFull(double x) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr};
}
std::string inFull(int x) {
  return std::to_string(x);
}
std::string inFull(const std::optional<double>& x) {
  return x ? inFull(*x) : "";
}
template <class Enum>
requires std::is_enum_v<Enum> std::string inFull(Enum x) {
  return toText(x);
}

/// Adds "<prefix><key>" for each setting of a table.
template <class Struct, class Rows>
void describe(const Struct& settings, const Rows& rows, const std::string& prefix,
              std::map<std::string, std::string>& about) {
  forEachRow(rows,
             [&](const auto& row) { about[prefix + siKey(row)] = inFull(std::invoke(row.get, settings)); });
}

/// Information about the run for people and tools; a replay takes all settings from the scene.
/// @param scene  has the coupling gains that the run used
std::map<std::string, std::string> aboutRun(const Scene& scene, const std::string& scene_bytes,
                                            const AssembleOptions& options) {
  std::map<std::string, std::string> about = {
      {"program", "vps assemble"},
      {"version", programVersion()},
      {"scene", scene.name},
      {"scene_hash", contentHash(scene_bytes)},
      {"seed", std::to_string(scene.hand.seed)},
      {"real_time", options.is_real_time ? "1" : "0"},
      {"keeps_going", options.keep_going ? "1" : "0"},
      {"models_everything", options.models_everything ? "1" : "0"},
  };
  describe(scene.fidelity, kFidelityFields, "fidelity.", about);
  describe(scene.coupling, kCouplingFields, "chosen.", about);
  if (!scene.fidelity_choice.empty()) about["chosen.fidelity"] = scene.fidelity_choice;
  for (const ScenePart& part : scene.parts)
    about["mesh_hash." + part.part.name] = contentHash(part.part.mesh);
  return about;
}

device::RecordingHead headOf(const Scene& scene, const device::Device& device,
                             const device::LoopSettings& settings, const AssembleOptions& options) {
  const CouplingGains& gains = settings.gains;
  Scene chosen = scene;
  chosen.coupling = {gains.k_N_per_m,     gains.b_Ns_per_m,  gains.k_Nm_per_rad,
                     gains.b_Nms_per_rad, gains.max_force_N, gains.max_torque_Nm};
  device::RecordingHead head;
  head.device = device.name();
  head.limits = device.limits();
  head.attachments = {{kSceneAttachment, "application/octet-stream", sceneToBytes(chosen)}};
  head.about = aboutRun(chosen, head.attachments[0].data, options);
  if (settings.physics_limit_s > 0) head.about[kPhysicsLimit] = inFull(settings.physics_limit_s);
  return head;
}

}  // namespace

RunRecord::RunRecord(const std::string& file, const Scene& scene, const device::Device& device,
                     const device::LoopSettings& settings, const AssembleOptions& options)
    : recorder_(file, headOf(scene, device, settings, options), kRingEntries),
      warn_(options.warn),
      waits_(!options.is_real_time) {}

RunRecord::~RunRecord() {
  if (is_finished_ || !has_read_ || !warn_) return;
  warn_("the recording is incomplete; what was recorded so far is in " + recorder_.unfinished());
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
  // GCC 12 reports a false overflow for operator+ here.
  std::string words(VPS_VERSION_STRING);
  return words.append(", compiler " __VERSION__ ", Bullet ").append(precision);
}

}  // namespace vps::scenes
