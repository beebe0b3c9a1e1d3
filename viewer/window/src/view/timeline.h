// SPDX-License-Identifier: BSD-3-Clause
// The data that a window plays: snapshots over time, with their steps and curves.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vps_device/recording.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// A step of the procedure on the time axis.
struct Chapter {
  std::string name;
  double start_s = 0;
  std::string verdict;  ///< text of the verdict; empty: not known
  /// The judge's reason for the verdict; empty: the part fits, or the reason is unknown.
  std::string reason = {};
};

/// A quantity at the times Timeline::time_s; NaN where it is not known.
struct Curve {
  std::string name, unit;
  std::vector<float> values;
};

struct Message {
  double time_s = 0;
  std::string words;
};

struct VPS_VIEWER_API Timeline {
  double end_s = 0;
  std::vector<Chapter> chapters;  ///< sorted by time; not empty
  std::vector<double> time_s;
  std::vector<Curve> curves;
  std::vector<Message> messages;
  std::function<scenes::Snapshot(double time_s)> at;  ///< snapshot at a time, which is clamped to the range

  /// Index of the chapter at that time.
  [[nodiscard]] std::size_t chapterAt(double t_s) const;
};

/// The curves of a live run, still empty: force, torque, depth, contacts, clearance, energy.
[[nodiscard]] VPS_VIEWER_API std::vector<Curve> liveCurves();
/// Adds the values of a snapshot to the curves.
/// @param clearance_m  least distance of the part in hand to another part; none: unknown, or not measured
VPS_VIEWER_API void addInstant(Timeline& line, const scenes::Snapshot& shot,
                               std::optional<double> clearance_m);
/// Adds the chapter of the current step, unless it exists. For a watcher who joins a session late, the
/// chapters of the missed steps begin at the same time.
/// @param line  timeline whose first chapter is the time before the first step
/// @param name  returns the name of a step's chapter
VPS_VIEWER_API void addChapters(Timeline& line, std::size_t step, double time_s,
                                const std::function<std::string(std::size_t step)>& name);
/// Lines of text with a run's rates, missed periods and energies.
/// @param elapsed_s  wall time between the figures `before` and `now`
[[nodiscard]] VPS_VIEWER_API std::vector<std::string> figureLines(const scenes::RunFigures& now,
                                                                  const scenes::RunFigures& before,
                                                                  double elapsed_s);

/// Shows the finished assembly at first, then moves each step's part along its path, without physics: 2 s a
/// step. The scene must outlive the timeline.
VPS_VIEWER_API Timeline sceneTour(const scenes::Scene& scene);

/// A recorded run, from its trace. A recording has the number of contacts, but not the contacts. Scene and
/// run must outlive the timeline.
VPS_VIEWER_API Timeline recordedTimeline(const scenes::Scene& scene, const device::RecordedRun& run);

}  // namespace vps::viewer
