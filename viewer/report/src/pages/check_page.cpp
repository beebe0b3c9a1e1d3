// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/pages.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "files/html.h"
#include "pages/field_table.h"
#include "pages/pictures.h"
#include "pages/svg.h"
#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/fits/rules.h"
#include "vps_viewer/report/asked_words.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

using html::Cell;
using html::format;

std::string rules(const scenes::CheckResult& result) {
  if (result.rule_counts.empty()) return "";
  std::string out =
      "<h2>Rules</h2>\n<p>A rule is not decided for a pair where the bound is within the error of the "
      "measured number. A clearance is negative by the depth of an overlap.</p>\n";
  if (!result.rules.empty()) out += fieldTableOnPage(result.rules, scenes::kRuleOutcomeFields);
  for (const std::string& note : ruleNotes(result)) out += "<p>" + escapeHtml(note) + ".</p>\n";
  return out;
}

/// Sentences about what was asked of the check, each in a paragraph.
std::string asked(const scenes::CheckResult& result) {
  std::string out;
  for (std::string words : {chosenWords(result), moveWords(result), knownWords(result), ruleWords(result)}) {
    if (words.empty()) continue;
    words.front() = static_cast<char>(std::toupper(words.front()));
    out += "<p>" + escapeHtml(words) + ".</p>\n";
  }
  return out;
}

/// What was assumed about threads, seals and inserts, each in a line.
std::string known(const scenes::CheckResult& result) {
  std::string out;
  for (const std::string& note : knownNotes(result)) out += "<li>" + escapeHtml(note) + ".</li>\n";
  return out.empty() ? out : "<ul>\n" + out + "</ul>\n";
}

std::string pairs(const scenes::CheckResult& result) {
  return std::string(
             "<h2>Pairs near each other</h2>\n<p>As drawn. Surfaces that touch to within the error are in "
             "contact, which is no clash. The error includes the distance between the meshes and the curved "
             "faces that they approximate; ")
             .append(kOverlapMeaning)
             .append(".</p>\n") +
         fieldTableOnPage(result.pairs, scenes::kCheckedPairFields) + known(result);
}

std::string fits(const scenes::CheckResult& result) {
  return "<h2>Fits</h2>\n<p>Fits are found on the meshes, whose corners lie on the true faces. The sizes of "
         "a thread are its major diameters; its play along the axis measures the clearance of its flanks. "
         "The last column names a common fit of ISO 286 in whose zones both sizes lie, or a thread of ISO "
         "262.</p>\n" +
         fieldTableOnPage(result.fits, scenes::kCheckedFitFields);
}

std::string pressFits(const scenes::CheckResult& result) {
  std::vector<std::vector<Cell>> rows;
  for (const scenes::CheckedFit& fit : result.fits) {
    if (!fit.press) continue;
    const scenes::CheckedPress& press = *fit.press;
    const auto pair = std::ranges::find_if(result.pairs, [&](const scenes::CheckedPair& p) {
      return (p.a == fit.shaft && p.b == fit.bore) || (p.b == fit.shaft && p.a == fit.bore);
    });
    const bool is_clash = pair->isClash();
    rows.push_back(
        {{escapeHtml(fit.shaft), ""},
         {escapeHtml(fit.bore), ""},
         {micrometres(-fit.diametral_clearance_m), is_clash ? "n bad" : "n"},
         {micrometres(pair->press_fit_m), "n"},
         {std::isfinite(press.hub_m) ? format(1e3 * press.hub_m, "%.2f") : "endless", "n"},
         {format(1e3 * press.hole_m, "%.2f"), "n"},
         {format(1e-9 * press.shaft_modulus_Pa, "%.0f") + " / " + format(1e-9 * press.hub_modulus_Pa, "%.0f"),
          "n"},
         {format(press.friction, "%.2f"), "n"},
         {format(1e-6 * press.pressure_Pa, "%.1f"), "n"},
         {format(1e-6 * press.hub_stress_Pa, "%.0f"), "n"},
         {format(press.force_N, "%.0f"), "n"},
         {format(press.declared_force_N, "%.0f"), "n"}});
  }
  if (rows.empty()) return "";
  return "<h2>Press fits</h2>\n<p>The interference as drawn, in diameter, against the declared one. Pressure "
         "and stress follow from Lamé's formula for elastic thick-walled cylinders; the hub is the largest "
         "ring of material around the bore over the middle half of the fit. The force moves the shaft along "
         "the fit's whole length. Young's modulus (210 GPa), Poisson's ratio (0.3: steel, EN 1993-1-1) and "
         "friction (0.15) are assumed where the scene does not state them. Where the stress is above the "
         "material's yield point, the formula does not hold and the force is less.</p>\n" +
         html::table({"inner part", "outer part", "drawn [µm]", "declared [µm]", "hub [mm]", "hole [mm]",
                      "E inner / outer [GPa]", "friction", "pressure [MPa]", "hub stress [MPa]", "force [N]",
                      "force if as declared [N]"},
                     rows);
}

/// The play in both directions along one axis.
std::string both(const std::array<double, 6>& way, const std::array<double, 6>& error, std::size_t i,
                 double usual, double scale, const char* form) {
  return escapeHtml("+" + playWords(way[i], error[i], usual, scale, form) + " / −" +
                    playWords(way[i + 1], error[i + 1], usual, scale, form));
}

