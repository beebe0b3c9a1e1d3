// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/report.h"

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <utility>

#include "files/html.h"
#include "pages/pictures.h"
#include "pages/sections.h"
#include "plots/run_plot.h"
#include "vps/errors.h"
#include "vps/stoppable.h"
#include "vps/write_file.h"
#include "vps_device/device_kinds.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/run/load_level.h"
#include "vps_scenes/scene/scene_text.h"
#include "vps_viewer/report/csv.h"
#include "vps_viewer/report/pages.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {
namespace {

using html::Cell;
using html::format;

std::string headline(const scenes::AssembleResult& result) {
  const bool is_good = result.verdict == scenes::Verdict::Fits;
  return "<p class=\"verdict " + std::string(is_good ? "good" : "bad") + "\">" +
         escapeHtml(verdictLine(result)) + "</p>\n";
}

/// @param has_sections  whether the page has a section for each step, to which the part's name links
std::string stepTable(const scenes::AssembleResult& result, bool has_sections = true) {
  std::vector<std::vector<Cell>> rows;
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const scenes::StepResult& s = result.steps[i];
    const std::string number = std::to_string(i + 1);
    rows.push_back({{number, "n"},
                    {has_sections ? "<a href=\"#step-" + number + "\">" + escapeHtml(s.part) + "</a>"
                                  : escapeHtml(s.part),
                     ""},
                    {words(s.verdict), scenes::isGood(s) ? "good" : "bad"},
                    {format(s.duration_s, "%.2f"), "n"},
                    {micrometres(s.max_penetration_m), scenes::isWithinLimit(s) ? "n" : "n bad"},
                    {s.penetration_limit_m > 0 ? micrometres(s.penetration_limit_m) : "", "n"},
                    {escapeHtml(s.deepest_against), ""},
                    {format(s.peak_force_N, "%.2f"), "n"},
                    {format(s.peak_torque_Nm, "%.3f"), "n"},
                    {std::to_string(s.impacts), "n"},
                    {std::to_string(s.slides), "n"},
                    {micrometres(s.final_error_m, "%.1f"), "n"},
                    {s.completed ? micrometres(s.rest_drift_m) : "", "n"}});
  }
  return html::table(
      {"#", "part", "verdict", "time [s]", "greatest overlap [µm]", "limit [µm]", "with", "peak force [N]",
       "peak torque [N m]", "impacts", "slides", "final error [µm]", "drift at rest [µm]"},
      rows);
}

/// The strategies in order, with spaces in their names: "approach 1.2 s, touch 0.4 s".
std::string strategiesInWords(const std::vector<scenes::StrategyUse>& uses) {
  std::string words;
  for (const scenes::StrategyUse& use : uses) {
    std::string name = use.strategy;
    std::replace(name.begin(), name.end(), '_', ' ');
    words.append(words.empty() ? "" : ", ").append(name).append(format(use.duration_s, " %.2f s"));
  }
  return words.empty() ? "none" : words;
}

