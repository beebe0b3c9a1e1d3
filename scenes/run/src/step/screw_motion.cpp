// SPDX-License-Identifier: BSD-3-Clause
#include "step/screw_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "text/words.h"
#include "vps_device/operator.h"

namespace vps::scenes {

namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
/// With fewer turns no pitch can be measured: the play of a loose thread is a quarter of its pitch.
constexpr double kLeastTurns = 0.5;
bool isScrewing(const TraceRow& row) {
  return row.strategy == static_cast<int>(device::OperatorStrategy::ScrewOn);
}

std::string turnsInWords(double turns) {
  char words[40];
  std::snprintf(words, sizeof words, "%.1f turns", turns);
  return words;
}

}  // namespace

void measureScrew(std::span<const TraceRow> rows, const SceneStep& step, const Vec3& axis_W, const Pose& X_PG,
                  StepResult& result) {
  std::size_t end = rows.size();
  while (end > 0 && !isScrewing(rows[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && isScrewing(rows[begin - 1])) --begin;
  if (begin == end) return;
  const Vec3 axis_P = step.X_WP_target.R.transpose() * axis_W;
  double turned_rad = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (i > begin) turned_rad += axis_W.dot(rotationVector(rows[i].X_WP.R * rows[i - 1].X_WP.R.transpose()));
    const Vec3 leans = rows[i].X_WP.R * axis_P;
    result.lean_rad = std::max(result.lean_rad, std::atan2(leans.cross(axis_W).norm(), leans.dot(axis_W)));
  }
  const double advance_m = axis_W.dot(rows[end - 1].X_WP * X_PG.p - rows[begin].X_WP * X_PG.p);
  result.turns = (step.pitch_m < 0 ? -1 : 1) * turned_rad / kTurn_rad;
  result.advance_per_turn_m = result.turns != 0 ? advance_m / result.turns : 0;
}

std::string threadFault(const SceneStep& step, const StepResult& result) {
  const double pitch_m = std::abs(step.pitch_m);
  if (result.strategies.empty()) return {};  // a person turned the part
  if (result.turns == 0)
    return "the part was never screwed on, since no contact like that of a thread stopped it";
  const std::string figures = "in " + turnsInWords(result.turns) + " the part advanced by  " +
                              lengthInWords(result.advance_per_turn_m) + " a turn (pitch " +
                              lengthInWords(pitch_m) + ") and leaned by up to " +
                              degreesInWords(result.lean_rad);
  if (result.lean_rad > device::ScrewTask::kCrossedLean_rad) return "the thread is crossed: " + figures;
  if (result.turns < kLeastTurns) return "the part could not be screwed on: " + figures;
  const double off = result.advance_per_turn_m / pitch_m - 1;
  if (std::abs(off) <= device::ScrewTask::kOffPitch) return {};
  return (off < 0 ? "the threads did not catch: " : "the thread is skipped: ") + figures;
}

Pose turnedBack(const Pose& X_WP, const SceneStep& step, const Vec3& axis_W, const Pose& X_PG) {
  const double turn_rad = axis_W.dot(rotationVector(X_WP.R * step.X_WP_target.R.transpose()));
  const Mat3 R = rotationFromVector(-turn_rad * axis_W) * X_WP.R;
  return {R, Vec3(X_WP * X_PG.p - R * X_PG.p)};
}

}  // namespace vps::scenes
