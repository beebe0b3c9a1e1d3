// SPDX-License-Identifier: BSD-3-Clause
// vps plan: finds order and paths of an assembly, and writes them as a scene that vps assemble runs.
#include <cstdio>
#include <memory>

#include "input/cad_arguments.h"
#include "input/file_kind.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/run/verdict.h"
#include "vps_scenes/scene/number_words.h"
#include "work/planned_folder.h"

namespace vps::viewer {

namespace {

int verify(const PlanArguments& given) {
  if (given.assembly.size() > 1)
    throw LoadError(given.assembly[1], "", "is a second file; --verify checks one scene");
  OutputFile json(given.json, given.assembly);
  ProgressBar bar;
  requireSceneFile(given.assembly.front());
  const scenes::Scene scene = loadedScene(given.assembly.front(), given.cad.cache, bar.progress());
  const std::vector<scenes::WayFault> faults =
      checkWays(scene, bar.progress(), plannedClearances(given.assembly.front()));
  throwIfStopped();
  json.write(toJson(scene.name, faults));
  bar.clear();
  for (const scenes::WayFault& fault : faults) std::printf("%s\n", inWords(fault).c_str());
  const scenes::Verdict verdict = verdictOf(faults);
  const char* const words = verdict == scenes::Verdict::Blocked ? "; the procedure as written is blocked"
                            : verdict == scenes::Verdict::NotShown
                                ? "; not shown: the meshes are too coarse to tell whether the paths are free"
                                : "";
  std::printf("%s: %zu steps, %zu with faults%s\n", scene.name.c_str(), scene.steps.size(), faults.size(),
              words);
  return scenes::exitStatusOf(verdict);
}

struct PlanCommandArguments : PlanArguments {
  bool is_verify = false;
};

int runPlan(const PlanCommandArguments& given) {
  if (given.is_verify) return verify(given);
  if (given.out.empty()) throw LoadError("", "", "--out is missing; name a folder for the planned scene");
  ProgressBar bar;
  return scenes::exitStatusOf(planInto(given, bar).verdict);
}

}  // namespace

std::function<int()> addPlan(CLI::App& command) {
  const auto given = std::make_shared<PlanCommandArguments>();
  command
      .add_option("assembly", given->assembly,
                  "CAD files that share one frame, or a scene file (TOML), whose parts are then at their "
                  "targets and whose steps are replaced")
      ->required()
      ->type_name("CAD|SCENE");
  command
      .add_option("-o,--out", given->out, "folder for scene.toml, meshes, plan.json, plan.dot and plan.svg")
      ->type_name("DIR");
  addCadOptions(command, given->cad);
  addCacheOptions(command, given->cad.cache);
  addPlanOptions(command, *given);
  command.add_flag("--force", given->is_forced, "replace a scene.toml that exists");
  CLI::Option* const book = command.add_option(
      "--book", given->book,
      "write an instruction book (.html, or .pdf printed by Chromium): an exploded view with the parts list, "
      "and a sheet for each step with picture, path, fits, play and hints");
  book->type_name("FILE");
  CLI::Option* const verify = command.add_flag(
      "--verify", given->is_verify,
      "plan nothing: check that the scene's paths lead through no part in place and keep the clearances of "
      "the plan.json in the scene's folder, and that each released part is carried by parts in place");
  verify->excludes(book);
  addJsonOption(command, given->json);
  return [given] { return runPlan(*given); };
}

}  // namespace vps::viewer
