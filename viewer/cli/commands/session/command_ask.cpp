// SPDX-License-Identifier: BSD-3-Clause
// vps ask: sends a request to the render node of a session.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "input/scene_arguments.h"
#include "input/session_options.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/network/session_request.h"

namespace vps::viewer {

namespace {

struct AskArguments {
  std::string session = kDefaultSession;
  scenes::SessionNetwork network;
  std::string json;
  std::string part, scene, name, bring;
  std::vector<double> gains;
  /// Sends the chosen request.
  std::function<scenes::SessionAnswer(const scenes::SessionRequest&, const AskArguments&)> ask;
};

/// Replaces control characters, because the answer may contain names from another program.
std::string printable(std::string words) {
  std::replace_if(
      words.begin(), words.end(), [](unsigned char c) { return c != '\n' && (c < 0x20 || c == 0x7f); }, ' ');
  return words;
}

/// Returns why the text is not a stiffness; empty if it is one.
std::string stiffnessFault(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool is_good = !text.empty() && *end == '\0' && std::isfinite(value) && value > 0;
  return is_good ? std::string() : "'" + text + "' is not a stiffness; give a number greater than 0";
}

/// Waits until the run has ended, and receives its recording.
int bringRecording(const AskArguments& given) {
  scenes::SessionRecordingOptions options = recordingOptions(given.session, given.network, given.bring);
  options.name = given.name;
  scenes::SessionRecording recording(options);
  requireAsked(recording, "");
  return finishRecording(recording, given.bring);
}

int runAsk(const AskArguments& given) {
  if (!given.bring.empty()) return bringRecording(given);
  OutputFile json(given.json, {given.scene});
  const scenes::SessionAnswer answer = given.ask(scenes::SessionRequest(given.session, given.network), given);
  json.write(toJson(answer));
  if (!answer.is_done) throw LoadError("", "", answer.words);
  std::printf("%s\n", printable(answer.words).c_str());
  return kGood;
}

scenes::SessionAnswer load(const scenes::SessionRequest& request, const std::string& scene) {
  if (scenes::isSceneHash(scene)) return request.load(scene);
  ProgressBar bar;
  const Progress show = bar.progress();
  return request.load(sceneFrom(scene, {}, {}, {}), [&](double share) { show("sending the scene", share); });
}

}  // namespace

std::function<int()> addAsk(CLI::App& command) {
  const auto given = std::make_shared<AskArguments>();
  command.require_subcommand(1);
  addSessionOption(command, given->session);
  addNetworkOption(command, given->network);
  addJsonOption(command, given->json);
  const auto add = [&](const char* name, const char* summary, auto ask) {
    CLI::App* sub = command.add_subcommand(name, summary);
    sub->fallthrough();  // so that --session may come last
    sub->callback([given, ask] { given->ask = ask; });
    return sub;
  };
  add("who", "lists the nodes of the session and what they do",
      [](const auto& request, const AskArguments&) { return request.who(); });
  add("take", "takes the next part in hand (vps render --on-request)",
      [](const auto& request, const AskArguments& chosen) { return request.take(chosen.part); })
      ->add_option("part", given->part, "name of the part; the request is refused if another part is next")
      ->type_name("PART");
  add("release", "releases the part where it is, which ends the step",
      [](const auto& request, const AskArguments&) { return request.release(); });
  add("rearm", "re-arms the device after a fault, so that it gives force again",
      [](const auto& request, const AskArguments&) { return request.rearm(); });
  add("gains",
      "sets the stiffness of the coupling from the next part on, within the limit at which the device is "
      "passive",
      [](const auto& request, const AskArguments& chosen) {
        return request.setGains(chosen.gains.front(), chosen.gains.size() > 1 ? chosen.gains.back() : 0);
      })
      ->add_option("gains", given->gains, "translational stiffness [N/m], and rotational stiffness [N m/rad]")
      ->required()
      ->expected(1, 2)
      ->check(stiffnessFault)
      ->type_name("K");
  add("load", "loads another scene, which is sent if vps render does not have it yet",
      [](const auto& request, const AskArguments& chosen) { return load(request, chosen.scene); })
      ->add_option("scene", given->scene, "scene file (TOML), or the hash of a scene that vps render has")
      ->required()
      ->type_name("SCENE");
  add("again", "runs the same scene again from its beginning",
      [](const auto& request, const AskArguments&) { return request.again(); });
  CLI::App* record =
      add("record", "records the following runs, in the folder of vps render",
          [](const auto& request, const AskArguments& chosen) { return request.record(chosen.name); });
  record->add_option("name", given->name, "name of the file, such as run_1.mcap")
      ->required()
      ->type_name("NAME");
  record
      ->add_option("--bring", given->bring,
                   "wait until the run has ended, and receive its recording into this file")
      ->type_name("FILE.mcap");
  add("stop-recording", "stops recording the following runs",
      [](const auto& request, const AskArguments&) { return request.record(""); });
  return [given] { return runAsk(*given); };
}

}  // namespace vps::viewer
