// SPDX-License-Identifier: BSD-3-Clause
// What a window plays: snapshots over time, with the steps and curves that belong to them.
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
  std::string verdict;      ///< in words; empty: not known
  std::string reason = {};  ///< of the verdict, in the judge's words; empty: it fits, or none is known
};

/// A quantity over time, at Timeline::time_s; not a number where it is not known.
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
  std::vector<Chapter> chapters;  ///< in order of time; not empty
  std::vector<double> time_s;
  std::vector<Curve> curves;
  std::vector<Message> messages;
  std::function<scenes::Snapshot(double time_s)> at;  ///< for any time; times outside are the nearest inside

  /// Index of the chapter at that time.
  [[nodiscard]] std::size_t chapterAt(double t_s) const;
};

/// The curves that a run draws while it goes on: force, torque, depth, contacts, clearance, energy.
[[nodiscard]] VPS_VIEWER_API std::vector<Curve> liveCurves();
/// Adds an instant of a run to them.
/// @param clearance_m  least distance of the part in hand to another; none: not known, or farther than
/// measured
VPS_VIEWER_API void addInstant(Timeline& line, const scenes::Snapshot& shot,
                               std::optional<double> clearance_m);
/// Adds the chapter of a step that is under way, unless it is there. Who joins a session late has not seen
/// the steps before: their chapters begin with it.
/// @param line  whose first chapter is what comes before the first step
/// @param name  of a step's chapter
VPS_VIEWER_API void addChapters(Timeline& line, std::size_t step, double time_s,
                                const std::function<std::string(std::size_t step)>& name);
/// In words: what a run has done so far, at which rate, what it missed, and its energy. One line each.
/// @param elapsed_s  by the clock, in which `shot`'s figures came to be since `before`'s
[[nodiscard]] VPS_VIEWER_API std::vector<std::string> figureLines(const scenes::RunFigures& now,
                                                                  const scenes::RunFigures& before,
                                                                  double elapsed_s);

/// The finished assembly at time 0, then each step's part on its path, without physics: 2 s a step. The scene
/// outlives it.
VPS_VIEWER_API Timeline sceneTour(const scenes::Scene& scene);

/// A recorded run as its trace has it. Contacts are not recorded, only their number. Both outlive it.
VPS_VIEWER_API Timeline recordedTimeline(const scenes::Scene& scene, const device::RecordedRun& run);

}  // namespace vps::viewer
