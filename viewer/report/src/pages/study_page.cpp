// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/pages.h"

#include <algorithm>
#include <map>
#include <vector>

#include "files/html.h"
#include "pages/svg.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

using html::format;

constexpr std::size_t kColumns = 30;
// End of the axis, in half tolerances; a normally distributed deviation may exceed 1.
constexpr double kBeyond = 1.2;

std::string percent(double share) {
  return format(100 * share, "%.2f %%");
}

std::string yieldSentence(const scenes::StudyResult& result) {
  return std::to_string(result.good) + " of " + std::to_string(result.runs.size()) + " runs fit: yield " +
         percent(result.yield) + ", with 95 % confidence between " + percent(result.yield_low) + " and " +
         percent(result.yield_high) + ".";
}

std::string gainChart(const scenes::StudyResult& result) {
  std::vector<Bar> bars;
  for (const scenes::StudyEffect& effect : result.effects)
    bars.push_back({effect.variable.name, std::max(0.0, effect.gain),
                    format(100 * effect.gain, "%+.2f") + format(100 * effect.gain_error, " ± %.2f points")});
  return barChart(bars,
                  "Change of the yield if this tolerance alone were half as wide, in percentage points, "
                  "estimated from the same runs; ± is the 95 % confidence interval.");
}

std::string effectTable(const scenes::StudyResult& result) {
  std::vector<std::vector<html::Cell>> rows;
  for (const scenes::StudyEffect& effect : result.effects)
    rows.push_back({{escapeHtml(effect.variable.name), ""},
                    {toText(effect.variable.distribution), ""},
                    {deviationText(effect.variable, effect.variable.lower), "n"},
                    {deviationText(effect.variable, effect.variable.upper), "n"},
                    {percent(effect.yield_if_halved), "n"},
                    {format(100 * effect.gain, "%+.2f"), "n"},
                    {format(100 * effect.gain_error, "%.2f"), "n"}});
  return html::table({"tolerance", "distribution", "lower", "upper", "yield if halved", "gain [points]", "±"},
                     rows);
}

std::string histogramOf(const scenes::StudyResult& result, const scenes::StudyEffect& effect) {
  const scenes::StudyVariable& variable = effect.variable;
  const double half = kBeyond * 0.5 * (variable.upper - variable.lower);
  const double low = variable.middle() - half, width = 2 * half / kColumns;
  std::vector<Column> columns(kColumns);
  for (const scenes::StudyRun& run : result.runs) {
    const double at = (run.values[effect.index] - low) / width;
    Column& column = columns[static_cast<std::size_t>(std::clamp(at, 0.0, kColumns - 1.0))];
    (run.verdict == scenes::Verdict::Fits ? column.lower : column.upper) += 1;
  }
  return histogram(columns, deviationText(variable, low), deviationText(variable, low + 2 * half),
                   escapeHtml(variable.name) + ": runs that fit (green) and runs that do not fit (red).");
}

std::string reasons(const scenes::StudyResult& result) {
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  for (const scenes::StudyRun& run : result.runs)
    if (run.verdict != scenes::Verdict::Fits) ++counts[{run.part, words(run.verdict)}];
  if (counts.empty()) return {};
  std::vector<std::vector<html::Cell>> rows;
  for (const auto& [of, count] : counts)
    rows.push_back({{escapeHtml(of.first), ""}, {of.second, ""}, {std::to_string(count), "n"}});
  return "<h2>Runs that do not fit</h2>\n" + html::table({"part", "verdict", "runs"}, rows);
}

}  // namespace

std::string deviationText(const scenes::StudyVariable& variable, double value) {
  using scenes::StudyQuantity;
  if (variable.quantity == StudyQuantity::Friction) return format(value, "%+.3f");
  if (variable.quantity >= StudyQuantity::AboutX) return format(1e3 * value, "%+.3f mrad");
  return format(1e6 * value, "%+.2f µm");
}

std::string studyPage(const scenes::StudyResult& result) {
  std::string body = "<h1>Study of " + escapeHtml(result.scene) + "</h1>\n<p class=\"verdict " +
                     (result.good == result.runs.size() ? "good" : "unsure") + "\">" + yieldSentence(result) +
                     "</p>\n<p>";
  body += result.settings.has_contact
              ? "Each run draws all deviations and a seed of the hand. Runs that exact distances "
                "rule out are blocked; runs whose parts overlap as drawn, without places near by and without "
                "a proof, are not shown; all others are assembled by contact."
              : "Each run draws all deviations and is judged by exact distances alone, without the hand.";
  body += " The interval is Wilson's. Sizes are deviations of diameter or width from the drawing.</p>\n";
  body += "<h2>Loss of yield by tolerance</h2>\n" + gainChart(result) + effectTable(result);
  body += reasons(result);
  body += "<h2>Deviations</h2>\n";
  for (const scenes::StudyEffect& effect : result.effects) body += histogramOf(result, effect);
  return html::page("Study of " + result.scene, body);
}

}  // namespace vps::viewer
