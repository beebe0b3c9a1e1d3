// SPDX-License-Identifier: BSD-3-Clause
// The Pareto front of a trade study, and its conclusions in words.
#include <algorithm>
#include <cstdio>

#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

namespace {

bool isComplete(const TradeRow& row) {
  return row.has_run && row.has_probe && row.run.completed;
}

bool dominates(const TradeRow& a, const TradeRow& b) {
  const double t_a = a.run.physics.cpu_p99_us, t_b = b.run.physics.cpu_p99_us;
  const bool is_no_worse = t_a <= t_b && errorOf(a) <= errorOf(b) && a.bytes <= b.bytes;
  return is_no_worse && (t_a < t_b || errorOf(a) < errorOf(b) || a.bytes < b.bytes);
}

}  // namespace

double errorOf(const TradeRow& row) {
  return std::max(row.run.deepest_m, row.probe.penetration_m);
}

double rateOf(const TradeRow& row) {
  return row.has_run && row.run.physics.cpu_p99_us > 0 ? 1e6 / row.run.physics.cpu_p99_us : 0;
}

void markFront(std::vector<TradeRow>& rows) {
  for (TradeRow& row : rows)
    row.is_on_front = isComplete(row) && std::none_of(rows.begin(), rows.end(), [&](const TradeRow& other) {
                        return isComplete(other) && dominates(other, row);
                      });
}

namespace {

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string micrometres(double m) {
  return number("%.3g um", 1e6 * m);
}

constexpr double kForceLimit = 0.5;  // assumed: a force with a larger error is useless to the operator

bool isUsable(const TradeRow& row) {
  return row.has_run && row.has_probe && row.run.completed && row.probe.force <= kForceLimit;
}

/// For example "'voxel x2' (voxel 0.5 mm, spacing 0.5 mm, both sides)"
std::string named(const TradeRow& row) {
  const Fidelity& f = row.setting.fidelity;
  return "'" + row.setting.name + "' (voxel " + number("%.4g mm", 1e3 * f.voxel_m) + ", spacing " +
         number("%.4g mm", 1e3 * f.spacing_m) + ", " + inWords(f.sides) + ")";
}

std::string errorWords(const TradeRow& row) {
  return "depth error " + micrometres(row.probe.penetration_m) + ", deepest penetration " +
         micrometres(row.run.deepest_m) + ", force error " + number("%.2g %%", 100 * row.probe.force);
}

std::string forRate(const TradeResult& result, double rate_hz) {
  const TradeRow* best = nullptr;
  const TradeRow* fastest = nullptr;
  for (const TradeRow& row : result.rows) {
    if (!isUsable(row)) continue;
    if (fastest == nullptr || rateOf(row) > rateOf(*fastest)) fastest = &row;
    if (rateOf(row) < rate_hz) continue;
    const bool is_better = best == nullptr || errorOf(row) < errorOf(*best) ||
                           (errorOf(row) == errorOf(*best) && row.probe.force < best->probe.force);
    if (is_better) best = &row;
  }
  const std::string head = "for " + number("%.0f Hz", rate_hz) + " of physics rate on this machine ";
  if (fastest == nullptr)
    return head + "there is no answer, since no setting that completed the run had a force error within 50 %";
  if (best == nullptr)
    return head + "no measured setting suffices; the fastest, " + named(*fastest) + ", sustains " +
           number("%.0f Hz", rateOf(*fastest));
  return head + "choose " + named(*best) + ": this setting sustains " + number("%.0f Hz", rateOf(*best)) +
         "; " + errorWords(*best);
}

std::string forError(const TradeResult& result, double error_m) {
  const TradeRow* best = nullptr;
  const TradeRow* most_accurate = nullptr;
  for (const TradeRow& row : result.rows) {
    if (!isUsable(row)) continue;
    if (most_accurate == nullptr || errorOf(row) < errorOf(*most_accurate)) most_accurate = &row;
    if (errorOf(row) <= error_m && (best == nullptr || rateOf(row) > rateOf(*best))) best = &row;
  }
  const std::string head = "for " + micrometres(error_m) + " of depth error ";
  if (most_accurate == nullptr)
    return head + "there is no answer, since no setting that completed the run had a force error within 50 %";
  if (best == nullptr)
    return head + "no measured setting suffices; the most accurate, " + named(*most_accurate) +
           ", has an error of " + micrometres(errorOf(*most_accurate));
  return head + "choose " + named(*best) + ": this setting sustains " + number("%.0f Hz", rateOf(*best)) +
         " on this machine; " + errorWords(*best);
}

/// The effect of one changed setting relative to the scene's own fidelity, from rows that change only this
/// setting.
std::string knobLine(const TradeRow& own, const TradeRow& row) {
  const auto change = [](double value, double from) {
    return from > 0 ? number("%+.0f %%", 100 * (value / from - 1)) : std::string("-");
  };
  std::string words = row.setting.name + ": ";
  if (row.points != own.points || row.bytes != own.bytes || row.points_read != own.points_read)
    words += "memory " + change(static_cast<double>(row.bytes), static_cast<double>(own.bytes)) +
             ", depth error " + change(row.probe.penetration_m, own.probe.penetration_m) + ", force error " +
             change(row.probe.force, own.probe.force) + ", query " +
             change(row.query.cpu_p50_us, own.query.cpu_p50_us) + ", ";
  if (row.has_run && own.has_run) {
    words += "step (p99) " + change(row.run.physics.cpu_p99_us, own.run.physics.cpu_p99_us) + ", deepest " +
             micrometres(own.run.deepest_m) + " -> " + micrometres(row.run.deepest_m);
    if (!row.run.completed) words += "; the procedure was not completed";
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
                                [](const TradeRow& row) { return row.setting.knob == TradeKnob::Own; });
  if (own == result.rows.end()) return lines;
  for (const TradeRow& row : result.rows)
    if (row.setting.knob != TradeKnob::Own && row.setting.knob != TradeKnob::Reference)
      lines.push_back(knobLine(*own, row));
  return lines;
}

}  // namespace vps::scenes
