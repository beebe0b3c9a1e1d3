// SPDX-License-Identifier: BSD-3-Clause
// The steps of an instruction book in sentences.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "files/html.h"
#include "pages/book_pictures.h"
#include "vps_viewer/report/book.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

using html::format;

constexpr double kDegrees = 180 / std::numbers::pi;

std::string millimetres(double length_m) {
  return format(1e3 * length_m, "%.2f mm");
}

/// "(-z)", or "(0.71, 0.00, -0.71)".
std::string inBrackets(const Vec3& d) {
  const std::string words = directionWords(d);
  return words.starts_with("(") ? words : "(" + words + ")";
}

/// "straight down (-z)", "obliquely down and to the right (0.71, 0.00, -0.71)".
std::string wayWords(const Vec3& d, const BookSides& sides) {
  constexpr double kNone = 0.1, kAlong = 0.9995;
  struct Term {
    double share;
    const char *forward, *backward;
  };
  std::array<Term, 3> terms = {{{d.dot(sides.up_W), "up", "down"},
                                {d.dot(sides.right_W), "to the right", "to the left"},
                                {d.dot(sides.front_W), "to the front", "to the back"}}};
  std::ranges::stable_sort(
      terms, [](const Term& a, const Term& b) { return std::abs(a.share) > std::abs(b.share); });
  std::string out = std::abs(terms.front().share) > kAlong ? "straight " : "obliquely ";
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Term& term = terms[i];
    if (i > 0 && std::abs(term.share) < kNone) continue;
    out += std::string(i > 0 ? " and " : "") + (term.share > 0 ? term.forward : term.backward);
  }
  return out + " " + inBrackets(d);
}

/// "90.0 degrees counter-clockwise as seen from above (about +z)".
std::string turnWords(const Vec3& turn_W, const BookSides& sides) {
  constexpr double kSide = 0.9;
  const double turn_rad = turn_W.norm();
  const Vec3 axis_W = turn_W / turn_rad;
  const std::string angle = format(kDegrees * turn_rad, "%.1f degrees ");
  const std::array<std::pair<Vec3, const char*>, 3> seen = {
      {{sides.up_W, "above"}, {sides.right_W, "the right"}, {sides.front_W, "the front"}}};
  for (const auto& [side_W, words] : seen)
    if (const double share = axis_W.dot(side_W); std::abs(share) > kSide)
      return angle + (share > 0 ? "counter-clockwise" : "clockwise") + " as seen from " + words + " (about " +
             directionWords(axis_W) + ")";
  return angle + "by the right-hand rule about " + directionWords(axis_W);
}

std::string legWords(const scenes::BookLeg& leg, const BookSides& sides) {
  constexpr double kNoMove_m = 1e-7, kNoTurn_rad = 1e-6;
  const double move_m = leg.move_W.norm(), turn_rad = leg.turn_W.norm();
  const std::string way =
      move_m > kNoMove_m ? wayWords(leg.move_W / move_m, sides) + " by " + millimetres(move_m) : "";
  if (turn_rad <= kNoTurn_rad) return "move it " + way;
  const std::string turn = "turn it " + turnWords(leg.turn_W, sides);
  if (way.empty()) return turn;
  return turn + ", while its middle moves " + way + ": it must be turned by " +
         format(kDegrees * turn_rad / (1e3 * move_m), "%.2f") + " degrees per mm";
}

void addPath(const scenes::BookStep& step, const BookSides& sides, std::vector<std::string>& lines) {
  const std::string name = "'" + step.planned.name + "'";
  if (step.planned.parts.size() > 1)
    lines.push_back(name + " is a subassembly: " + listedNames(step.planned.parts) +
                    ". It moves as one; hold its parts together.");
  if (step.planned.is_on_bench) lines.push_back(name + " lies on the bench at the start.");
  if (step.legs.size() == 1) {
    std::string leg = legWords(step.legs.front(), sides);
    const std::string it = " it ";  // of "move it" and "turn it"
    leg.replace(leg.find(it), it.size(), " " + name + " ");
    leg.front() = leg.front() == 'm' ? 'M' : 'T';
    lines.push_back(leg + ".");
  } else if (!step.legs.empty()) {
    std::string path = "The path of " + name + " has " + std::to_string(step.legs.size()) + " legs: ";
    for (std::size_t i = 0; i < step.legs.size(); ++i)
      path += (i > 0 ? "; " : "") + std::to_string(i + 1) + ". " + legWords(step.legs[i], sides);
    lines.push_back(path + ".");
  }
}

void addScrew(const scenes::BookStep& step, std::vector<std::string>& lines) {
  const scenes::PlannedStep& planned = step.planned;
  if (planned.kind != scenes::WayKind::Screw || planned.lead_m == 0) return;
  const double lead_m = std::abs(planned.lead_m);
  std::string line =
      "In its thread it must be turned by " + format(360 / (1e3 * lead_m), "%.1f") + " degrees per mm (" +
      (planned.lead_m > 0 ? "right" : "left") + "-hand, lead " + format(1e3 * lead_m, "%.3f") + " mm), " +
      (planned.lead_m > 0 ? "clockwise" : "counter-clockwise") + " as seen along its way to the target.";
  const auto thread = std::ranges::find(step.fits, scenes::FitKind::Thread, &scenes::CheckedFit::kind);
  if (thread != step.fits.end())
    line += " A thread of " + millimetres(thread->length_m) + " takes about " +
            format(thread->length_m / lead_m, "%.1f") + " turns.";
  lines.push_back(line);
}

