// SPDX-License-Identifier: BSD-3-Clause
// vps plan: order and ways of an assembly, as a scene that vps assemble runs.
#include <cstdio>
#include <memory>

#include "cad_arguments.h"
#include "command.h"
#include "file_kind.h"
#include "json_out.h"
#include "output.h"
#include "plan_report.h"
#include "planned_folder.h"
#include "terminal.h"
#include "vps/load_error.h"
#include "vps_scenes/plan.h"

namespace vps::viewer::inline v0 {

namespace {

int verify(const PlanArguments& given) {
  OutputFile json(given.json, {given.assembly});
  ProgressBar bar;
  requireSceneFile(given.assembly);
  const scenes::Scene scene = scenes::loadScene(given.assembly, bar.progress());
  const std::vector<scenes::WayFault> faults = checkWays(scene, bar.progress());
  throwIfStopped();
  json.write(toJson(scene.name, faults));
  bar.clear();
  for (const scenes::WayFault& fault : faults) std::printf("%s\n", inWords(fault).c_str());
  std::printf("%s: %zu steps, %zu ways lead through parts in place\n", scene.name.c_str(), scene.steps.size(),
              faults.size());
  return faults.empty() ? kGood : kBad;
}

struct PlanCommandArguments : PlanArguments {
  bool is_verify = false;
};

int runPlan(const PlanCommandArguments& given) {
  if (given.is_verify) return verify(given);
  if (given.out.empty()) throw LoadError("", "", "--out is missing; name a folder for the planned scene");
  ProgressBar bar;
  return planInto(given, bar).status;
}

}  // namespace

void addPlan(CommandLine& line) {
  const auto given = std::make_shared<PlanCommandArguments>();
  CLI::App& command = addCommand(
      line, "plan", "order and ways of an assembly, found by taking it apart; writes a scene",
      "vps plan scenes/bearing_block/bearing_block.step -o planned", [given] { return runPlan(*given); });
  command
      .add_option("assembly", given->assembly,
                  "a CAD file, or a scene file (TOML): its parts at their targets, its steps are replaced")
      ->required()
      ->type_name("CAD|SCENE");
  command.add_option("-o,--out", given->out, "folder for scene.toml, meshes, plan.json and plan.dot")
      ->type_name("DIR");
  command.add_option("--base", given->bases, "a part that stands still, by name; may be given several times")
      ->type_name("NAME");
  addCadOptions(command, given->cad);
  command.add_flag("--bench", given->has_bench,
                   "lay the parts out around the base; each is lifted over everything to where it goes");
  command.add_flag("--force", given->is_forced, "replace a scene.toml that exists");
  command.add_flag("--verify", given->is_verify,
                   "plan nothing: check that the ways of a scene lead through no part in place");
  addJsonOption(command, given->json);
}

}  // namespace vps::viewer::inline v0
