// SPDX-License-Identifier: BSD-3-Clause
#include "output/reports.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "output/table.h"
#include "vps_viewer/report/csv.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

using scenes::PairState;

std::string place(const Vec3& p_W) {
  return fixed(1e3 * p_W.x(), 2) + ", " + fixed(1e3 * p_W.y(), 2) + ", " + fixed(1e3 * p_W.z(), 2);
}

std::string pairTable(const scenes::CheckResult& result) {
  Table table(
      {"<part", "<and", "<state", "clearance [um]", "overlap [um]", "volume [mm3]", "error [um]", "at [mm]"});
  bool has_overlap = false;
  for (const scenes::CheckedPair& pair : result.pairs) {
    has_overlap = has_overlap || pair.interference_depth_m > 0;
    const bool is_clash = pair.state >= PairState::PressFit;
    const std::string state = pair.is_uncertain ? "not known" : toText(pair.state);
    table.add({pair.a, pair.b,
               pair.state == PairState::Clash && pair.is_allowed ? state + " (allowed)" : state,
               is_clash ? "" : um(pair.clearance_m),
               pair.interference_depth_m > 0 ? um(pair.interference_depth_m) : "",
               is_clash ? volumeWords(pair) : "", um(pair.error_m), place(pair.at_W)});
  }
  return table.text() + (has_overlap ? std::string(kOverlapMeaning) + "\n" : "");
}

std::string fitTable(const scenes::CheckResult& result) {
  Table table(
      {"<fit", "<of", "<in", "size [mm]", "clearance [um]", "error [um]", "length [mm]", "<standard"});
  for (const scenes::CheckedFit& fit : result.fits)
    table.add({toText(fit.kind), fit.shaft, fit.bore, fixed(1e3 * fit.shaft_m, 3),
               um(fit.diametral_clearance_m), um(fit.error_m), fixed(1e3 * fit.length_m, 2),
               scenes::standardOf(fit)});
  return table.text();
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
      table.add({part.name, "overlaps"});
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
      out += pair.a + " and " + pair.b + ": " + um(pair.press_fit_m) +
             " um of press fit are declared, but the parts are drawn without an overlap\n";
  return out;
}

}  // namespace

std::string checkTables(const scenes::CheckResult& result) {
  std::string out;
  if (!result.pairs.empty()) out += pairTable(result) + "\n";
  if (!result.fits.empty()) out += fitTable(result) + "\n";
  const bool is_pressed =
      std::ranges::any_of(result.fits, [](const scenes::CheckedFit& fit) { return fit.press.has_value(); });
  if (is_pressed) out += pressTable(result) + "\n";
  out += undrawnPressFits(result);
  const bool has_play =
      std::ranges::any_of(result.parts, [](const scenes::CheckedPart& p) { return p.play.has_value(); });
  if (has_play) out += partTable(result) + "\n";
  return out;
}

std::string checkHeadline(const scenes::CheckResult& result) {
  std::string out = result.assembly + ": " + std::to_string(result.parts.size()) + " parts, " +
                    std::to_string(result.pairs.size()) + " pairs near each other, ";
  const std::string answer = assemblyWords(result);
  const std::size_t clashes = result.clashes();
  if (clashes == 0) return out + (answer.empty() ? "no clash deeper than the error of the check" : answer);
  const scenes::CheckedPair& worst = *result.deepestClash();
  out += std::to_string(clashes) + (clashes == 1 ? " clash: " : " clashes, the deepest: ") + worst.a +
         " and " + worst.b + " by " + um(worst.interference_depth_m) + " um (+- " + um(worst.error_m) +
         ") as drawn";
  return out + "\n" + answer;
}

std::string checkCsv(const scenes::CheckResult& result) {
  std::string out = csvLine({"what", "a", "b", "quantity", "value", "error"});
  const auto add = [&](const char* what, const std::string& a, const std::string& b,
                       const std::string& quantity, double value, double error) {
    out += csvLine({what, a, b, quantity, csvNumber(value), csvNumber(error)});
  };
  for (const scenes::CheckedPair& pair : result.pairs) {
    add("pair", pair.a, pair.b, "clearance_m", pair.clearance_m, pair.error_m);
    add("pair", pair.a, pair.b, "interference_depth_m", pair.interference_depth_m, pair.error_m);
    add("pair", pair.a, pair.b, "interference_volume_m3", pair.interference_volume_m3, pair.volume_error_m3);
  }
  for (const scenes::CheckedFit& fit : result.fits) {
    add(toText(fit.kind), fit.shaft, fit.bore, "diametral_clearance_m", fit.diametral_clearance_m,
        fit.error_m);
    if (fit.press) {
      add("press", fit.shaft, fit.bore, "pressure_Pa", fit.press->pressure_Pa, NAN);
      add("press", fit.shaft, fit.bore, "force_N", fit.press->force_N, NAN);
      add("press", fit.shaft, fit.bore, "declared_force_N", fit.press->declared_force_N, NAN);
    }
    add(toText(fit.kind), fit.shaft, fit.bore, "shaft_m", fit.shaft_m, fit.error_m);
    add(toText(fit.kind), fit.shaft, fit.bore, "bore_m", fit.bore_m, fit.error_m);
  }
  constexpr std::array kAxes = {"+x", "-x", "+y", "-y", "+z", "-z"};
  for (const scenes::CheckedPart& part : result.parts)
    for (std::size_t i = 0; part.play && i < kAxes.size(); ++i) {
      add("part", part.name, "", std::string("play_m ") + kAxes[i], part.play->m[i], part.play->error_m[i]);
      add("part", part.name, "", std::string("play_rad ") + kAxes[i], part.play->rad[i],
          part.play->error_rad[i]);
    }
  return out;
}

}  // namespace vps::viewer