void addOrder(const scenes::BookStep& step, std::vector<std::string>& lines) {
  std::vector<std::string> ways, carriers;
  for (const scenes::PlannedOrder& need : step.needs)
    (need.reason == scenes::OrderReason::Way ? ways : carriers).push_back(need.before);
  if (!ways.empty())
    lines.push_back("Must be in place before: " + listedNames(ways) + "; afterwards no path would be left.");
  if (!carriers.empty())
    lines.push_back("Must be in place before, to carry it: " + listedNames(carriers) + ".");
  if (!step.planned.is_carried)
    lines.push_back("Hold it until the end of the step: nothing in place carries it.");
  if (!step.planned.falling.empty())
    lines.push_back("Until this step is done, nothing else carries " + listedNames(step.planned.falling) +
                    ": hold until then.");
}

void addClearance(const scenes::PlannedStep& planned, std::vector<std::string>& lines) {
  constexpr double kFine_m = 1e-3;
  if (planned.clearance_m)
    lines.push_back("On its path it clears '" + planned.nearest + "' by " +
                    (*planned.clearance_m < kFine_m ? "only " + micrometres(*planned.clearance_m, "%.0f µm")
                                                    : format(1e3 * *planned.clearance_m, "%.3f mm")) +
                    ".");
  if (planned.allowance_m > 0)
    lines.push_back("No path without overlap of facets was found: on this path facets overlap by up to " +
                    micrometres(planned.allowance_m, "%.1f µm") +
                    " more than drawn, which the errors of the meshes and 5 µm allow. A hole may be too "
                    "small.");
}

std::string fitWords(const scenes::CheckedFit& fit) {
  const std::string standard = scenes::standardOf(fit);
  const bool is_free = fit.diametral_clearance_m >= 0;
  std::string line = std::string("Fit (") + scenes::toText(fit.kind) + (standard.empty() ? "" : " ") +
                     standard + ") of '" + fit.shaft + "' in '" + fit.bore +
                     "': " + format(1e3 * fit.shaft_m, "%.3f") + " mm in " +
                     format(1e3 * fit.bore_m, "%.3f") + " mm, " + (is_free ? "clearance " : "interference ") +
                     micrometres(std::abs(fit.diametral_clearance_m), "%.1f") + " µm (± " +
                     micrometres(fit.error_m, "%.1f") + "), over a length of " + millimetres(fit.length_m);
  if (fit.press) line += "; by Lamé's formula, pressing it in takes " + format(fit.press->force_N, "%.0f N");
  return line + ".";
}

void addFits(const std::vector<scenes::CheckedFit>& fits, std::vector<std::string>& lines) {
  constexpr std::size_t kMostFits = 6;  // so that a step stays on one sheet
  for (std::size_t i = 0; i < std::min(fits.size(), kMostFits); ++i) lines.push_back(fitWords(fits[i]));
  if (fits.size() > kMostFits)
    lines.push_back(std::to_string(fits.size() - kMostFits) + " more fits are listed by vps check.");
}

/// The play of a part, with the words of the page of a check.
std::string bookPlay(const scenes::CheckedPart& part) {
  std::string out = "Play of '" + part.name + "' in the finished assembly:";
  const auto bothWays = [&](std::size_t i, bool is_turn) {
    const scenes::Play& play = *part.play;
    const auto words = [&](std::size_t k) {
      return is_turn ? playWords(play.rad[k], play.error_rad[k], part.play_error_rad, 1e3, "%.2f")
                     : playWords(play.m[k], play.error_m[k], part.play_error_m, 1e6, "%.1f");
    };
    return " +" + words(2 * i) + " / -" + words(2 * i + 1);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 axis_W = part.play_axes_W.col(static_cast<Eigen::Index>(i));
    out += (i > 0 ? "; " : " ") + ("along " + directionWords(axis_W)) + bothWays(i, false) + " µm, about it" +
           bothWays(i, true) + " mrad";
  }
  return out + ".";
}

void addPlay(const std::vector<scenes::CheckedPart>& measured, std::vector<std::string>& lines) {
  constexpr std::size_t kMostPlays = 3;  // of a subassembly; so that a step stays on one sheet
  for (std::size_t i = 0; i < std::min(measured.size(), kMostPlays); ++i) {
    lines.push_back(bookPlay(measured[i]));
    if (!measured[i].is_play_certain)
      lines.back() += " Facets or equal sizes make this play uncertain, see vps check.";
  }
}

}  // namespace

std::vector<std::string> bookLines(const scenes::Book& book, const scenes::BookStep& step) {
  std::vector<std::string> lines;
  addPath(step, sidesOf(book.up_W), lines);
  addScrew(step, lines);
  addOrder(step, lines);
  addClearance(step.planned, lines);
  addFits(step.fits, lines);
  addPlay(step.measured, lines);
  if (step.torque_Nm > 0) lines.push_back("Tighten it with " + format(step.torque_Nm, "%g N m") + ".");
  return lines;
}

}  // namespace vps::viewer
