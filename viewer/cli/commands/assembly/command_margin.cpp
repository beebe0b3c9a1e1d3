// SPDX-License-Identifier: BSD-3-Clause
// vps margin: measures how much the part of each step may grow before the step fails.
#include <cstdio>
#include <memory>
#include <optional>

#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/planning/margin.h"
#include "vps_viewer/report/pages.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

struct MarginArguments {
  SceneArguments scene;
  std::string resolution = "1um";
  bool has_contact = true;
  std::string json, html, pdf;  ///< output files; empty: none
};

std::string marginTable(const scenes::MarginResult& result) {
  Table table({"<step", "fits with [um]", "fails with [um]", "geometry allows [um]", "<fails as",
               "position [um]", "angle [mrad]"});
  for (const scenes::StepMargin& step : result.steps)
    table.add({step.part, step.goes ? um(step.growth_m) : "-",
               step.growth_fails_m ? um(*step.growth_fails_m) : "-", um(step.growth_bound_m),
               step.fails_as == scenes::Verdict::Fits ? "" : words(step.fails_as),
               step.position_m ? um(*step.position_m) : "-",
               step.angle_rad ? fixed(1e3 * *step.angle_rad, 2) : "-"});
  return table.text();
}

/// Prints the table and the tightest step, which is the first of result.steps. Returns the exit status.
int tell(const scenes::MarginResult& result) {
  std::fputs(marginTable(result).c_str(), stdout);
  if (result.steps.empty()) return kCouldNot;
  const scenes::StepMargin& worst = result.steps.front();
  if (!worst.goes) {
    std::printf("'%s' %s as drawn: %s\n", worst.part.c_str(),
                worst.fails_as == scenes::Verdict::Blocked ? "is blocked" : "is not shown to go in",
                worst.fails_why.c_str());
    return scenes::exitStatusOf(result.verdict());
  }
  std::printf("The tightest step is '%s': each of its faces may grow by %s um%s.\n", worst.part.c_str(),
              um(worst.growth_m).c_str(), result.has_contact ? "" : " at most, by geometry alone");
  return kGood;
}

int runMargin(const MarginArguments& given) {
  OutputFile json(given.json, {given.scene.scene}), html(given.html, {given.scene.scene});
  PdfFile pdf(given.pdf, {given.scene.scene});
  scenes::MarginOptions options;
  options.resolution_m = scenes::lengthFromText(given.resolution, "--resolution");
  options.has_contact = given.has_contact;
  options.stop = &stopRequested();
  ProgressBar bar;
  scenes::Scene scene = sceneFrom(given.scene.scene, given.scene.fidelity,
                                  {given.json, given.html, given.pdf}, given.scene.cache);
  // No cache is used: each model has another size and would displace models that are used again.
  setModelOptions(options, bar, std::nullopt, given.scene.models_everything);
  const scenes::MarginResult result = scenes::measureMargins(scene, options);
  throwIfStopped();
  json.write(toJson(result));
  const std::string page = marginPage(result);
  html.write(page);
  bar.clear();
  const int status = tell(result);
  pdf.write(page);  // printed last, so that a failure loses no other result
  return status;
}

}  // namespace

std::function<int()> addMargin(CLI::App& command) {
  const auto given = std::make_shared<MarginArguments>();
  addSceneArgument(command, given->scene.scene);
  command.add_option("--resolution", given->resolution, "resolution of the growth, with unit")
      ->capture_default_str();
  command.add_flag("!--geometry", given->has_contact,
                   "use exact distances alone, without runs of the virtual operator: quick, and the result "
                   "is an upper bound");
  command.add_option("--html", given->html, "write an HTML page with a bar chart")->type_name("FILE");
  addPdfOption(command, given->pdf);
  addFidelityOptions(command, given->scene.fidelity);
  addJsonOption(command, given->json);
  return [given] { return runMargin(*given); };
}

}  // namespace vps::viewer