std::string stepFacts(const scenes::StepResult& s) {
  const Vec3 at_mm = 1e3 * s.deepest_at_W;
  std::string deepest = micrometres(s.max_penetration_m) + " µm";
  if (s.penetration_limit_m > 0)
    deepest += std::string(scenes::isWithinLimit(s) ? " (within" : " (<b class=\"bad\">beyond</b>") +
               " the limit of " + micrometres(s.penetration_limit_m) + " µm)";
  if (s.max_penetration_m > 0) {
    if (!s.deepest_against.empty()) deepest += " with " + escapeHtml(s.deepest_against);
    deepest += ", at (" + format(at_mm.x(), "%.2f") + ", " + format(at_mm.y(), "%.2f") + ", " +
               format(at_mm.z(), "%.2f") + ") mm, " + format(s.deepest_time_s, "%.3f") + " s";
  }
  std::vector<std::pair<std::string, std::string>> facts;
  facts = {{"Verdict", scenes::isGood(s) ? "fits"
                                         : "<b class=\"bad\">" + std::string(words(s.verdict)) +
                                               "</b>: " + escapeHtml(s.reason)},
           {s.is_taken_off ? "Guided by contact on its way out" : "Brought to its target by contact",
            contactWords(s)},
           {"Time", format(s.duration_s, "%.3f") + " s, from " + format(s.start_s, "%.3f") + " s"},
           {"Greatest overlap, by exact distance", deepest},
           {"Greatest overlap, by the voxmap", micrometres(s.field_penetration_m) + " µm"},
           {"Peak force, torque on the hand",
            format(s.peak_force_N, "%.2f") + " N, " + format(s.peak_torque_Nm, "%.3f") + " N m"},
           {"Impacts, slides", std::to_string(s.impacts) + ", " + std::to_string(s.slides)},
           {"What the hand tried, in order", strategiesInWords(s.strategies)},
           {"Times the device was clutched and recentred", std::to_string(s.index_count)},
           {"Final error", micrometres(s.final_error_m, "%.2f") + " µm, " +
                               format(1e3 * s.final_error_rad, "%.3f") + " mrad"},
           {"Greatest motion in the " + format(s.rest_s, "%.1f") + " s after release",
            micrometres(s.rest_drift_m) + " µm"}};
  if (s.turns != 0)
    facts.emplace_back("Screwed on", format(s.turns, "%.2f") + " turns, " +
                                         format(1e3 * s.advance_per_turn_m, "%.3f") +
                                         " mm a turn, leaning by up to " +
                                         format(180 / std::numbers::pi * s.lean_rad, "%.2f") + " degrees");
  if (s.press_needed_N > 0)
    facts.emplace_back(
        "Force to press the part in",
        format(s.press_needed_N, "%.0f") + " N, by Lamé's formula; the hand does not feel this force");
  if (s.hoist_N > 0)
    facts.emplace_back("Hangs on a hoist",
                       "which carries " + format(s.hoist_N, "%.1f") +
                           " N of the part's weight, as the hand may carry no more than the rest; "
                           "forces on the hand are those of a part that is lighter by this weight");
  return html::facts(facts);
}

std::string plotFigure(const std::string& name, const std::string& caption) {
  return html::figure("plots/" + name + ".png", caption + " (<a href=\"plots/" + name + ".svg\">SVG</a>)");
}

/// A plot of the whole run, and the steps that have a plot of their own.
struct WrittenPlot {
  RunPlot plot;
  std::vector<bool> has_step;
};

std::string stepPlotName(const RunPlot& plot, std::size_t step) {
  return plot.name + "_step_" + std::to_string(step + 1);
}

/// Writes all plots into dir/plots. Plots that cannot be made become notes.
std::vector<WrittenPlot> writePlots(const scenes::AssembleResult& result, const std::string& dir,
                                    std::vector<std::string>& notes) {
  std::vector<std::string> step_names;
  for (const scenes::StepResult& step : result.steps) step_names.push_back(step.part);
  std::vector<WrittenPlot> written;
  for (const RunPlot& plot : runPlots()) {
    pollStop();
    const PlotOutcome whole = plot.draw(result, step_names, -1, dir + "/plots/" + plot.name);
    if (!whole) {
      const std::string note = "No plots: " + whole.failure_reason;
      if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
      continue;
    }
    std::vector<bool> has_step(result.steps.size(), false);
    const bool has_steps = !plot.step_caption.empty() && result.steps.size() > 1;
    for (std::size_t i = 0; has_steps && i < result.steps.size(); ++i) {
      pollStop();
      has_step[i] = static_cast<bool>(
          plot.draw(result, step_names, static_cast<int>(i), dir + "/plots/" + stepPlotName(plot, i)));
    }
    written.push_back({plot, has_step});
  }
  return written;
}

std::string stepSection(std::size_t i, const scenes::StepResult& step, const StepPictures& pictures,
                        const std::vector<WrittenPlot>& plots) {
  const std::string number = std::to_string(i + 1);
  std::string out = "<h3 id=\"step-" + number + "\">" + number + ". " + escapeHtml(step.part) + "</h3>\n";
  if (!pictures.start.empty() || !pictures.contact.empty() || !pictures.end.empty()) {
    out += "<div class=\"pictures\">\n";
    if (!pictures.start.empty())
      out += html::figure(pictures.start,
                          step.is_taken_off
                              ? "In place; the part is transparent at the place where the hand puts it down."
                              : "Start; the target is transparent.");
    if (!pictures.contact.empty()) out += html::figure(pictures.contact, "In contact, in section.");
    if (!pictures.end.empty()) out += html::figure(pictures.end, "End, in section.");
    out += "</div>\n";
  }
  out += stepFacts(step);
  for (const WrittenPlot& written : plots)
    if (written.has_step[i]) out += plotFigure(stepPlotName(written.plot, i), written.plot.step_caption);
  return out;
}

