// SPDX-License-Identifier: BSD-3-Clause
// The timeline of a recorded run, from the trace in the recording.
#include <algorithm>
#include <memory>

#include "view/timeline.h"

namespace vps::viewer {
namespace {

using device::RunEvent;
using device::RunEventKind;
using device::RunTrace;

std::vector<RunTrace> traceOf(const device::RecordedRun& run, std::size_t steps) {
  std::vector<RunTrace> rows;
  for (const device::LogEntry& entry : run.entries)
    if (const auto* row = std::get_if<RunTrace>(&entry))
      if (row->step >= 0 && static_cast<std::size_t>(row->step) < steps && row->X_WP.isFinite() &&
          (rows.empty() || row->time_s >= rows.back().time_s))
        rows.push_back(*row);
  return rows;
}

scenes::Snapshot snapshotAt(const scenes::Scene& scene, const std::vector<RunTrace>& rows, double time_s) {
  scenes::Snapshot shot;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    shot.bodies.push_back({i, scene.parts[i].X_WP,
                           scene.parts[i].is_fixed ? scenes::BodyRole::Mounted : scenes::BodyRole::Waiting});
  for (const scenes::SceneStep& step : scene.steps)
    if (step.takes_off) shot.bodies[step.part] = {step.part, step.X_WP_start, scenes::BodyRole::Mounted};
  const auto after = std::upper_bound(rows.begin(), rows.end(), time_s,
                                      [](double t_s, const RunTrace& row) { return t_s < row.time_s; });
  if (after == rows.begin()) return shot;
  const RunTrace& now = *std::prev(after);
  for (auto row = rows.begin(); row != after; ++row) {
    const bool is_last_of_step = std::next(row) == after || std::next(row)->step != row->step;
    if (!is_last_of_step) continue;
    const scenes::SceneStep& done = scene.steps[static_cast<std::size_t>(row->step)];
    shot.bodies[done.part] = {done.part, row->X_WP,
                              done.takes_off ? scenes::BodyRole::Waiting : scenes::BodyRole::Mounted};
  }
  const scenes::SceneStep& step = scene.steps[static_cast<std::size_t>(now.step)];
  constexpr std::uint8_t kRest = 3;  // scenes::TracePhase::Rest, in RunTrace::phase
  shot.time_s = now.time_s;
  shot.step = now.step;
  shot.bodies[step.part].role = now.phase == kRest ? scenes::BodyRole::Released : scenes::BodyRole::InHand;
  shot.has_target = true;
  shot.target_part = step.part;
  shot.X_WP_target = step.X_WP_target;
  shot.has_hand = now.phase != kRest;
  shot.X_W_Proxy = now.X_W_Proxy;
  shot.F_hand_W = now.F_hand_W;
  return shot;
}

void addCurves(Timeline& line, const std::vector<RunTrace>& rows) {
  Curve force{"force", "N", {}}, torque{"torque", "N m", {}}, depth{"depth", "um", {}},
      contacts{"contacts", "", {}};
  for (const RunTrace& row : rows) {
    line.time_s.push_back(row.time_s);
    force.values.push_back(static_cast<float>(row.F_hand_W.f.norm()));
    torque.values.push_back(static_cast<float>(row.F_hand_W.tau.norm()));
    depth.values.push_back(static_cast<float>(row.depth_m * 1e6));
    contacts.values.push_back(static_cast<float>(row.contacts));
  }
  line.curves = {std::move(force), std::move(torque), std::move(depth), std::move(contacts)};
}

}  // namespace

Timeline recordedTimeline(const scenes::Scene& scene, const device::RecordedRun& run) {
  Timeline line;
  const auto rows = std::make_shared<std::vector<RunTrace>>(traceOf(run, scene.steps.size()));
  int step = -1;
  for (const RunTrace& row : *rows) {
    if (row.step == step) continue;
    step = row.step;
    const scenes::SceneStep& begun = scene.steps[static_cast<std::size_t>(step)];
    line.chapters.push_back(
        {std::to_string(step + 1) + " " + scene.parts[begun.part].part.name, row.time_s, ""});
  }
  if (line.chapters.empty()) line.chapters.push_back({"no step was recorded", 0, ""});
  line.end_s = rows->empty() ? 0 : rows->back().time_s;
  addCurves(line, *rows);
  for (const device::LogEntry& entry : run.entries)
    if (const auto* event = std::get_if<RunEvent>(&entry))
      line.messages.push_back({event->time_s, std::string(event->words())});
  if (!run.damage.empty()) line.messages.push_back({line.end_s, run.damage});
  line.at = [&scene, rows, end_s = line.end_s](double time_s) {
    return snapshotAt(scene, *rows, std::clamp(time_s, rows->empty() ? 0 : rows->front().time_s, end_s));
  };
  return line;
}

}  // namespace vps::viewer
