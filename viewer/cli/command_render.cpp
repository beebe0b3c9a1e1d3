// SPDX-License-Identifier: BSD-3-Clause
// vps render: the haptic rendering node: physics, contact and procedure, with the hand in another process.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "run_report.h"
#include "scene_arguments.h"
#include "session_option.h"
#include "terminal.h"
#include "vps_scenes/network/nodes.h"

namespace vps::viewer::inline v0 {

namespace {

struct RenderArguments {
  SceneArguments scene;
  std::string session = kDefaultSession;
  scenes::SessionNetwork network;
  std::string out = "out";
  std::string json;
  std::string record;  ///< file to record the run in; empty: none
  bool has_pictures = true;
  bool stops_at_failure = false;
  bool sheds_load = true;
};

int runRender(const RenderArguments& given) {
  const std::string& file = given.scene.scene;
  OutputFolder out(given.out);
  OutputFile json(given.json, {file});
  ProgressBar bar;
  requireNotRead(given.record, {file});
  scenes::Scene scene = sceneFrom(file, given.scene.fidelity, {given.json, given.record});

  scenes::RenderOptions options;
  const std::optional<VoxMapCache> cache = cacheFrom(given.scene.cache);
  setModelOptions(options, bar, cache, given.scene.models_everything);
  options.session = given.session;
  options.network = given.network;
  options.keep_going = !given.stops_at_failure;
  options.stop = &stopRequested();
  options.degrades = given.sheds_load;
  options.say = [&bar](const std::string& words) {
    bar.clear();
    say(words);
  };
  const scenes::AssembleResult result = scenes::renderNode(scene, options, given.record);
  throwIfStopped();

  const std::vector<std::string> notes = fillFolder(
      out, scene, result,
      {"vps render " + file + " --session " + given.session + " --out " + given.out, given.has_pictures});
  out.commit();
  json.write(toJson(result));
  bar.clear();
  printOutcome(result, notes, given.record, given.out);
  return statusOf(result.verdict);
}

}  // namespace

void addRender(CommandLine& line) {
  const auto given = std::make_shared<RenderArguments>();
  CLI::App& command = addCommand(
      line, "render",
      "runs the procedure as vps assemble --real-time does, with the device in another process (vps device)",
      "vps render scenes/bearing_block/scene.toml --session demo", [given] { return runRender(*given); });
  addSceneOptions(command, given->scene);
  addSessionOption(command, given->session);
  addNetworkOption(command, given->network);
  command.add_option("--out", given->out, "folder for the results")->capture_default_str()->type_name("DIR");
  command.add_flag("!--no-pictures", given->has_pictures, "write only tables, plots and data");
  command.add_flag("--stop-at-failure", given->stops_at_failure, "end at the first step that fails");
  command.add_flag("!--no-load-shedding", given->sheds_load,
                   "keep the full fidelity when the rate cannot be held, and count missed periods");
  command
      .add_option("--record", given->record,
                  "record the run with its scene and meshes (MCAP), for vps replay")
      ->type_name("FILE");
  addJsonOption(command, given->json);
}

}  // namespace vps::viewer::inline v0
