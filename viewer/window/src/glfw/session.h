// SPDX-License-Identifier: BSD-3-Clause
// The state of the open window, and the functions of this folder that work on it.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "glfw/glfw_window.h"
#include "run/followed_session.h"
#include "run/gap_watch.h"
#include "run/hand_drag.h"
#include "run/hand_work.h"
#include "run/headset_session.h"
#include "run/live_run.h"
#include "view/picture_worker.h"
#include "view/view_state.h"
#include "vps_scenes/network/tracked_heads.h"
#include "vps_viewer/window/window.h"

namespace vps::viewer {

/// A rectangle of the window in pixels.
struct PictureArea {
  float x = 0, y = 0;
  PictureSize size;
};

struct Session {
  const scenes::Scene& scene;
  const WindowOptions& options;
  Timeline line;  ///< snapshots of the tour or of the recording
  bool is_recording = false;
  /// Session of vps render that the window shows; null: it shows no session.
  FollowedSession* followed = nullptr;
  RenderScene drawn;
  ModelView models;  ///< owns the meshes of contact models in `drawn`, if these are shown
  ViewState view;
  PictureArea area;   ///< the picture in the window
  PictureArea focus;  ///< picture of `view.camera`: `area`, or if there are tiles, the tile under the cursor
  /// Pictures of a display file or of Spectral stereo, in `area`; empty: one picture.
  std::vector<PictureTile> tiles;
  std::vector<std::string> tile_names;  ///< name of each tile; empty: tiles have no names
  std::size_t tile = 0;                 ///< index of the tile that is `focus`
  scenes::Snapshot shown;               ///< snapshot before the exploded view moves parts
  scenes::Snapshot placed;              ///< snapshot that is drawn: `shown` or its exploded view
  std::unique_ptr<LiveRun> run;
  LiveStatus status;        ///< state of the run, including the steps that were done before it
  HandWork work;            ///< the parts that were put down so far
  bool is_at_work = false;  ///< shows `work` or its run; false: the tour
  std::size_t first_step = 0,
              steps_known = 0;  ///< first step of the run; number of the run's steps that are done and noted
  std::vector<scenes::StepResult> before;  ///< steps that were done before the run
  int recordings = 0;                      ///< number of recordings begun
  std::string run_hand;                    ///< kind of device of the run
  Timeline run_line;                       ///< curves of the run so far
  std::string hand;                        ///< kind of device that moves the part in the next run
  HandDrag drag;                           ///< drag of the part in hand by the mouse
  Neighbours neighbours;
  std::unique_ptr<GapWatch> gaps;              ///< exists while the window is open; wakes the window
  scenes::RunFigures figures, figures_before;  ///< counts of the run now, and at the start of the interval
                                               ///< over which rates are averaged
  double figures_s = 0, figures_before_s = 0;  ///< wall time of figures and figures_before
  std::optional<scenes::TrackedHeads> heads;   ///< head poses of the display file's viewers
  std::unique_ptr<HeadsetSession>
      headset;                       ///< exists while the window is open; wakes the window; null: no headset
  std::array<HeadsetHand, 2> hands;  ///< controllers of the headset, as last seen
  std::optional<std::size_t> holding_hand;  ///< the controller that holds the part in hand
  std::deque<std::string> messages;         ///< messages of the window itself, the newest first
  std::string drawn_by;
  std::string picture_failure;  ///< why there is no picture; empty: there is one
  double picture_ms = 0;
  bool is_draft = false;
  std::size_t pictures = 0;
  bool is_dragging_section = false;

  explicit Session(const scenes::Scene& scene, const WindowOptions& options)
      : scene(scene),
        options(options),
        drawn(drawnMeshes(scene)),
        models(scene, options.show, drawn),
        work(scene),
        hand(options.hand.empty() ? scene.device.kind : options.hand),
        drag(scene.device.scale),
        neighbours(scene) {
    if (!options.display) return;
    heads.emplace(*options.display);
    heads->waitForAll(scenes::kHeadWait_s);
  }

  void say(const std::string& words) {
    messages.push_front(words);
    if (messages.size() > 50) messages.pop_back();
  }
  /// Bounds of the scene as it is drawn.
  [[nodiscard]] Box box_W() const { return snapshotBounds(drawn, placed); }
  /// Whether the mouse moves the part in hand.
  [[nodiscard]] bool isByMouse() const { return run && !status.is_over && run_hand == "mouse"; }
  /// Whether a person moves the part in hand, by any device.
  [[nodiscard]] bool isByHand() const { return run && !status.is_over && isByPerson(run_hand); }
  [[nodiscard]] const Timeline& shownLine() const { return is_at_work ? run_line : line; }
};

// runs.cpp
/// Requests the distances of the picked part and of the part in hand, at the poses that are shown.
void watchGaps(Session& session);
/// Carries out the actions on runs that the view state requests: start, stop, undo, redo, take a part.
void carryOutWork(Session& session, GlfwWindow& window);
/// If the view state requests it, marks the picked place for all who watch the session, or removes the mark.
void carryOutPoint(Session& session);
/// Shows the newest snapshot of the run; without a run, the parts that were put down.
void followWork(Session& session);

/// Shows the newest snapshot and messages of the session that the window follows.
void followSession(Session& session);

// panels.cpp
/// Draws the panel at the right, the time axis below, and the list of keys. Sets session.area to the rest of
/// the window.
void drawPanels(Session& session, const GlfwWindow& window);
/// Draws the reason why there is no picture, if there is none.
void drawFailure(const Session& session);
// plots.cpp
/// Draws the curves of `line` over time, with a mark at *now_s. If may_seek, a click sets *now_s.
void drawPlots(const Timeline& line, double* now_s, float scale, bool may_seek);
// mouse.cpp
/// Handles the mouse over the picture: orbit, pan, zoom, section, picking, and dragging the part in hand.
void useMouse(Session& session);
// headset_hands.cpp
/// Connects to a headset, if the options ask for one.
void beginHeadset(Session& session, GlfwWindow& window);
/// Passes the shown snapshot to the headset, and carries out what its controllers do.
void useHeadset(Session& session);
// marks.cpp
/// Draws over the picture the planned path of the part in hand, and with axis snap its axis.
void drawPathMarks(const Session& session);
/// Draws over the picture the places that people who watch the session point at.
void drawPointerMarks(const Session& session);
/// Draws over the picture the force on a person's hand as colour and number, and the spring from the grabbed
/// point to the mouse cursor.
void drawHandMarks(const Session& session);

}  // namespace vps::viewer
