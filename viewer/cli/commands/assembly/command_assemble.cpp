// SPDX-License-Identifier: BSD-3-Clause
// vps assemble: brings the parts together by contact, and writes report, pictures and data.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "input/cad_arguments.h"
#include "input/file_kind.h"
#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps/write_file.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/derived_scenes.h"
#include "vps_scenes/run/replay.h"
#include "vps_viewer/report/report.h"
#include "vps_viewer/report/words.h"
#include "work/heard_run.h"
#include "work/planned_folder.h"

namespace vps::viewer {

namespace {

struct AssembleArguments {
  SceneArguments scene;
  PlanArguments plan;                   ///< options for CAD files
  std::vector<std::string> more_files;  ///< CAD files that follow the first, which is in `scene`
  std::string out = "out";
  std::string json;
  std::string record;  ///< file to record the run in; empty: none
  std::string sound;   ///< WAV file for the sound of the run; empty: none
  int tries = 1;
  bool has_pictures = true;
  bool stops_at_failure = false;
  bool is_real_time = false;
  bool has_local_contact = false;
  bool sheds_load = true;  ///< in real time: lowers the fidelity if the rate cannot be held
  bool takes_apart = false;
  bool has_pdf = false;
};

scenes::Verdict runScene(const AssembleArguments& given) {
  const std::string& file = given.scene.scene;
  OutputFolder out(given.out);
  OutputFile json(given.json, {file});
  OutputFile wav(given.sound, {file});
  ProgressBar bar;
  requireNotRead(given.record, {file});
  scenes::Scene scene = sceneFrom(file, given.scene.fidelity, {given.json, given.record}, given.scene.cache);
  if (given.takes_apart) scene = scenes::disassemblyOf(std::move(scene));

  scenes::AssembleOptions options;
  const std::optional<VoxMapCache> cache = cacheFrom(given.scene.cache);
  setModelOptions(options, bar, cache, given.scene.models_everything);
  options.keep_going = !given.stops_at_failure;
  options.stop = &stopRequested();
  options.is_real_time = given.is_real_time;
  options.degrades = given.sheds_load;
  options.has_local_contact = given.has_local_contact;
  HeardRun heard;
  if (!given.sound.empty()) {
    heard.hear(scene);
    heard.listenTo(options);
  }
  const std::string unfinished = given.out + "/unfinished.json", page = given.out + "/unfinished.html";
  std::optional<scenes::AssembleResult> so_far;
  options.on_step = [&](const scenes::AssembleResult& now) {
    writeWholeFile(unfinished, toJson(now));
    writeWholeFile(page, unfinishedPage(scene, now));
    so_far = now;
  };
  const auto run = [&] {
    if (given.tries > 1) return scenes::assembleTries(scene, {given.tries}, options);
    return given.record.empty() ? scenes::assemble(scene, options)
                                : scenes::assembleAndRecord(scene, given.record, options);
  };
  scenes::AssembleResult result;
  std::vector<std::string> notes;
  try {
    result = run();
    throwIfStopped();
    bar.progress()("writing the report", 1);
    notes = fillFolder(
        out, scene, result,
        {"vps assemble " + file + " --out " + given.out + (given.takes_apart ? " --disassemble" : "") +
             (given.tries > 1 ? " --tries " + std::to_string(given.tries) : ""),
         given.has_pictures, bar.progress()});
  } catch (const Stopped&) {
    bar.clear();
    if (so_far) {
      printSteps(*so_far, scene.fidelity);
      std::printf("stopped; the results so far are in %s, as a page in %s\n", unfinished.c_str(),
                  page.c_str());
    }
    throw;
  }
  out.commit();
  std::filesystem::remove(unfinished);
  std::filesystem::remove(page);
  json.write(toJson(result));
  bar.clear();
  if (!given.sound.empty()) wav.write(heard.wav());

  printOutcome(scene, result, notes, given.record, given.out);
  // The PDF file is printed last, so that a failure loses no other result.
  if (given.has_pdf) requirePrinted(given.out + "/report.html", given.out + "/report.pdf");
  return result.verdict;
}

/// Runs the subassemblies of a planned product, inner ones first, each into a folder of its own, and then the
/// product, which mounts each of them as one part. --disassemble runs the product first, and then the
/// subassemblies, outer ones first.
scenes::Verdict runPlanned(const AssembleArguments& given,
                           const std::vector<PlannedFolder::SceneFile>& scene_files) {
  namespace fs = std::filesystem;
  Table table({"<assembly", "<verdict", "<report"});
  scenes::Verdict whole = scenes::Verdict::Fits;
  const auto run = [&](const AssembleArguments& of, const std::string& name) {
    if (scene_files.size() > 1) std::printf("\n%s\n", name.c_str());
    const scenes::Verdict verdict = runScene(of);
    whole = scenes::worse(whole, verdict);
    table.add({name, words(verdict), of.out + "/report.html"});
  };
  const auto runPart = [&](std::size_t i) {
    AssembleArguments part = given;
    part.scene.scene = scene_files[i].path;
    const std::string name = fs::path(part.scene.scene).stem().string();
    if (!scene_files[i].has_steps) {
      std::printf(
          "\n%s\nThe plan found no path for any part of this subassembly, so it was not run; the plan names "
          "what is in the way.\n",
          name.c_str());
      whole = scenes::worse(whole, scenes::Verdict::NotShown);
      table.add({name, words(scenes::Verdict::NotShown), "-"});
      return;
    }
    part.out = (fs::path(given.out) / name).string();
    part.json = part.record = part.sound = "";
    run(part, name);
  };
  const auto runProduct = [&] {
    AssembleArguments product = given;
    product.scene.scene = scene_files.front().path;
    run(product, "product");
  };
  const std::size_t count = scene_files.size();
  if (given.takes_apart) runProduct();
  for (std::size_t i = 1; i < count; ++i) runPart(given.takes_apart ? i : count - i);
  if (!given.takes_apart) runProduct();
  if (scene_files.size() > 1) std::printf("\n%s", table.text().c_str());
  return whole;
}

std::vector<std::string> filesOf(const AssembleArguments& given) {
  std::vector<std::string> files{given.scene.scene};
  files.insert(files.end(), given.more_files.begin(), given.more_files.end());
  return files;
}

/// Prints the parts that are proven to have no path, which blocks the product whatever the runs show.
void sayEnclosed(const PlannedFolder& planned) {
  for (const scenes::BlockedPart& part : planned.enclosed)
    std::printf("No, the parts do not go together: blocked at '%s', which%s.\n", part.name.c_str(),
                withoutPathWords(part, "").c_str());
}

/// Plans the CAD files into the folder `plan` of the results, then runs the planned scenes. The exit status
/// is that of the worse verdict of the plan and of the runs.
int runCad(AssembleArguments given) {
  PlanArguments plan = std::move(given.plan);
  plan.assembly = filesOf(given);
  plan.cad.cache = given.scene.cache;
  plan.out = (std::filesystem::path(given.out) / "plan").string();
  plan.is_forced = true;
  requireNotRead(given.json, plan.assembly);
  ProgressBar bar;
  const PlannedFolder planned = planInto(plan, bar);
  if (planned.steps == 0 && scenes::isGood(planned.verdict))
    throw LoadError(
        given.scene.scene, "",
        "has one part, so there is nothing to assemble; give the files of the other parts too, or "
        "use `vps simulate`");
  if (planned.steps == 0) {
    std::printf(
        "The plan found no path for any part, so nothing was run; the plan names what is in the way.\n");
    sayEnclosed(planned);
    return scenes::exitStatusOf(planned.verdict);
  }
  given.plan = {};
  const scenes::Verdict verdict = runPlanned(given, planned.scene_files);
  // A part without a path was not run, so that the runs alone do not tell whether the product goes together.
  sayEnclosed(planned);
  return scenes::exitStatusOf(scenes::worse(verdict, planned.verdict));
}

int runAssemble(const AssembleArguments& given) {
  if (given.has_pdf) requirePdf();
  if (areCadFiles(filesOf(given))) return runCad(given);
  requireNoCadOptions(given.scene.scene, given.plan.cad);
  if (!given.plan.bases.empty() || given.plan.has_bench || given.plan.is_resumed)
    throw LoadError(
        given.scene.scene, "",
        "is a scene, which states its order and paths; leave out --base, --bench and --resume, or "
        "plan it anew "
        "with vps plan");
  return scenes::exitStatusOf(runScene(given));
}

}  // namespace

std::function<int()> addAssemble(CLI::App& command) {
  const auto given = std::make_shared<AssembleArguments>();
  addSceneOptions(command, given->scene);
  command.get_option("scene")
      ->description("scene file (TOML), or a CAD file, which is planned first, as by vps plan")
      ->type_name("SCENE|CAD");
  command.add_option("more", given->more_files, "more CAD files, which share one frame with the first")
      ->type_name("CAD");
  addCadOptions(command, given->plan.cad);
  addPlanOptions(command, given->plan);
  command.add_option("--out", given->out, "folder for the results")->capture_default_str()->type_name("DIR");
  command.add_flag("!--no-pictures", given->has_pictures, "write only tables, plots and data");
  command.add_flag("--pdf", given->has_pdf, "also write report.pdf, printed by Chromium");
  command.add_flag("--stop-at-failure", given->stops_at_failure, "end at the first step that fails");
  command.add_flag("--disassemble", given->takes_apart,
                   "run the procedure backwards, for maintenance: all parts are in place and are taken off "
                   "along their paths, the last one first");
  command.add_flag("--local-contact", given->has_local_contact,
                   "let the haptic loop compute contact between physics steps; useful if physics is slow");
  command.add_flag("--real-time", given->is_real_time,
                   "run in real time, with threads for the haptic loop and physics; not repeatable");
  command.add_flag("!--no-load-shedding", given->sheds_load,
                   "with --real-time: keep the full fidelity when the rate cannot be held, and count missed "
                   "periods");
  command
      .add_option("--record", given->record,
                  "record the run with its scene and meshes (MCAP), for vps replay")
      ->type_name("FILE");
  command
      .add_option("--sound", given->sound,
                  "write the sound of the run (WAV): impacts and rubbing of the parts, beeps of the device")
      ->type_name("FILE")
      ->excludes("--real-time");
  command
      .add_option("--tries", given->tries,
                  "run with this many seeds of the virtual operator, in parallel; one success is enough, and "
                  "the share that succeeds is the ease of assembly")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->excludes("--real-time")
      ->excludes("--local-contact")
      ->excludes("--record")
      ->excludes("--sound");
  addJsonOption(command, given->json);
  return [given] { return runAssemble(*given); };
}

}  // namespace vps::viewer
