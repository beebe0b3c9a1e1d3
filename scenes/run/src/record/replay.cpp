// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/replay.h"

#include <charconv>

#include "procedure/assembly_run.h"
#include "record/run_record.h"
#include "record/scene_archive.h"
#include "vps/errors.h"

namespace vps::scenes {

namespace {

std::string about(const device::RecordedRun& run, const std::string& key) {
  const auto found = run.head.about.find(key);
  return found != run.head.about.end() ? found->second : "";
}

}  // namespace

AssembleResult assembleAndRecord(Scene& scene, const std::string& file, const AssembleOptions& options) {
  requireSteps(scene);
  if (options.has_local_contact)
    throw LoadError(file, "",
                    "a run with local contact cannot be replayed bit for bit; record it without "
                    "--local-contact");
  const std::unique_ptr<Hand> hand = makeHand(scene, options);
  const device::LoopSettings settings = loopSettings(scene, hand->device());
  RunRecord record(file, scene, hand->device(), settings, options);
  AssembleResult result = runProcedure(scene, *hand, &record, settings, options);
  if (options.stop == nullptr || !options.stop->load()) record.finish();
  return result;
}

Scene recordedScene(const device::RecordedRun& run) {
  const device::McapAttachment* scene = run.attachment(kSceneAttachment);
  if (scene == nullptr)
    throw LoadError(
        run.file, "",
        "holds no scene" + (run.damage.empty()
                                ? std::string(", only the motion of a device; --csv shows this motion")
                                : ": " + run.damage));
  return sceneFromBytes(scene->data, run.file);
}

ReplayResult replay(const device::RecordedRun& run, const ReplayOptions& options) {
  ReplayResult replayed;
  replayed.scene = recordedScene(run);
  if (replayed.scene.steps.empty()) throw LoadError(run.file, "", "holds a scene without a step");
  if (const std::string version = about(run, "version"); version != programVersion())
    replayed.other_version = "was recorded by vps " + version + "; this is vps " + programVersion();

  AssembleOptions assembling;
  static_cast<ModelOptions&>(assembling) = options;
  assembling.stop = options.stop;
  assembling.tap = options.tap;
  assembling.on_device_event = options.on_device_event;
  if (options.on_scene) options.on_scene(replayed.scene);
  assembling.models_everything = about(run, "models_everything") == "1";
  assembling.keep_going = about(run, "keeps_going") != "0";
  device::Recording recording(run);
  device::ReplayCheck check(run);
  const std::unique_ptr<Hand> hand = recordedHand(recording);
  device::LoopSettings settings = loopSettings(replayed.scene, hand->device());
  const std::string limit_s = about(run, kPhysicsLimit);
  std::from_chars(limit_s.data(), limit_s.data() + limit_s.size(), settings.physics_limit_s);
  replayed.result = runProcedure(replayed.scene, *hand, &check, settings, assembling);
  replayed.departure = check.departure();
  replayed.equal = check.equal();
  const bool ended_early = replayed.departure.empty() && run.damage.empty() && check.left() > 0;
  if (ended_early && (options.stop == nullptr || !options.stop->load()))
    replayed.departure =
        "at its end: the recording continues for " + std::to_string(check.left()) + " entries";
  return replayed;
}

}  // namespace vps::scenes