/// Load shedding in a real-time run.
std::string loadChanges(const scenes::AssembleResult& result) {
  if (!result.real_time) return "";
  const std::vector<scenes::LoadLevelChange>& changes = result.real_time->load_changes;
  const std::string behind = format(result.real_time->behind_s, "%.2f") +
                             " s of wall-clock time had no physics "
                             "step";
  if (changes.empty()) return "<p>" + behind + "; the fidelity was not reduced to hold the rate.</p>\n";
  std::vector<std::vector<Cell>> rows;
  for (const scenes::LoadLevelChange& change : changes)
    rows.push_back({{format(change.time_s, "%.2f"), "n"},
                    {escapeHtml((change.is_done ? "" : "not done: ") + change.is), ""},
                    {escapeHtml(change.why), ""},
                    {escapeHtml(scenes::describeCost(change)), ""}});
  return "<p>" + behind + ". The fidelity was reduced to hold the rate, and restored, as follows:</p>\n" +
         html::table({"at [s]", "change", "reason", "cost"}, rows);
}

std::string performance(const scenes::AssembleResult& result) {
  const auto row = [](const char* name, double rate_hz, const scenes::TickTimes& t) -> std::vector<Cell> {
    return {{name, ""},
            {format(rate_hz, "%.0f"), "n"},
            {format(rate_hz > 0 ? 1e6 / rate_hz : 0, "%.0f"), "n"},
            {std::to_string(t.count), "n"},
            {format(t.p50_us, "%.1f"), "n"},
            {format(t.p99_us, "%.1f"), "n"},
            {format(t.p999_us, "%.1f"), "n"},
            {format(t.max_us, "%.1f"), "n"},
            {std::to_string(t.missed), "n"}};
  };
  double cook_s = 0;
  for (const scenes::StepResult& s : result.steps) cook_s += s.cook_wall_s;
  return "<h2 id=\"performance\">Run time</h2>\n<p class=\"quiet\">Measured by the wall clock on the "
         "machine of this run; "
         "this section differs from run to run, all others are the same.</p>\n<div data-wall-clock>\n" +
         html::table({"loop", "rate [Hz]", "period [µs]", "ticks", "median [µs]", "99 % [µs]", "99.9 % [µs]",
                      "longest [µs]", "longer than a period"},
                     {row("haptic", result.haptic_rate_hz, result.haptic),
                      row("physics", result.physics_rate_hz, result.physics)}) +
         "<p>The models were built in " + format(result.build_wall_s, "%.2f") +
         " s, the fixed parts cooked in " + format(cook_s, "%.2f") + " s; the run of " +
         format(result.simulated_s, "%.2f") + " s took " + format(result.run_wall_s, "%.2f") + " s.</p>\n" +
         loadChanges(result) + "</div>\n";
}

bool isHandSimulated(const scenes::Scene& scene) {
  const device::DeviceKind* kind = device::findDeviceKind(scene.device.kind);
  return kind == nullptr || kind->isSimulated();
}

std::string handText(const scenes::Scene& scene) {
  if (!isHandSimulated(scene)) return "<li>A person moved the parts by hand.</li>\n";
  return "<li>The hand is simulated (<i>assumed</i> parameters): it aims with a standard deviation of " +
         micrometres(scene.hand.aim_error_m, "%.0f") + " µm and " +
         format(1e3 * scene.hand.aim_error_rad, "%.1f") + " mrad, moves at " +
         format(1e3 * scene.hand.speed_m_s, "%.0f") + " mm/s, presses with " +
         format(scene.hand.press_N, "%.1f") + " N at the target and retracts above " +
         format(scene.hand.force_limit_N, "%.1f") + " N. Seed " + std::to_string(scene.hand.seed) +
         ".</li>\n";
}

