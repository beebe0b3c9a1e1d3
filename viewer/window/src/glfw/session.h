// SPDX-License-Identifier: BSD-3-Clause
// What the parts of the open window share.
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
#include "run/neighbours.h"
#include "view/picture_worker.h"
#include "view/view_state.h"
#include "vps_scenes/network/tracked_heads.h"
#include "vps_viewer/window/window.h"

namespace vps::viewer {

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
  FollowedSession* followed = nullptr;  ///< what is shown is a session of vps render; null: it is not
  RenderScene drawn;
  ModelView models;  ///< whose meshes `drawn` has, where they are shown
  ViewState view;
  PictureArea area;
  PictureArea focus;  ///< the part of it that `view.camera` sees: of several pictures that under the cursor
  std::vector<PictureTile> tiles;       ///< pictures of a display file or of Spectral, in `area`; empty: none
  std::vector<std::string> tile_names;  ///< of them; empty: they have none
  std::size_t tile = 0;                 ///< that of `focus`
  scenes::Snapshot shown;               ///< before it is exploded
  scenes::Snapshot placed;              ///< what is drawn: `shown`, or its exploded view
  std::unique_ptr<LiveRun> run;
  LiveStatus status;                            ///< of the run, with the steps that were done before it
  HandWork work;                                ///< what has been put down
  bool is_at_work = false;                      ///< shows that, or a run of it; else the tour
  std::size_t first_step = 0, steps_known = 0;  ///< of the run, and of its steps
  std::vector<scenes::StepResult> before;       ///< steps that were done before the run
  int recordings = 0;                           ///< begun
  std::string run_hand;                         ///< kind of device in the run
  Timeline run_line;                            ///< its curves so far
  std::string hand;                             ///< kind of device that moves the part in the next run
  HandDrag drag;                                ///< of the mouse as a device
  Neighbours neighbours;
  std::unique_ptr<GapWatch> gaps;              ///< while the window is open, which it wakes
  scenes::RunFigures figures, figures_before;  ///< of the run, now and where its rates begin
  double figures_s = 0, figures_before_s = 0;  ///< by the clock
  std::optional<scenes::TrackedHeads> heads;   ///< of the display file
  std::unique_ptr<HeadsetSession> headset;     ///< while the window is open, which it wakes; null: none
  std::array<HeadsetHand, 2> hands;            ///< its controllers, as last seen
  std::optional<std::size_t> holding_hand;     ///< the controller that holds the part in hand
  std::deque<std::string> messages;            ///< of the window itself, the newest first
  std::string drawn_by;
  std::string picture_failure;  ///< why there is no picture, in words; empty: there is one
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
  /// Around the scene as it is shown.
  [[nodiscard]] Box box_W() const { return snapshotBounds(drawn, placed); }
  /// Whether the mouse moves the part in hand.
  [[nodiscard]] bool isByMouse() const { return run && !status.is_over && run_hand == "mouse"; }
  /// Whether a person moves it, by whatever device: those that are known push nothing back.
  [[nodiscard]] bool isByHand() const { return run && !status.is_over && isByPerson(run_hand); }
  [[nodiscard]] const Timeline& shownLine() const { return is_at_work ? run_line : line; }
};

// runs.cpp
/// Asks for the distances of the picked part and of the part in hand at the poses that are shown.
void watchGaps(Session& session);
/// Carries out what the view wants of runs and of what has been put down: start, stop, undo, redo, take.
void carryOutWork(Session& session, GlfwWindow& window);
/// Marks the picked place for all who watch the session, or takes the mark away, where the view wants it.
void carryOutPoint(Session& session);
/// Takes over what is new from the run, or shows what has been put down.
void followWork(Session& session);

/// Shows what is new in the session that the window follows.
void followSession(Session& session);

// panels.cpp
/// The panel at the right, the time axis below, and the list of keys. Sets session.area to what they leave.
void drawPanels(Session& session, const GlfwWindow& window);
/// Over the picture: why there is none.
void drawFailure(const Session& session);
// plots.cpp
/// The curves of the line over time, with a mark at now_s. A click sets *now_s.
void drawPlots(const Timeline& line, double* now_s, float scale, bool may_seek);
// mouse.cpp
/// Orbit, pan, zoom, section, picking, and the part in hand, over the picture.
void useMouse(Session& session);
// headset_hands.cpp
/// Looks for a headset, where it is wanted.
void beginHeadset(Session& session, GlfwWindow& window);
/// Shows it what is shown, and does what its controllers do.
void useHeadset(Session& session);
// path_marks.cpp
/// Over the picture: the planned path of the part in hand, and with axis snap the axis.
void drawPathMarks(const Session& session);
// pointer_marks.cpp
/// Over the picture: where people point at who watch the session.
void drawPointerMarks(const Session& session);
// hand_marks.cpp
/// Over the picture: the force on a person's hand as colour and number, and the spring from the grabbed point
/// to the mouse's cursor.
void drawHandMarks(const Session& session);

}  // namespace vps::viewer
