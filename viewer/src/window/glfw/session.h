// SPDX-License-Identifier: BSD-3-Clause
// What the parts of the open window share.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "vps_viewer/window.h"
#include "window/glfw/glfw_window.h"
#include "window/hand_drag.h"
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
  LiveStatus status;     ///< of the run
  std::string run_hand;  ///< kind of device in the run
  Timeline run_line;     ///< its curves so far
  std::string hand;      ///< kind of device that moves the part in the next run
  HandDrag drag;         ///< of the mouse as a device
  Neighbours neighbours;
  std::deque<std::string> messages;  ///< of the window itself, the newest first
  std::string drawn_by;
  double picture_ms = 0;
  bool is_draft = false;
  std::size_t pictures = 0;
  bool is_dragging_section = false;

  explicit Session(const scenes::Scene& scene, const WindowOptions& options)
      : scene(scene),
        options(options),
        drawn(drawnMeshes(scene)),
        hand(options.hand.empty() ? scene.device.kind : options.hand),
        drag(scene.device.scale),
        neighbours(scene) {}

  void say(const std::string& words) {
    messages.push_front(words);
    if (messages.size() > 50) messages.pop_back();
  }
  /// Around the scene as it is shown.
  [[nodiscard]] Box box_W() const { return snapshotBounds(drawn, placed); }
  /// Whether the mouse moves the part in hand.
  [[nodiscard]] bool isByMouse() const { return run && !status.is_over && run_hand == "mouse"; }
  [[nodiscard]] const Timeline& shownLine() const { return run ? run_line : line; }
};

// panels.cpp
/// The panel at the right, the time axis below, and the list of keys. Sets session.area to what they leave.
void drawPanels(Session& session, const GlfwWindow& window);
// plots.cpp
/// The curves of the line over time, with a mark at now_s. A click sets *now_s.
void drawPlots(const Timeline& line, double* now_s, float scale, bool may_seek);
// mouse.cpp
/// Orbit, pan, zoom, section, picking, and the part in hand, over the picture.
void useMouse(Session& session);
// hand_marks.cpp
/// Over the picture: the spring from the grabbed point to the cursor, with the force's size as colour and
/// number.
void drawHandMarks(const Session& session);

}  // namespace vps::viewer::inline v0