std::string method(const scenes::Scene& scene, const scenes::AssembleResult& result) {
  const double megabytes = static_cast<double>(result.modelled.bytes) / 1e6;
  return "<h2>Energy</h2>\n" +
         html::facts({{"Work done on the hand", format(1e3 * result.energy.to_hand_J, "%.3f") + " mJ"},
                      {"Work done by the hand", format(1e3 * result.energy.from_hand_J, "%.3f") + " mJ"},
                      {"Injected energy (received by the hand beyond the stored energy)",
                       format(1e3 * result.energy.injected_J, "%.4f") + " mJ"}}) +
         "<h2>What was modelled</h2>\n" +
         html::facts({{"Voxel size, point spacing", format(1e3 * scene.fidelity.voxel_m, "%g") + " mm, " +
                                                        format(1e3 * scene.fidelity.spacing_m, "%g") + " mm"},
                      {"Points tested", scene.fidelity.sides == Sides::Both
                                            ? "of each part in the other's field (two-sided)"
                                            : "of the moving part in the fixed field (one-sided)"},
                      {"Voxmaps", std::to_string(result.modelled.voxmaps)},
                      {"Pointshells", std::to_string(result.modelled.pointshells)},
                      {"Points", std::to_string(result.modelled.points)},
                      {"Memory", format(megabytes, "%.1f") + " MB"}}) +
         "<h2>Method and assumptions</h2>\n<ul>\n"
         "<li>Parts are rigid and have the shape of their triangle meshes, which deviate from curved faces "
         "by up "
         "to the deflection of the tessellation.</li>\n"
         "<li>Overlap is measured as the exact distance between those meshes, during the step and the rest "
         "after "
         "it. The limit is 10 µm or a quarter of the fit's clearance, whichever is less. Parts overlap as "
         "drawn if one reaches into the other by more than the error of their meshes plus 0.5 µm.</li>\n" +
         handText(scene) + "<li>The device is " +
         escapeHtml(scene.device.kind == "dual_arm" ? "the simulated dual arm" : scene.device.kind) +
         ", at " + format(scene.device.scale, "%g") +
         " scene metres per device metre; its parameters without a source are marked "
         "<i>assumed</i> in its data file.</li>\n"
         "<li>Friction, density and stiffness of each material are from the scene file, or the default "
         "(steel, "
         "Coulomb friction " +
         format(Material().friction, "%.2f") + ", <i>assumed</i>).</li>\n</ul>\n";
}

/// Each try with its seed, and the share that succeeded. Empty for a single run.
std::string tryTable(const scenes::AssembleResult& result) {
  if (result.tries.empty()) return {};
  std::vector<std::vector<html::Cell>> rows;
  for (const scenes::TryResult& one : result.tries)
    rows.push_back({{std::to_string(one.seed), "n"},
                    {words(one.verdict), ""},
                    {format(one.simulated_s, "%.1f"), "n"},
                    {escapeHtml(one.reason), ""}});
  return "<h2>Tries</h2>\n<p>" + escapeHtml(easeWords(result)) +
         " This report shows the first try that fits, or the first try if none fits.</p>\n" +
         html::table({"seed of the hand", "verdict", "time [s]", "why"}, rows);
}

std::string noteParagraph(const std::string& text) {
  return "<p class=\"note\">" + escapeHtml(text) + "</p>\n";
}

/// The reasons of failed steps, and what else a reader must know of a step.
std::string stepNotes(const scenes::AssembleResult& result) {
  std::string out;
  const auto note = [&out](const std::string& text) { out += noteParagraph(text); };
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const scenes::StepResult& step = result.steps[i];
    const std::string name = "Step " + std::to_string(i + 1) + ", " + step.part + ": ";
    if (!step.reason.empty()) note(name + step.reason + ".");
    if (step.completed && !step.by_contact && !step.is_taken_off)
      note(name + "by contact: " + contactWords(step) + ".");
    if (step.moved_m > 0) note(name + movedWords(step) + ".");
    if (!step.aligned_by.empty())
      note(name + "the part lies within its tolerance; later steps use it at its exact target, since '" +
           step.aligned_by + "' aligns it.");
  }
  if (const std::string put = putAtTargetWords(result); !put.empty()) note(put + ".");
  return out;
}

/// The answer, with the reasons for failed steps and for missing parts of the report.
std::string summary(const scenes::AssembleResult& result, const std::vector<std::string>& notes) {
  std::string out = headline(result) + stepNotes(result);
  for (const std::string& text : notes) out += noteParagraph(text);
  return out + tryTable(result);
}

/// The settings of the run, from the scene file and the command line. Reports are sent by mail, so files are
/// named without their folders.
std::string exactSettings(const scenes::Scene& scene) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  for (const scenes::ScenePart& part : scene.parts) files.push_back(fs::path(part.file).filename().string());
  std::string text = scenes::sceneText(scene, files, "as it was run");
  if (const fs::path data = scene.device.data; !data.empty()) {
    const std::string in_full = scenes::tomlText(fs::absolute(data).string());
    if (const std::size_t at = text.find(in_full); at != std::string::npos)
      text.replace(at, in_full.size(), scenes::tomlText(data.filename().string()));
  }
  return "<details><summary>Exact settings of this run, as a scene file</summary>\n<pre id=\"settings\">" +
         escapeHtml(text) + "</pre></details>\n";
}

