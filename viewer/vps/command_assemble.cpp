// SPDX-License-Identifier: BSD-3-Clause
// vps assemble: the main job.
#include <cstdio>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "run_report.h"
#include "terminal.h"
#include "vps_scenes/assemble.h"

namespace vps {

int runAssemble(const AssembleArguments& given) {
  OutputFolder out(given.out);
  OutputFile json(given.json, {given.scene});
  ProgressBar bar;
  requireNotRead(given.record, {given.scene});
  Scene scene = sceneFrom(given.scene, given.fidelity, {given.json, given.record});

  AssembleOptions options;
  options.progress = bar.progress();
  const std::optional<VoxMapCache> cache = cacheFrom(given.cache);
  options.cache = cache ? &*cache : nullptr;
  options.warn = warn;
  options.keep_going = !given.stops_at_failure;
  options.stop = &stopRequested();
  options.record = given.record;
  const AssembleResult result = assemble(scene, options);
  throwIfStopped();

  bar.progress()("writing the report", 1);
  const std::vector<std::string> notes = fillFolder(
      out, scene, result, {"vps assemble " + given.scene + " --out " + given.out, given.has_pictures});
  out.commit();
  json.write(toJson(result));
  bar.clear();

  const bool is_good = printSteps(result);
  for (const std::string& note : notes) warn(note);
  if (!given.record.empty()) std::printf("recorded: vps replay %s\n", given.record.c_str());
  std::printf("%s; report: %s/report.html\n", is_good ? "done" : "not done", given.out.c_str());
  return is_good ? kGood : kBad;
}

}  // namespace vps
