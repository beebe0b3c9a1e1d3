// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report.h"

#include <algorithm>

#include "report/html.h"
#include "report/pictures.h"
#include "vps_viewer/plot.h"
#include "vps_viewer/write_file.h"

namespace vps::viewer {
namespace {

using html::Cell;
using html::format;

std::string micrometres(double length_m, const char* form = "%.2f") {
  return format(1e6 * length_m, form);
}

/// The rows nearest after every 1 / rate_hz.
std::vector<scenes::TraceRow> thinned(const std::vector<scenes::TraceRow>& trace, double rate_hz) {
  std::vector<scenes::TraceRow> rows;
  double next_s = 0;
  for (const scenes::TraceRow& row : trace) {
    // Half a microsecond: times are sums of steps, and their rounding must not drop a row.
    if (row.time_s < next_s - 0.5e-6) continue;
    rows.push_back(row);
    next_s = std::max(next_s + 1 / rate_hz, row.time_s);
  }
  return rows;
}

std::string headline(const scenes::AssembleResult& result) {
  const auto done = std::count_if(result.steps.begin(), result.steps.end(),
                                  [](const scenes::StepResult& s) { return s.completed; });
  const auto good = std::count_if(result.steps.begin(), result.steps.end(),
                                  [](const scenes::StepResult& s) { return scenes::isGood(s); });
  const std::string count = std::to_string(done) + " of " + std::to_string(result.steps.size());
  const bool is_complete = result.completed && done == static_cast<std::ptrdiff_t>(result.steps.size());
  std::string text = is_complete
                         ? "Yes, the parts go together: " + count + " steps completed."
                         : "No, the parts do not go together as planned: " + count + " steps completed.";
  if (good < done)
    text += " In " + std::to_string(done - good) +
            " of them the part went deeper than its limit or did not stay where it was let go.";
  return "<p class=\"verdict " + std::string(is_complete && good == done ? "good" : "bad") + "\">" + text +
         "</p>\n";
}

std::string stepTable(const scenes::AssembleResult& result) {
  std::vector<std::vector<Cell>> rows;
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const scenes::StepResult& s = result.steps[i];
    const std::string number = std::to_string(i + 1);
    rows.push_back({{number, "n"},
                    {"<a href=\"#step-" + number + "\">" + escapeHtml(s.part) + "</a>", ""},
                    {s.completed ? "yes" : "no", s.completed ? "good" : "bad"},
                    {format(s.duration_s, "%.2f"), "n"},
                    {micrometres(s.max_penetration_m), scenes::isWithinLimit(s) ? "n" : "n bad"},
                    {s.penetration_limit_m > 0 ? micrometres(s.penetration_limit_m) : "", "n"},
                    {escapeHtml(s.deepest_against), ""},
                    {format(s.peak_force_N, "%.2f"), "n"},
                    {format(s.peak_torque_Nm, "%.3f"), "n"},
                    {std::to_string(s.impacts), "n"},
                    {std::to_string(s.slides), "n"},
                    {micrometres(s.final_error_m, "%.1f"), "n"},
                    {micrometres(s.rest_drift_m), "n"}});
  }
  return html::table(
      {"#", "part", "in place", "time [s]", "deepest [µm]", "limit [µm]", "against", "peak force [N]",
       "peak torque [N m]", "impacts", "slides", "final error [µm]", "drift at rest [µm]"},
      rows);
}

std::string stepFacts(const scenes::StepResult& s) {
  const Vec3 at_mm = 1e3 * s.deepest_at_W;
  std::string deepest = micrometres(s.max_penetration_m) + " µm";
  if (s.penetration_limit_m > 0)
    deepest += std::string(scenes::isWithinLimit(s) ? " (within" : " (<b class=\"bad\">beyond</b>") +
               " the limit of " + micrometres(s.penetration_limit_m) + " µm)";
  if (s.max_penetration_m > 0) {
    if (!s.deepest_against.empty()) deepest += " against " + escapeHtml(s.deepest_against);
    deepest += ", at (" + format(at_mm.x(), "%.2f") + ", " + format(at_mm.y(), "%.2f") + ", " +
               format(at_mm.z(), "%.2f") + ") mm, " + format(s.deepest_time_s, "%.3f") + " s";
  }
  return html::facts(
      {{"In place", s.completed ? "yes" : "<b class=\"bad\">no</b>: " + escapeHtml(s.failure_reason)},
       {"Time", format(s.duration_s, "%.3f") + " s, from " + format(s.start_s, "%.3f") + " s on"},
       {"Deepest overlap, by exact distance", deepest},
       {"The same by the voxmap", micrometres(s.field_penetration_m) + " µm"},
       {"Peak force, torque on the hand",
        format(s.peak_force_N, "%.2f") + " N, " + format(s.peak_torque_Nm, "%.3f") + " N m"},
       {"Impacts, slides", std::to_string(s.impacts) + ", " + std::to_string(s.slides)},
       {"Taken anew on the way, where the device's workspace ends", std::to_string(s.index_count)},
       {"Final error",
        micrometres(s.final_error_m, "%.2f") + " µm, " + format(1e3 * s.final_error_rad, "%.3f") + " mrad"},
       {"Greatest motion in the " + format(s.rest_s, "%.1f") + " s after letting go",
        micrometres(s.rest_drift_m) + " µm"}});
}

std::string plotFigure(const std::string& name, const std::string& caption) {
  return html::figure("plots/" + name + ".png", caption + " (<a href=\"plots/" + name + ".svg\">SVG</a>)",
                      "plots/" + name + ".svg");
}

std::string stepSection(std::size_t i, const scenes::StepResult& step, const StepPictures& pictures,
                        bool has_plot) {
  const std::string number = std::to_string(i + 1);
  std::string out = "<h3 id=\"step-" + number + "\">" + number + ". " + escapeHtml(step.part) + "</h3>\n";
  if (!pictures.start.empty() || !pictures.contact.empty() || !pictures.end.empty()) {
    out += "<div class=\"pictures\">\n";
    if (!pictures.start.empty()) out += html::figure(pictures.start, "Start; the target in transparency.");
    if (!pictures.contact.empty()) out += html::figure(pictures.contact, "In contact, cut open.");
    if (!pictures.end.empty()) out += html::figure(pictures.end, "End, cut open.");
    out += "</div>\n";
  }
  out += stepFacts(step);
  if (has_plot) out += plotFigure("step_" + number, "Force and torque on the hand during this step.");
  return out;
}

/// What a run by the clock gave up to hold its rate.
std::string load_changes(const scenes::AssembleResult& result) {
  if (!result.real_time) return "";
  const std::vector<scenes::LoadLevelChange>& changes = result.real_time->load_changes;
  const std::string behind = format(result.real_time->behind_s, "%.2f") +
                             " s of the clock's time had no step of "
                             "physics";
  if (changes.empty()) return "<p>" + behind + "; nothing was given up to hold the rate.</p>\n";
  std::vector<std::vector<Cell>> rows;
  for (const scenes::LoadLevelChange& change : changes)
    rows.push_back({{format(change.time_s, "%.2f"), "n"},
                    {escapeHtml((change.is_done ? "" : "not done: ") + change.is), ""},
                    {escapeHtml(change.why), ""},
                    {escapeHtml(scenes::inWords(change)), ""}});
  return "<p>" + behind + ". This is what was given up to hold the rate, and taken back:</p>\n" +
         html::table({"at [s]", "from then on", "why", "what it costs"}, rows);
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
  return "<h2 id=\"performance\">Time it took</h2>\n<p class=\"quiet\">Measured by the wall clock on the "
         "machine of this run; "
         "this section differs from run to run, all others repeat.</p>\n<div data-wall-clock>\n" +
         html::table({"loop", "rate [Hz]", "period [µs]", "ticks", "median [µs]", "99 % [µs]", "99.9 % [µs]",
                      "longest [µs]", "longer than a period"},
                     {row("haptic", result.haptic_rate_hz, result.haptic),
                      row("physics", result.physics_rate_hz, result.physics)}) +
         "<p>Models were built in " + format(result.build_wall_s, "%.2f") + " s, fixed parts cooked in " +
         format(cook_s, "%.2f") + " s; the run of " + format(result.simulated_s, "%.2f") + " s took " +
         format(result.run_wall_s, "%.2f") + " s.</p>\n" + load_changes(result) + "</div>\n";
}

std::string method(const scenes::Scene& scene, const scenes::AssembleResult& result) {
  const double megabytes = static_cast<double>(result.modelled.bytes) / 1e6;
  return "<h2>Energy</h2>\n" +
         html::facts({{"Work done on the hand", format(1e3 * result.energy.to_hand_J, "%.3f") + " mJ"},
                      {"Work done by the hand", format(1e3 * result.energy.from_hand_J, "%.3f") + " mJ"},
                      {"Injected (the greatest that the hand got and nothing had stored)",
                       format(1e3 * result.energy.injected_J, "%.4f") + " mJ"}}) +
         "<h2>What was modelled</h2>\n" +
         html::facts(
             {{"Voxel size, point spacing", format(1e3 * scene.fidelity.voxel_m, "%g") + " mm, " +
                                                format(1e3 * scene.fidelity.spacing_m, "%g") + " mm"},
              {"Points tested", scene.fidelity.sides == Sides::Both ? "each part's against the other"
                                                                    : "the moving part's against the fixed"},
              {"Voxmaps", std::to_string(result.modelled.voxmaps)},
              {"Pointshells", std::to_string(result.modelled.pointshells)},
              {"Points", std::to_string(result.modelled.points)},
              {"Memory", format(megabytes, "%.1f") + " MB"}}) +
         "<h2>What this rests on</h2>\n<ul>\n"
         "<li>Parts are rigid, with the shape of their triangle meshes; a chord of a curved face lies inside "
         "it by the "
         "deflection it was tessellated with.</li>\n"
         "<li>Overlap is the exact distance between those meshes, over the step and the rest after it. The "
         "limit is "
         "10 µm or a quarter of the fit's clearance, whichever is less.</li>\n"
         "<li>The hand is a model (<i>assumed</i>): it aims with a standard deviation of " +
         micrometres(scene.hand.aim_error_m, "%.0f") + " µm and " +
         format(1e3 * scene.hand.aim_error_rad, "%.1f") + " mrad, moves at " +
         format(1e3 * scene.hand.speed_m_s, "%.0f") + " mm/s, presses home with " +
         format(scene.hand.press_N, "%.1f") + " N and backs off above " +
         format(scene.hand.force_limit_N, "%.1f") + " N. Seed " + std::to_string(scene.hand.seed) +
         ".</li>\n"
         "<li>The device is " +
         escapeHtml(scene.device.kind == "dual_arm" ? "the simulated dual arm" : scene.device.kind) +
         ", at " + format(scene.device.scale, "%g") +
         " scene metres per device metre; its parameters that no source gives are marked "
         "<i>assumed</i> in its data file.</li>\n"
         "<li>Friction, density and stiffness of each material are the scene file's or the default (steel, "
         "Coulomb "
         "friction " +
         format(Material().friction, "%.2f") + ", <i>assumed</i>).</li>\n</ul>\n";
}

}  // namespace

