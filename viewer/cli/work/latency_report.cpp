// SPDX-License-Identifier: BSD-3-Clause
#include "work/latency_report.h"

#include <cstdio>
#include <optional>
#include <vector>

#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/progress_bar.h"
#include "output/table.h"
#include "output/terminal.h"

namespace vps::viewer {
namespace {

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
  addRow(table, "picture, sound and force are apart", result.apart_s());
  std::fputs(table.text().c_str(), stdout);
  std::printf(
      "%zu contacts of '%s'; pictures of %d x %d by %s, %.1f ms each; sound: %s\n"
      "apart: %s (bound: 99 of 100 within %.0f ms). Not in it: what a display takes to show a picture.\n",
      result.contacts.size(), result.part.c_str(), result.width, result.height, result.drawn_by.c_str(),
      1e3 * result.picture_wall_s,
      result.hasSound() ? ("a card in the program, three periods of 64 samples; samples late " +
                           std::to_string(result.late_samples) + " times, the mixer " +
                           std::to_string(result.late_mixes) + " times")
                              .c_str()
                        : result.silence.c_str(),
      result.isGood() ? "good" : "too far, or not all seen", 1e3 * kApart_s);
}

}  // namespace

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

}  // namespace vps::viewer
