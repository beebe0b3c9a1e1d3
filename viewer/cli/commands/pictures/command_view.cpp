// SPDX-License-Identifier: BSD-3-Clause
// vps view: opens a window on a scene, a recording or a session.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input/file_kind.h"
#include "input/scene_arguments.h"
#include "input/session_options.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_viewer/draw/stereo.h"
#include "vps_viewer/window/latency.h"
#include "vps_viewer/window/window.h"

namespace vps::viewer {

namespace {

struct ViewArguments {
  SceneArguments scene;
  WindowOptions window;
  std::string stereo = "mono", display;
  std::vector<std::string> show;
  bool measures_latency = false;
  LatencySettings latency;
  std::string json;
};

void addRow(Table& table, const std::string& words, const std::vector<double>& values_s) {
  const auto ms = [&](double share) { return fixed(1e3 * percentile(values_s, share), 1); };
  table.add({words, ms(0.5), ms(0.99), ms(1)});
}

void print(const LatencyResult& result) {
  Table table({"<since the handle was read [ms]", "median", "p99", "longest"});
  for (const LatencyStage& stage : latencyStages()) {
    if (stage.is_sound && !result.hasSound()) continue;
    std::vector<double> values_s;
    for (const ContactTimes& times : result.contacts) values_s.push_back(times.*stage.time_s);
    addRow(table, stage.words, values_s);
  }
  addRow(table, "between picture, sound and force", result.apart_s());
  std::fputs(table.text().c_str(), stdout);
  std::printf(
      "%zu contacts of '%s'; pictures of %d x %d by %s, %.1f ms each; sound: %s\n"
      "time between picture, sound and force: %s (bound: 99 of 100 contacts within %.0f ms). The time that a "
      "display takes to show a picture is not "
      "included.\n",
      result.contacts.size(), result.part.c_str(), result.width, result.height, result.drawn_by.c_str(),
      1e3 * result.picture_wall_s,
      result.hasSound() ? ("a simulated sound card with three periods of 64 samples; samples were late " +
                           std::to_string(result.late_samples) + " times, the mixer was late " +
                           std::to_string(result.late_mixes) + " times")
                              .c_str()
                        : result.silence.c_str(),
      result.isGood() ? "good" : "too long, or not all contacts were found", 1e3 * kApart_s);
}

/// Runs vps view --measure-latency: prints the table and writes the JSON file, unless its name is empty.
/// Returns kBad if picture, sound and force are more than kApart_s apart.
int reportLatency(const SceneArguments& given, const LatencySettings& settings, const std::string& json) {
  OutputFile out(json, {given.scene});
  const scenes::Scene scene = sceneFrom(given.scene, given.fidelity, {json}, given.cache);
  const std::optional<VoxMapCache> cache = cacheFrom(given.cache);
  ProgressBar bar;
  LatencySettings with_models = settings;
  setModelOptions(with_models.models, bar, cache, given.models_everything);
  const LatencyResult result = measureLatency(scene, with_models);
  bar.clear();
  throwIfStopped();
  print(result);
  out.write(toJson(result));
  return result.isGood() ? kGood : kBad;
}

int measure(const ViewArguments& given) {
  if (lowerExtension(given.scene.scene) == ".mcap")
    throw LoadError(given.scene.scene, "",
                    "is a recording, which makes no contact; --measure-latency is for scenes");
  LatencySettings settings = given.latency;
  settings.width = given.window.width;
  settings.height = given.window.height;
  settings.stop = &stopRequested();
  return reportLatency(given.scene, settings, given.json);
}

int runView(const ViewArguments& given) {
  if (given.measures_latency) return measure(given);
  if (const std::string missing = missingForWindow(); !missing.empty()) throw LoadError("", "", missing);
  const std::string& file = given.scene.scene;
  WindowOptions window = given.window;
  window.stop = &stopRequested();
  window.say = [](const std::string& words) { say(words); };
  window.stereo = stereoModeOf(given.stereo);
  window.show = shownModels(given.show);
  if (!given.display.empty()) window.display = scenes::loadDisplay(given.display);
  if (!window.session.empty()) {
    if (!file.empty())
      throw LoadError(file, "", "cannot be shown together with a session; leave out the file, or --session");
    const std::optional<scenes::Verdict> verdict = viewSession(window);
    if (verdict) return scenes::exitStatusOf(*verdict);
    throwIfStopped();
    return kNotShown;
  }
  if (file.empty())
    throw LoadError("", "",
                    "give something to show: a scene file, a recording, or --session NAME of vps render");
  if (lowerExtension(file) == ".mcap") {
    if (window.runs || !window.record.empty() || !window.hand.empty())
      throw LoadError(file, "", "is a recording; --run, --hand and --record are for scenes");
    viewRecording(device::loadRecording(file), window);
    return kGood;
  }
  if (window.full_screen > 0 && file.find_first_not_of("0123456789") == std::string::npos)
    throw LoadError(file, "", "is taken as a file name; to choose a monitor, write --full-screen=" + file);
  requireNotRead(window.record, {file});
  scenes::Scene scene = sceneFrom(file, given.scene.fidelity, {window.record}, given.scene.cache);
  if (window.display) window.display->placeDevice(scene.device);
  const std::optional<VoxMapCache> cache = cacheFrom(given.scene.cache);
  if (!window.hand.empty()) {
    if (device::findDeviceKind(window.hand) == nullptr)
      throw LoadError("", "",
                      "--hand '" + window.hand + "' is not known; known are " + device::deviceKindNames());
    window.runs = true;
  }
  window.models.cache = cache ? &*cache : nullptr;
  window.models.models_everything = given.scene.models_everything;
  viewScene(scene, window);
  return kGood;
}

}  // namespace

std::function<int()> addView(CLI::App& command) {
  const auto given = std::make_shared<ViewArguments>();
  addSceneOptions(command, given->scene);
  command.get_option("scene")->description("scene file (TOML), or what vps assemble --record wrote (MCAP)");
  command.get_option("scene")->required(false);
  WindowOptions& window = given->window;
  CLI::Option* session =
      command
          .add_option(
              "--session", window.session,
              "follow this session of vps render instead of a file; key M marks a place for all watchers")
          ->type_name("NAME");
  addNetworkOption(command, window.network)->needs(session);
  command.add_option("--width", window.width, "width of the window")
      ->capture_default_str()
      ->check(CLI::Range(64, 16384));
  command.add_option("--height", window.height, "height of the window")
      ->capture_default_str()
      ->check(CLI::Range(64, 16384));
  command.add_flag("--dark", window.is_dark, "dark panels and background");
  command.add_flag("!--silent", window.has_sound, "no sound");
  command.add_flag("--run", window.runs, "start the procedure at once");
  command
      .add_option("--hand", window.hand,
                  "run the procedure at once and move the parts with this kind of device (vps device "
                  "--list): mouse, space_mouse, game_controller, dual_arm, ...")
      ->type_name("KIND");
  command
      .add_option(
          "--speed", window.speed,
          "speed of a recording or a run relative to real time; 0: a run is computed as fast as possible")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  command.add_option("--record", window.record, "record a run (MCAP), for vps replay and vps view")
      ->type_name("FILE");
  command.add_flag("--headset", window.seeks_headset,
                   "also show the scene in a headset (OpenXR), on a table in front of the user; the "
                   "controller's trigger picks a part and, with --hand mouse, takes it");
  std::vector<std::string> modes;
  for (const StereoMode mode : stereoModes()) modes.emplace_back(toText(mode));
  command.add_option("--stereo", given->stereo, "stereo mode at the start; the key S changes the mode")
      ->capture_default_str()
      ->check(CLI::IsMember(modes));
  command.add_flag("--quad-buffer", window.has_stereo_buffers,
                   "give each eye a buffer of its own, if the driver supports it (shutter glasses); for "
                   "--stereo mono, since the pictures of the other stereo modes hold both eyes already");
  command
      .add_option("--display", given->display,
                  "display file (TOML): the window shows the picture of each screen for each viewer (the "
                  "key O shows one picture alone); if the file states where the device stands, the part is "
                  "drawn at the hand")
      ->type_name("FILE");
  command
      .add_option("--output", window.output,
                  "picture of the display file that is shown alone at the start: SCREEN, SCREEN_VIEWER, ...")
      ->type_name("NAME")
      ->needs("--display");
  // --full-screen is a flag, because an option with an optional value would take the scene file as its value.
  command
      .add_flag("--full-screen{1}", window.full_screen,
                "fill the first monitor, or monitor 2 with --full-screen=2, without panels; the key F11 "
                "switches full screen on or off")
      ->check(CLI::Range(1, 64));
  command
      .add_option("--show", given->show,
                  "draw the models of contact instead of the parts: points, voxels, or points,voxels (points "
                  "of the parts that a step moves, voxels of the others)")
      ->delimiter(',')
      ->check(CLI::IsMember({"points", "voxels"}));
  CLI::Option* latency = command.add_flag("--measure-latency", given->measures_latency,
                                          "measure the time between picture, sound and force of a contact, "
                                          "without window, display and sound card");
  command.add_option("--taps", given->latency.taps, "number of contacts to measure, about 0.4 s each")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000))
      ->needs(latency);
  addJsonOption(command, given->json);
  command.get_option("--json")->needs(latency);
  for (const char* name : {"--run", "--hand", "--record", "--stereo", "--display", "--show", "--session"})
    latency->excludes(name);
  for (const char* name : {"--run", "--hand", "--record"}) session->excludes(name);
  command.add_option("--pictures", window.pictures, "saved pictures are NAME_1.png, NAME_2.png, ...")
      ->capture_default_str()
      ->type_name("NAME");
  return [given] { return runView(*given); };
}

}  // namespace vps::viewer
