// SPDX-License-Identifier: BSD-3-Clause
// vps render: the haptic rendering node, which computes physics, contact and procedure; the device is in
// another process.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "input/scene_arguments.h"
#include "input/session_options.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/network/nodes.h"
#include "vps_scenes/network/request_server.h"

namespace vps::viewer {

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
  std::string requests = "all";
  bool waits = false;  ///< each part is taken only when vps ask take requests it
  bool stays = false;  ///< after a run, waits until vps ask requests the next one
};

constexpr const char* kNoRequests = "none";

/// The server that answers vps ask; null with --requests none.
std::unique_ptr<scenes::RequestServer> requestServerFrom(const RenderArguments& given) {
  if (given.requests == kNoRequests) {
    if (given.waits || given.stays)
      throw LoadError("--requests none", "", "contradicts --on-request and --stay, which wait for requests");
    return nullptr;
  }
  scenes::RequestServerOptions options;
  options.session = given.session;
  options.network = given.network;
  options.rights = given.requests == "who" ? scenes::RequestRights::Look : scenes::RequestRights::All;
  options.waits = given.waits;
  const CacheArguments& cache = given.scene.cache;
  const std::string folder = cache.folder.empty() ? defaultCacheFolder() : cache.folder;
  if (!cache.is_off && !folder.empty()) options.scenes = folder + "/scenes";
  options.stop = &stopRequested();
  options.say = [](const std::string& words) {  // called by another thread than that of the progress bar
    if (isTerminal()) std::fputs("\r\033[K", stderr);
    say(words);
  };
  return std::make_unique<scenes::RequestServer>(options);
}

/// Makes one run and writes its results.
/// @param command  command that started the run, for the report
scenes::Verdict runOnce(const RenderArguments& given, const scenes::RenderOptions& options,
                        scenes::Scene& scene, const std::string& command, const std::string& folder,
                        const std::string& record, ProgressBar& bar) {
  OutputFolder out(folder);
  OutputFile json(given.json, {given.scene.scene});
  std::string recorded;
  scenes::RenderOptions run = options;
  run.on_recording = [&recorded](const std::string& file) { recorded = file; };
  const scenes::AssembleResult result = scenes::renderNode(scene, run, record);
  throwIfStopped();
  if (options.stop->load()) return scenes::Verdict::NotShown;  // vps ask requested another run
  const std::vector<std::string> notes = fillFolder(
      out, scene, result, {command + " --session " + given.session, given.has_pictures, bar.progress()});
  out.commit();
  json.write(toJson(result));
  bar.clear();
  printOutcome(scene, result, notes, recorded, folder);
  return result.verdict;
}

int runRender(const RenderArguments& given) {
  const std::string& file = given.scene.scene;
  ProgressBar bar;
  requireNotRead(given.record, {file});
  scenes::Scene scene = sceneFrom(file, given.scene.fidelity, {given.json, given.record}, given.scene.cache);

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
  const std::unique_ptr<scenes::RequestServer> server = requestServerFrom(given);
  options.server = server.get();
  if (server) options.stop = server->endsRun();
  scenes::Verdict verdict = runOnce(given, options, scene, "vps render " + file + " --out " + given.out,
                                    given.out, given.record, bar);
  for (int run = 2; server; ++run) {
    std::optional<scenes::Scene> next = server->takeNext();
    if (!next && given.stays) next = server->waitForNext();
    if (!next) break;
    const std::string folder = given.out + "-" + std::to_string(run);
    try {
      verdict = runOnce(given, options, *next, "vps ask load", folder, "", bar);
    } catch (const LoadError& failed) {  // an error of a scene that vps ask loaded
      if (!given.stays) throw;
      verdict = scenes::Verdict::NotShown;
      options.say(std::string(failed.what()) + "; waiting for the next scene");
    }
  }
  if (server) server->waitForFetchers();
  throwIfStopped();
  return scenes::exitStatusOf(verdict);
}

}  // namespace

std::function<int()> addRender(CLI::App& command) {
  const auto given = std::make_shared<RenderArguments>();
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
  command
      .add_option("--requests", given->requests,
                  "requests that are answered: all, who (only the list of nodes), or none. Other users, and "
                  "nodes without the required certificates, are always refused")
      ->check(CLI::IsMember({"all", "who", kNoRequests}))
      ->capture_default_str();
  command.add_flag("--on-request", given->waits, "take each part only when vps ask take requests it");
  command.add_flag("--stay", given->stays,
                   "after a run, wait for vps ask load or vps ask again; the results of the n-th run go to "
                   "DIR-n, and --json contains those of the last run");
  addJsonOption(command, given->json);
  return [given] { return runRender(*given); };
}

}  // namespace vps::viewer
