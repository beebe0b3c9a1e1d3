// SPDX-License-Identifier: BSD-3-Clause
// What a trade's rows come to, in words.
#include <algorithm>
#include <cstdio>

#include "vps_scenes/trade.h"

namespace vps::scenes {

namespace {

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string micrometres(double m) {
  return number("%.3g um", 1e6 * m);
}

constexpr double kForceLimit = 0.5;  // assumed: a force that is farther off tells the hand nothing

bool isUsable(const TradeRow& row) {
  return row.has_run && row.has_probe && row.run.completed && row.probe.force <= kForceLimit;
}

/// "'voxel x2' (voxel 0.5 mm, spacing 0.5 mm, both sides)"
std::string named(const TradeRow& row) {
  const Fidelity& f = row.what.fidelity;
  return "'" + row.what.name + "' (voxel " + number("%.4g mm", 1e3 * f.voxel_m) + ", spacing " +
         number("%.4g mm", 1e3 * f.spacing_m) + ", " + inWords(f.sides) + ")";
}

std::string errorWords(const TradeRow& row) {
  return "depth is read to " + micrometres(row.probe.penetration_m) + ", no part was deeper than " +
         micrometres(row.run.deepest_m) + ", force within " + number("%.2g %%", 100 * row.probe.force);
}

std::string forRate(const TradeResult& result, double rate_hz) {
  const TradeRow* best = nullptr;
  const TradeRow* quickest = nullptr;
  for (const TradeRow& row : result.rows) {
    if (!isUsable(row)) continue;
    if (quickest == nullptr || rateOf(row) > rateOf(*quickest)) quickest = &row;
    if (rateOf(row) < rate_hz) continue;
    const bool is_better = best == nullptr || errorOf(row) < errorOf(*best) ||
                           (errorOf(row) == errorOf(*best) && row.probe.force < best->probe.force);
    if (is_better) best = &row;
  }
  const std::string head = "for " + number("%.0f Hz", rate_hz) + " of physics on this machine ";
  if (quickest == nullptr)
    return head + "nothing that ran to the end gave a force within 50 %, so there is no answer";
  if (best == nullptr)
    return head + "no setting tried will do; the quickest, " + named(*quickest) + ", sustains " +
           number("%.0f Hz", rateOf(*quickest));
  return head + "choose " + named(*best) + ": it sustains " + number("%.0f Hz", rateOf(*best)) + "; " +
         errorWords(*best);
}

std::string forError(const TradeResult& result, double error_m) {
  const TradeRow* best = nullptr;
  const TradeRow* truest = nullptr;
  for (const TradeRow& row : result.rows) {
    if (!isUsable(row)) continue;
    if (truest == nullptr || errorOf(row) < errorOf(*truest)) truest = &row;
    if (errorOf(row) <= error_m && (best == nullptr || rateOf(row) > rateOf(*best))) best = &row;
  }
  const std::string head = "for " + micrometres(error_m) + " of depth ";
  if (truest == nullptr)
    return head + "nothing that ran to the end gave a force within 50 %, so there is no answer";
  if (best == nullptr)
    return head + "no setting tried will do; the truest, " + named(*truest) + ", comes to " +
           micrometres(errorOf(*truest));
  return head + "choose " + named(*best) + ": it sustains " + number("%.0f Hz", rateOf(*best)) + " here; " +
         errorWords(*best);
}

/// What a knob bought against the scene's own setting, from the rows that change nothing else.
std::string knobLine(const TradeRow& own, const TradeRow& row) {
  const auto change = [](double value, double from) {
    return from > 0 ? number("%+.0f %%", 100 * (value / from - 1)) : std::string("-");
  };
  std::string words = row.what.name + ": ";
  if (row.points != own.points || row.bytes != own.bytes || row.points_read != own.points_read)
    words += "memory " + change(static_cast<double>(row.bytes), static_cast<double>(own.bytes)) +
             ", depth error " + change(row.probe.penetration_m, own.probe.penetration_m) + ", force error " +
             change(row.probe.force, own.probe.force) + ", query " +
             change(row.query.cpu_p50_us, own.query.cpu_p50_us) + ", ";
  if (row.has_run && own.has_run) {
    words += "step (p99) " + change(row.run.physics.cpu_p99_us, own.run.physics.cpu_p99_us) + ", deepest " +
             micrometres(own.run.deepest_m) + " -> " + micrometres(row.run.deepest_m);
    if (!row.run.completed) words += "; the procedure failed";
  } else {
    words += "not run";
  }
  return words;
}

}  // namespace

std::vector<std::string> tradeAnswers(const TradeResult& result) {
  std::vector<std::string> lines;
  for (const double rate_hz : {1000.0, 500.0}) lines.push_back(forRate(result, rate_hz));
  for (const double error_m : {10e-6, 2e-6}) lines.push_back(forError(result, error_m));
  return lines;
}

std::vector<std::string> tradeKnobs(const TradeResult& result) {
  std::vector<std::string> lines;
  const auto own = std::find_if(result.rows.begin(), result.rows.end(),
                                [](const TradeRow& row) { return row.what.knob == TradeKnob::Own; });
  if (own == result.rows.end()) return lines;
  for (const TradeRow& row : result.rows)
    if (row.what.knob != TradeKnob::Own && row.what.knob != TradeKnob::Reference)
      lines.push_back(knobLine(*own, row));
  return lines;
}

}  // namespace vps::scenes
