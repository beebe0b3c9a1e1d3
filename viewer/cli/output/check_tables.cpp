// SPDX-License-Identifier: BSD-3-Clause
#include "output/reports.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "output/field_table.h"
#include "output/table.h"
#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_viewer/report/asked_words.h"
#include "vps_viewer/report/csv.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

using scenes::counted;
using scenes::lengthInWords;
using scenes::PairState;

std::string pairTable(const scenes::CheckResult& result) {
  const bool has_overlap = std::ranges::any_of(
      result.pairs, [](const scenes::CheckedPair& pair) { return pair.interference_depth_m > 0; });
  std::string out = fieldTable(result.pairs, scenes::kCheckedPairFields) +
                    (has_overlap ? std::string(kOverlapMeaning) + "\n" : "");
  for (const std::string& note : knownNotes(result)) out += note + "\n";
  return out;
}

std::string pressTable(const scenes::CheckResult& result) {
  Table table({"<pressed in", "<of", "<in", "drawn [um]", "declared [um]", "hub [mm]", "hole [mm]",
               "pressure [MPa]", "stress [MPa]", "force [N]", "declared [N]"});
  for (const scenes::CheckedFit& fit : result.fits) {
    if (!fit.press) continue;
    const scenes::CheckedPress& press = *fit.press;
    const auto pair = std::ranges::find_if(result.pairs, [&](const scenes::CheckedPair& p) {
      return (p.a == fit.shaft && p.b == fit.bore) || (p.b == fit.shaft && p.a == fit.bore);
    });
    table.add({toText(fit.kind), fit.shaft, fit.bore, um(-fit.diametral_clearance_m), um(pair->press_fit_m),
               std::isfinite(press.hub_m) ? fixed(1e3 * press.hub_m, 2) : "endless",
               fixed(1e3 * press.hole_m, 2), fixed(1e-6 * press.pressure_Pa, 1),
               fixed(1e-6 * press.hub_stress_Pa, 0), fixed(press.force_N, 0),
               fixed(press.declared_force_N, 0)});
  }
  return table.text();
}

std::string playCell(const std::array<double, 6>& way, const std::array<double, 6>& error, std::size_t i,
                     double usual, double scale, const char* form) {
  return "+" + playWords(way[i], error[i], usual, scale, form) + " -" +
         playWords(way[i + 1], error[i + 1], usual, scale, form);
}

std::string waysText(const scenes::CheckedPart& part) {
  std::string out;
  if (!part.ways_out_W.empty()) out = std::to_string(part.ways_out_W.size());
  if (!part.screw_ways_out.empty()) out.append(out.empty() ? "by screw" : " and by screw");
  if (out.empty()) out = part.is_play_certain ? "none" : "not known";
  return part.is_play_certain ? out : out + " ~";
}

std::string partTable(const scenes::CheckResult& result) {
  Table table({"<part", "x [um]", "y [um]", "z [um]", "about x [mrad]", "about y", "about z", "<ways out"});
  for (const scenes::CheckedPart& part : result.parts) {
    if (!part.play) {
      table.add({part.name, noPlayWords(part, result)});
      continue;
    }
    std::vector<std::string> cells = {part.name};
    for (std::size_t i = 0; i < 6; i += 2)
      cells.push_back(playCell(part.play->m, part.play->error_m, i, part.play_error_m, 1e6, "%.1f"));
    for (std::size_t i = 0; i < 6; i += 2)
      cells.push_back(playCell(part.play->rad, part.play->error_rad, i, part.play_error_rad, 1e3, "%.2f"));
    cells.push_back(waysText(part));
    table.add(cells);
  }
  std::string text = table.text();
  for (const scenes::CheckedPart& part : result.parts)
    if (const std::string doubt = playDoubt(part, result); !doubt.empty())
      text.append("~ ").append(part.name).append(": ").append(doubt).append("\n");
  return text;
}

}  // namespace