std::string howToRepeat(const scenes::Scene& scene, const std::string& command) {
  std::string out = "<h2>How to repeat this run</h2>\n";
  if (!command.empty()) out += "<pre>" + escapeHtml(command) + "</pre>\n";
  return out +
         "<p>The same command gives the same numbers, bit for bit, except for the run times above. "
         "<a href=\"trace.csv\">trace.csv</a> has the samples.</p>\n" +
         exactSettings(scene);
}

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw LoadError(folder, "", "cannot be made: " + error.message() + "; choose another folder");
}

}  // namespace

std::string unfinishedPage(const scenes::Scene& scene, const scenes::AssembleResult& so_far) {
  constexpr int kReload_s = 5;
  const std::string name = !so_far.scene.empty() ? so_far.scene : scene.name;
  const auto is_good = [](const scenes::StepResult& step) { return scenes::isGood(step); };
  const auto good = static_cast<std::size_t>(std::ranges::count_if(so_far.steps, is_good));
  return html::pageStart(name + ", unfinished", {}, kReload_s) + "<h1>" + escapeHtml(name) +
         "</h1>\n<p class=\"verdict unsure\">" + std::to_string(so_far.steps.size()) + " of " +
         std::to_string(scene.steps.size()) + " steps are finished; " + std::to_string(good) +
         " of them fit.</p>\n<p class=\"quiet\">The run goes on, or was stopped. This page is written after "
         "each step.</p>\n" +
         stepTable(so_far, false) + stepNotes(so_far) + html::kPageEnd;
}

ReportOutcome writeReport(const scenes::Scene& scene, const scenes::AssembleResult& result,
                          const std::string& dir, const ReportOptions& options) {
  ReportOutcome outcome;
  outcome.file = dir + "/report.html";
  makeFolder(options.has_pictures ? dir + "/pictures" : dir);
  writeTraceCsv(thinned(result.trace, scene.record.csv_rate_hz), dir + "/trace.csv");
  const StoppableWork work(options.progress, "plots");
  const std::vector<WrittenPlot> plots = writePlots(result, dir, outcome.notes);
  const ReportPictures pictures = drawPictures(scene, result, dir, options);
  if (!pictures.failure_reason.empty()) outcome.notes.push_back("No pictures: " + pictures.failure_reason);
  const RunView view = options.has_pictures ? runView(scene, result) : RunView();
  if (!view.missing.empty()) outcome.notes.push_back("No three-dimensional view: " + view.missing);
  if (options.progress) options.progress("report", 1);

  const std::string name = !result.scene.empty() ? result.scene : scene.name;
  const std::string hand = isHandSimulated(scene) ? "a simulated hand" : "a person";
  const std::string what = isDisassembly(result)
                               ? "a disassembly run: " + hand + " takes each part off, the last one first"
                               : "an assembly run: " + hand + " moves each part to its target by contact";
  std::string body = "<h1>" + escapeHtml(name) + "</h1>\n<p class=\"quiet\">Report of " + what + ".</p>\n" +
                     summary(result, outcome.notes);
  body += view.html;
  if (!pictures.overview.empty())
    body += "<div class=\"pictures two\">\n" + html::figure(pictures.overview, "The assembly.") +
            html::figure(pictures.section, "The assembly in section.") + "</div>\n";
  body += "<h2>Steps</h2>\n" + stepTable(result);
  for (const WrittenPlot& written : plots)
    body += "<h2>" + escapeHtml(written.plot.heading) + "</h2>\n" +
            plotFigure(written.plot.name, written.plot.caption);
  body += "<h2>Step by step</h2>\n";
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    body += stepSection(i, result.steps[i], i < pictures.steps.size() ? pictures.steps[i] : StepPictures(),
                        plots);
  if (result.checked) body += checkTablesOfRun(*result.checked);
  body += ergonomicsSection(scene, result) + method(scene, result) + performance(result) +
          howToRepeat(scene, options.command);
  writeWholeFile(outcome.file, html::page(name + ": assembly report", body, dir));
  return outcome;
}

}  // namespace vps::viewer
