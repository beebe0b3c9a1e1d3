// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/pages.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "files/html.h"
#include "pages/svg.h"
#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps/write_file.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {

namespace {

using html::format;

constexpr std::array kAxisNames = {"x [mm]", "y [mm]", "z [mm]"};

/// The two axes with the greatest extents of both paths, in ascending order of axis.
std::pair<int, int> widestAxes(const scenes::ComparedStep& step) {
  Box box;
  for (const auto* samples : {&step.expert_samples, &step.trainee_samples})
    for (const scenes::HandSample& sample : *samples) box.add(sample.X_WG.p);
  int least = 0;
  for (int i = 1; i < 3; ++i)
    if (box.size()[i] < box.size()[least]) least = i;
  return {least == 0 ? 1 : 0, least == 2 ? 1 : 2};
}

Series pathSeries(const char* name, const std::vector<scenes::HandSample>& samples,
                  std::pair<int, int> axes) {
  Series series{name, {}};
  for (const scenes::HandSample& sample : samples)
    series.points.emplace_back(1e3 * sample.X_WG.p[axes.first], 1e3 * sample.X_WG.p[axes.second]);
  return series;
}

Series forceSeries(const char* name, const std::vector<scenes::HandSample>& samples) {
  Series series{name, {}};
  for (const scenes::HandSample& sample : samples) series.points.emplace_back(sample.time_s, sample.force_N);
  return series;
}

PlotOutcome drawPath(const scenes::ComparedStep& step, const std::string& file) {
  const auto axes = widestAxes(step);
  Plot plot{step.part,
            kAxisNames.at(static_cast<std::size_t>(axes.first)),
            kAxisNames.at(static_cast<std::size_t>(axes.second)),
            {}};
  plot.series = {pathSeries("expert", step.expert_samples, axes),
                 pathSeries("trainee", step.trainee_samples, axes)};
  return plotSeries(plot, file);
}

PlotOutcome drawForce(const scenes::ComparedStep& step, const std::string& file) {
  Plot plot{step.part, "time in hand [s]", "force on the hand [N]", {}};
  plot.series = {forceSeries("expert", step.expert_samples), forceSeries("trainee", step.trainee_samples)};
  return plotSeries(plot, file);
}

std::string stepTable(const scenes::RunComparison& result) {
  std::vector<std::vector<html::Cell>> rows;
  const auto both = [](double expert, double trainee, const char* form) {
    return html::Cell{format(expert, form) + " / " + format(trainee, form), "n"};
  };
  for (const scenes::ComparedStep& s : result.steps)
    rows.push_back({{escapeHtml(s.part), ""},
                    {s.is_done ? format(s.score, "%.0f") : "not done", s.is_done ? "n" : "n bad"},
                    both(s.expert.duration_s, s.trainee.duration_s, "%.2f"),
                    both(1e3 * s.expert.path_m, 1e3 * s.trainee.path_m, "%.1f"),
                    {format(1e3 * s.deviation_m, "%.2f"), "n"},
                    {format(1e3 * s.mean_deviation_m, "%.2f"), "n"},
                    {format(57.2957795 * s.deviation_rad, "%.2f"), "n"},
                    both(s.expert.peak_force_N, s.trainee.peak_force_N, "%.2f"),
                    both(s.expert.mean_force_N, s.trainee.mean_force_N, "%.2f")});
  return html::table({"part", "score", "time [s]", "path [mm]", "farthest from the expert's path [mm]",
                      "mean distance from that path [mm]", "rotated against the expert's pose [degrees]",
                      "peak force [N]", "mean force [N]"},
                     rows);
}

std::string scoreChart(const scenes::RunComparison& result) {
  std::vector<Bar> bars;
  for (const scenes::ComparedStep& step : result.steps)
    bars.push_back({step.part, step.score, step.is_done ? format(step.score, "%.0f") : "not done",
                    step.is_done ? "#3b6ea5" : "#b00020"});
  return barChart(bars, "Score of each step; 100: as quick, as short and as gentle as the expert.");
}

/// The figures of a step. Draws the plots and adds a note if gnuplot fails.
std::string figures(const scenes::ComparedStep& step, std::size_t number, const std::string& dir,
                    std::vector<std::string>& notes) {
  const std::string end = "_" + std::to_string(number);
  const auto figure = [&](const std::string& name, const PlotOutcome& outcome, const std::string& caption) {
    if (outcome) return html::figure("plots/" + name + ".png", caption, "plots/" + name + ".svg");
    const std::string note = "No plots: " + outcome.failure_reason;
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
    return std::string();
  };
  const std::string path = "path" + end, force = "force" + end;
  return "<h3>" + escapeHtml(step.part) + "</h3>\n<div class=\"pictures two\">\n" +
         figure(path, drawPath(step, dir + "/plots/" + path), "Path of the part's centre of mass.") +
         figure(force, drawForce(step, dir + "/plots/" + force), "Force on the hand.") + "</div>\n";
}

}  // namespace

std::vector<std::string> writeComparePage(const scenes::RunComparison& result, const std::string& dir) {
  std::error_code error;
  std::filesystem::create_directories(dir + "/plots", error);
  if (error) throw LoadError(dir, "", "cannot be written: " + error.message() + "; choose another folder");
  std::vector<std::string> notes = result.notes;
  std::string steps;
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    if (!result.steps[i].trainee_samples.empty()) steps += figures(result.steps[i], i + 1, dir, notes);
  std::string body = "<h1>Training</h1>\n<p class=\"verdict\">Score " + format(result.score, "%.0f") +
                     " of 100.</p>\n<p>" + escapeHtml(result.trainee) + " against the expert's " +
                     escapeHtml(result.expert) + ".</p>\n";
  for (const std::string& note : notes) body += "<p class=\"note\">" + escapeHtml(note) + "</p>\n";
  body +=
      scoreChart(result) + "<h2>Steps</h2>\n" + stepTable(result) +
      "<p class=\"quiet\">Where a cell has two numbers, the expert's comes first. The score of a step is "
      "the mean of three shares with equal weights (<i>assumed</i>): time, path and peak force, each the "
      "expert's value divided by the trainee's and at most 1; a force below 1 N counts as 1 N. A step that "
      "is not done has no score. Motions of less than half a millimetre are not counted as path.</p>\n" +
      steps;
  writeWholeFile(dir + "/compare.html", html::page("Training", body, dir));
  return notes;
}

}  // namespace vps::viewer