namespace {

/// Lists press fits that are declared but drawn without an overlap.
std::string undrawnPressFits(const scenes::CheckResult& result) {
  std::string out;
  for (const scenes::CheckedPair& pair : result.pairs)
    if (pair.press_fit_m > 0 && pair.state < PairState::PressFit)
      out += pair.a + " and " + pair.b + ": " + lengthInWords(pair.press_fit_m, 2) +
             " of press fit are declared, but the parts are drawn without an overlap\n";
  return out;
}

}  // namespace

std::string checkTables(const scenes::CheckResult& result) {
  std::string out;
  if (!result.rules.empty()) out += fieldTable(result.rules, scenes::kRuleOutcomeFields);
  for (const std::string& note : ruleNotes(result)) out += note + "\n";
  if (!out.empty()) out += "\n";
  if (!result.pairs.empty()) out += pairTable(result) + "\n";
  if (!result.fits.empty()) out += fieldTable(result.fits, scenes::kCheckedFitFields) + "\n";
  const bool is_pressed =
      std::ranges::any_of(result.fits, [](const scenes::CheckedFit& fit) { return fit.press.has_value(); });
  if (is_pressed) out += pressTable(result) + "\n";
  out += undrawnPressFits(result);
  for (const scenes::CheckedPart& part : result.parts)
    if (!part.read_as.empty()) out += part.name + ": " + part.read_as + "\n";
  const bool has_play =
      std::ranges::any_of(result.parts, [](const scenes::CheckedPart& p) { return p.play.has_value(); });
  if (has_play) out += partTable(result) + "\n";
  return out;
}

std::string checkHeadline(const scenes::CheckResult& result) {
  const bool is_chosen = result.isAboutChosenPairs();
  std::string out = result.assembly + ": " + counted(result.parts.size(), "part") + ", " +
                    counted(result.pairs.size(), is_chosen ? "chosen pair" : "pair") + " near each other, ";
  const std::string answer = assemblyWords(result);
  std::string about;
  for (const std::string& words :
       {chosenWords(result), moveWords(result), knownWords(result), ruleWords(result)})
    if (!words.empty()) about += "\n" + words;
  const std::size_t clashes = result.clashes();
  if (clashes == 0)
    return out +
           (answer.empty() ? std::string("no clash deeper than the error of the check") +
                                 (is_chosen ? " among the chosen pairs" : "")
                           : answer) +
           about;
  const scenes::CheckedPair& worst = *result.deepestClash();
  out += counted(clashes, "clash: ", "clashes, the deepest: ") + worst.a + " and " + worst.b + " by " +
         lengthInWords(worst.interference_depth_m, 2) + " (+- " + lengthInWords(worst.error_m, 2) +
         ") as drawn";
  return out + "\n" + answer + about;
}

std::string checkCsv(const scenes::CheckResult& result) {
  std::string out = csvLine({"what", "a", "b", "quantity", "value", "error"});
  const auto add = [&](const std::string& what, const std::string& a, const std::string& b, const auto& of,
                       const auto& fields) {
    for (const CsvNumber& number : csvNumbers(of, fields))
      out += csvLine({number.object.empty() ? what : number.object, a, b, number.quantity,
                      csvNumber(number.value), csvNumber(number.error)});
  };
  for (const scenes::CheckedPair& pair : result.pairs) {
    add("pair", pair.a, pair.b, pair, scenes::kCheckedPairFields);
    // The depth of the overlap, or the squash of a seal, under the name of the state.
    if (pair.isKnown())
      out += csvLine({toText(pair.state), pair.a, pair.b,
                      pair.state == PairState::Seal ? "squash" : "interference_depth_m",
                      csvNumber(pair.state == PairState::Seal ? pair.squash : pair.interference_depth_m),
                      csvNumber(pair.state == PairState::Seal ? 0 : pair.error_m)});
  }
  for (const scenes::CheckedFit& fit : result.fits)
    add(toText(fit.kind), fit.shaft, fit.bore, fit, scenes::kCheckedFitFields);
  for (const scenes::CheckedPart& part : result.parts)
    add("part", part.name, "", part, scenes::kCheckedPartFields);
  for (const scenes::RuleOutcome& outcome : result.rules)
    add("rule " + outcome.rule, outcome.a, outcome.b, outcome, scenes::kRuleOutcomeFields);
  return out;
}

}  // namespace vps::viewer
