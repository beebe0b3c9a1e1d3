// SPDX-License-Identifier: BSD-3-Clause
// vps ask: asks the render node of a session for something.
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
  /// What was chosen.
  std::function<scenes::SessionAnswer(const scenes::SessionRequest&, const AskArguments&)> ask;
};

/// The answer's lines. Names in it are another program's, and control no terminal.
std::string printable(std::string words) {
  std::replace_if(
      words.begin(), words.end(), [](unsigned char c) { return c != '\n' && (c < 0x20 || c == 0x7f); }, ' ');
  return words;
}

/// Empty: none.
std::string stiffnessFault(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool is_good = !text.empty() && *end == '\0' && std::isfinite(value) && value > 0;
  return is_good ? std::string() : "'" + text + "' is no stiffness; give a number above 0";
}

/// Waits for the recording.
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
  add("who", "who is there, and what they do",
      [](const auto& request, const AskArguments&) { return request.who(); });
  add("take", "the hand takes the next part (vps render --on-request)",
      [](const auto& request, const AskArguments& chosen) { return request.take(chosen.part); })
      ->add_option("part", given->part, "its name, so that no other one is taken")
      ->type_name("PART");
  add("release", "the hand lets go of the part where it is; the step ends there",
      [](const auto& request, const AskArguments&) { return request.release(); });
  add("rearm", "force returns to the hand after a fault",
      [](const auto& request, const AskArguments&) { return request.rearm(); });
  add("gains", "stiffness of the coupling from the next part on, as far as the device is passive",
      [](const auto& request, const AskArguments& chosen) {
        return request.setGains(chosen.gains.front(), chosen.gains.size() > 1 ? chosen.gains.back() : 0);
      })
      ->add_option("gains", given->gains, "N/m, and N m/rad")
      ->required()
      ->expected(1, 2)
      ->check(stiffnessFault)
      ->type_name("K");
  add("load", "another scene in place of this one; it is sent where vps render does not know it",
      [](const auto& request, const AskArguments& chosen) { return load(request, chosen.scene); })
      ->add_option("scene", given->scene, "scene file (TOML), or the hash of a scene that is known there")
      ->required()
      ->type_name("SCENE");
  add("again", "the same scene from its beginning",
      [](const auto& request, const AskArguments&) { return request.again(); });
  CLI::App* record =
      add("record", "records the runs that begin from now on, in the folder of vps render",
          [](const auto& request, const AskArguments& chosen) { return request.record(chosen.name); });
  record->add_option("name", given->name, "of the file, such as run_1.mcap")->required()->type_name("NAME");
  record
      ->add_option("--bring", given->bring,
                   "wait until the run has ended, and bring its recording here, into this file")
      ->type_name("FILE.mcap");
  add("stop-recording", "no further run is recorded",
      [](const auto& request, const AskArguments&) { return request.record(""); });
  return [given] { return runAsk(*given); };
}

}  // namespace vps::viewer
