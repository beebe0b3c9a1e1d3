// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/pages.h"

#include <vector>

#include "files/html.h"
#include "pages/svg.h"

namespace vps::viewer {

namespace {

using html::format;

std::string nameOf(const scenes::StepMargin& step) {
  return std::to_string(step.step + 1).append(". ").append(step.part);
}

std::string colorOf(const scenes::StepMargin& step) {
  return step.goes ? "#3b6ea5" : "#b00020";
}

/// The words of a step that fails as drawn.
std::string notGoingWords(const scenes::StepMargin& step) {
  return step.fails_as == scenes::Verdict::Blocked ? "does not go in as drawn"
                                                   : "not shown to go in as drawn";
}

std::string growthChart(const scenes::MarginResult& result) {
  std::vector<Bar> bars;
  for (const scenes::StepMargin& step : result.steps)
    bars.push_back({nameOf(step), step.growth_m,
                    !step.goes            ? notGoingWords(step)
                    : step.growth_fails_m ? micrometres(step.growth_m) + " µm"
                                          : "more than " + micrometres(step.growth_m) + " µm",
                    colorOf(step)});
  return barChart(bars,
                  "Greatest growth of every face of the step's part with which the part still goes in.");
}

std::string positionChart(const scenes::MarginResult& result) {
  std::vector<Bar> bars;
  for (const scenes::StepMargin& step : result.steps)
    if (step.position_m)
      bars.push_back({nameOf(step), *step.position_m, micrometres(*step.position_m) + " µm", colorOf(step)});
  if (bars.empty()) return {};
  return barChart(bars, "Displacement across the path before the part touches at its target.");
}

std::string angleChart(const scenes::MarginResult& result) {
  std::vector<Bar> bars;
  for (const scenes::StepMargin& step : result.steps)
    if (step.angle_rad)
      bars.push_back(
          {nameOf(step), *step.angle_rad, format(1e3 * *step.angle_rad, "%.2f mrad"), colorOf(step)});
  if (bars.empty()) return {};
  return barChart(bars, "Rotation about an axis across the path before the part touches at its target.");
}

std::string stepTable(const scenes::MarginResult& result) {
  std::vector<std::vector<html::Cell>> rows;
  for (const scenes::StepMargin& step : result.steps)
    rows.push_back({{escapeHtml(nameOf(step)), ""},
                    {micrometres(step.growth_m), step.goes ? "n" : "n bad"},
                    {step.growth_fails_m ? micrometres(*step.growth_fails_m) : "", "n"},
                    {micrometres(step.growth_bound_m), "n"},
                    {escapeHtml(step.fails_why), ""},
                    {step.position_m ? micrometres(*step.position_m) : "", "n"},
                    {step.angle_rad ? format(1e3 * *step.angle_rad, "%.2f") : "", "n"}});
  return html::table({"step", "goes with [µm]", "fails with [µm]", "geometry allows [µm]", "why it fails",
                      "position [µm]", "angle [mrad]"},
                     rows);
}

std::string answer(const scenes::MarginResult& result) {
  if (result.steps.empty()) return "<p class=\"verdict unsure\">No step was measured.</p>\n";
  const scenes::StepMargin& worst = result.steps.front();
  if (!worst.goes)
    return worst.fails_as == scenes::Verdict::Blocked
               ? "<p class=\"verdict bad\">As drawn, " + escapeHtml(worst.part) +
                     " does not go in: " + escapeHtml(worst.fails_why) + "</p>\n"
               : "<p class=\"verdict unsure\">It is not shown that " + escapeHtml(worst.part) +
                     " goes in as drawn: " + escapeHtml(worst.fails_why) + "</p>\n";
  return "<p class=\"verdict good\">The tightest step is " + escapeHtml(worst.part) +
         ": every face may grow by " + micrometres(worst.growth_m) + " µm.</p>\n";
}

}  // namespace

std::string marginPage(const scenes::MarginResult& result) {
  return html::page(
      "Margins of " + result.scene,
      "<h1>Margins of " + escapeHtml(result.scene) + "</h1>\n" + answer(result) +
          "<p>The part of each step was made larger by moving all its faces outwards, while the other parts "
          "stayed as drawn. A diameter grows by twice the number. " +
          (result.has_contact
               ? "The growth is the greatest with which the virtual operator still brought the part to its "
                 "target, with one seed; by geometry alone the growth may be larger."
               : "The growth is by geometry alone, without a run of the hand: an upper bound.") +
          " Resolution " + micrometres(result.resolution_m) +
          " µm. Position and angle are measured with the part lifted off its seat by a hundredth of its "
          "size.</p>\n" +
          growthChart(result) + positionChart(result) + angleChart(result) + stepTable(result));
}

}  // namespace vps::viewer