ReportOutcome writeReport(const scenes::Scene& scene, const scenes::AssembleResult& result,
                          const std::string& dir, const ReportOptions& options) {
  ReportOutcome outcome;
  outcome.file = dir + "/report.html";
  writeTraceCsv(thinned(result.trace, scene.record.csv_rate_hz), dir + "/trace.csv");

  std::vector<std::string> step_names;
  for (const scenes::StepResult& step : result.steps) step_names.push_back(step.part);
  if (options.progress) options.progress("plots", 0);
  const PlotOutcome forces = plotForces(result.trace, dir + "/plots/forces", step_names);
  std::vector<bool> has_plot(result.steps.size(), false);
  for (std::size_t i = 0; forces && result.steps.size() > 1 && i < result.steps.size(); ++i)
    has_plot[i] = static_cast<bool>(plotForces(result.trace, dir + "/plots/step_" + std::to_string(i + 1),
                                               step_names, static_cast<int>(i)));
  if (!forces) outcome.notes.push_back("No plots: " + forces.failure_reason);
  const ReportPictures pictures = drawPictures(scene, result, dir, options);
  if (!pictures.failure_reason.empty()) outcome.notes.push_back("No pictures: " + pictures.failure_reason);
  if (options.progress) options.progress("report", 1);

  const std::string name = !result.scene.empty() ? result.scene : scene.name;
  std::string body = "<h1>" + escapeHtml(name) +
                     "</h1>\n<p class=\"quiet\">Report of an assembly run: each part is moved "
                     "to its place by contact, as a hand would do it.</p>\n" +
                     headline(result);
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    if (!result.steps[i].completed)
      body += "<p class=\"note\">Step " + std::to_string(i + 1) + ", " + escapeHtml(result.steps[i].part) +
              ": " +
              escapeHtml(result.steps[i].failure_reason.empty() ? "not completed"
                                                                : result.steps[i].failure_reason) +
              "</p>\n";
  for (const std::string& note : outcome.notes) body += "<p class=\"note\">" + escapeHtml(note) + "</p>\n";
  if (!pictures.overview.empty())
    body += "<div class=\"pictures two\">\n" + html::figure(pictures.overview, "The assembly.") +
            html::figure(pictures.section, "The same, cut open.") + "</div>\n";
  body += "<h2>Steps</h2>\n" + stepTable(result);
  if (forces)
    body += "<h2>Forces on the hand</h2>\n" +
            plotFigure("forces", "Force, torque and contact depth over the run.");
  body += "<h2>Step by step</h2>\n";
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    body += stepSection(i, result.steps[i], i < pictures.steps.size() ? pictures.steps[i] : StepPictures(),
                        has_plot[i]);
  body += method(scene, result) + performance(result);
  body += "<h2>To repeat this</h2>\n";
  if (!options.command.empty()) body += "<pre>" + escapeHtml(options.command) + "</pre>\n";
  body +=
      "<p>The same command gives the same numbers, bit for bit, but for the times above. Every sample stands "
      "in "
      "<a href=\"trace.csv\">trace.csv</a>.</p>\n";
  writeFileAtomically(outcome.file, html::page(name + ": assembly report", body));
  return outcome;
}

}  // namespace vps::viewer
