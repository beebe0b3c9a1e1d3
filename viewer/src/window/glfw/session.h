// SPDX-License-Identifier: BSD-3-Clause
// What the parts of the open window share.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "vps_viewer/window.h"
#include "window/glfw/glfw_window.h"
#include "window/live_run.h"
#include "window/neighbours.h"
#include "window/picture_worker.h"
#include "window/view_state.h"

namespace vps::viewer::inline v0 {

/// Where the picture is in the window, in pixels.
struct PictureArea {
  float x = 0, y = 0;
  PictureSize size;
};

struct Session {
  const scenes::Scene& scene;
  const WindowOptions& options;
  Timeline line;  ///< the tour or the recording
  bool is_recording = false;
  RenderScene drawn;
  ViewState view;
  PictureArea area;
  scenes::Snapshot shown;   ///< before it is exploded
  scenes::Snapshot placed;  ///< what is drawn: `shown`, or its exploded view
  std::unique_ptr<LiveRun> run;
  LiveStatus status;  ///< of the run
  Timeline run_line;  ///< its curves so far
  Neighbours neighbours;
  std::deque<std::string> messages;  ///< of the window itself, the newest first
  std::string drawn_by;
  double picture_ms = 0;
  bool is_draft = false;
  std::size_t pictures = 0;
  bool is_dragging_section = false;

  explicit Session(const scenes::Scene& scene, const WindowOptions& options)
      : scene(scene), options(options), drawn(drawnMeshes(scene)), neighbours(scene) {}

  void say(const std::string& words) {
    messages.push_front(words);
    if (messages.size() > 50) messages.pop_back();
  }
  /// Around the scene as it is shown.
  [[nodiscard]] Box box_W() const { return snapshotBounds(drawn, placed); }
  [[nodiscard]] const Timeline& shownLine() const { return run ? run_line : line; }
};

// panels.cpp
/// The panel at the right, the time axis below, and the list of keys. Sets session.area to what they leave.
void drawPanels(Session& session, const GlfwWindow& window);
// plots.cpp
/// The curves of the line over time, with a mark at now_s. A click sets *now_s.
void drawPlots(const Timeline& line, double* now_s, float scale, bool may_seek);
// mouse.cpp
/// Orbit, pan, zoom, section and picking, over the picture.
void useMouse(Session& session);

}  // namespace vps::viewer::inline v0