std::string coordinates(const Vec3& d) {
  return format(d.x(), "%.2f") + ", " + format(d.y(), "%.2f") + ", " + format(d.z(), "%.2f");
}

std::string play(const scenes::CheckResult& result) {
  std::vector<std::vector<Cell>> rows;
  for (const scenes::CheckedPart& part : result.parts) {
    std::vector<Cell> row = {{escapeHtml(part.name), ""}};
    for (std::size_t i = 0; i < 12; i += 2) {
      const bool is_turn = i >= 6;
      if (!part.play)
        row.push_back({"", "n"});
      else if (is_turn)
        row.push_back(
            {both(part.play->rad, part.play->error_rad, i - 6, part.play_error_rad, 1e3, "%.2f"), "n"});
      else
        row.push_back({both(part.play->m, part.play->error_m, i, part.play_error_m, 1e6, "%.1f"), "n"});
    }
    std::string ways = part.play ? "" : noPlayWords(part, result);
    for (const Vec3& way : part.ways_out_W) ways += (ways.empty() ? "(" : ", (") + coordinates(way) + ")";
    for (const scenes::ScrewWay& way : part.screw_ways_out)
      ways += (ways.empty() ? "by screw along (" : "; by screw along (") + coordinates(way.axis_W) + "), " +
              format(1e3 * std::abs(way.lead_m), "%.3f") + " mm a turn";
    if (ways.empty()) ways = part.is_play_certain ? "none" : "not known";
    if (const std::string doubt = playDoubt(part, result); !doubt.empty()) ways += "; " + escapeHtml(doubt);
    row.push_back({ways, ""});
    rows.push_back(row);
  }
  return "<h2>Play</h2>\n<p>How far each part moves along and turns about its axes before it touches, with "
         "the other parts fixed; free: the part moves away, or makes a whole turn. Ways out are directions "
         "in which the part leaves on a straight line, or axes about which it leaves by a screw "
         "motion.</p>\n" +
         html::table({"part", "x [µm]", "y [µm]", "z [µm]", "about x [mrad]", "about y [mrad]",
                      "about z [mrad]", "ways out"},
                     rows);
}

std::string meshes(const scenes::CheckResult& result) {
  std::vector<std::vector<Cell>> rows;
  for (const scenes::CheckedPart& part : result.parts)
    rows.push_back({{escapeHtml(part.name), ""},
                    {std::to_string(part.triangles), "n"},
                    {micrometres(part.chord_error_m), "n"},
                    {escapeHtml(part.mesh_faults), ""},
                    {escapeHtml(part.no_inside), part.no_inside.empty() ? "" : "bad"}});
  std::string read;
  for (const scenes::CheckedPart& part : result.parts)
    if (!part.read_as.empty()) read += "<p>" + escapeHtml(part.name + ": " + part.read_as) + ".</p>\n";
  return "<h2>Meshes</h2>\n" +
         html::table({"part", "triangles", "distance from curved faces [µm]", "faults", "no inside"}, rows) +
         read;
}

}  // namespace

std::string checkTablesOfRun(const scenes::CheckResult& result) {
  return pairs(result) + (result.fits.empty() ? "" : fits(result)) + pressFits(result);
}

std::string checkSection(const scenes::CheckResult& result, const Progress& progress) {
  const bool has_play =
      std::ranges::any_of(result.parts, [](const auto& part) { return part.play.has_value(); });
  return rules(result) + pairs(result) + (result.fits.empty() ? "" : fits(result)) + pressFits(result) +
         planeSectionPictures(result) + sectionPictures(result) + clearancePictures(result, progress) +
         (has_play ? play(result) : "") + meshes(result);
}

std::string checkPage(const scenes::CheckResult& result, const std::string& after_answer,
                      const Progress& progress) {
  const std::size_t clashes = result.clashes();
  std::string answer = escapeHtml(assemblyWords(result));
  if (!answer.empty()) answer.front() = static_cast<char>(std::toupper(answer.front()));
  std::string verdict = !answer.empty() ? answer + "."
                        : result.isAboutChosenPairs()
                            ? "No parts of the chosen pairs overlap as drawn, beyond the stated errors."
                            : "No parts overlap as drawn, beyond the stated errors.";
  if (clashes > 0) {
    const scenes::CheckedPair& worst = *result.deepestClash();
    verdict = (clashes == 1 ? "Two parts overlap as drawn: "
                            : std::to_string(clashes) + " pairs of parts overlap as drawn, the deepest: ") +
              escapeHtml(worst.a) + " and " + escapeHtml(worst.b) + " by " +
              lengthOnPage(worst.interference_depth_m) + " (± " + lengthOnPage(worst.error_m) + "). " +
              verdict;
  }
  constexpr std::array kClass = {"good", "bad", "unsure"};
  static_assert(static_cast<int>(scenes::Verdict::NotShown) == 2);
  const std::string title = "Check of " + (result.title.empty() ? result.assembly : result.title);
  return html::page(title, "<h1>" + escapeHtml(title) + "</h1>\n<p class=\"verdict " +
                               kClass[static_cast<std::size_t>(scenes::answerOf(result))] + "\">" + verdict +
                               "</p>\n" + asked(result) + after_answer + checkSection(result, progress));
}

}  // namespace vps::viewer
