// SPDX-License-Identifier: BSD-3-Clause
// Runs in the window: start, stop, undo, redo, and free assembly.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "glfw/session.h"
#include "vps_device/metronome.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {
namespace {

/// Name of the next recording: "run.mcap", "run_2.mcap" and so on. A run after an undo has a file of its own.
std::string nextRecording(Session& session) {
  const std::string& first = session.options.record;
  if (first.empty() || ++session.recordings == 1) return first;
  const std::filesystem::path path = first;
  std::filesystem::path numbered = path;
  numbered.replace_filename(path.stem().string() + "_" + std::to_string(session.recordings) +
                            path.extension().string());
  return numbered.string();
}

std::string chapterName(const Session& session, std::size_t step) {
  return std::to_string(step + 1) + " " + session.scene.parts[session.scene.steps[step].part].part.name;
}

void tellVerdict(Chapter& chapter, const scenes::StepResult& step) {
  chapter.verdict = words(step.verdict);
  chapter.reason = step.reason.empty() ? step.failure_reason : step.reason;
}

/// Resets the time axis and the figures when a run or free assembly begins.
void beginLine(Session& session) {
  Timeline& line = session.run_line;
  line = {};
  line.chapters = {{session.work.isFree() ? "free assembly" : "before the first step", 0, ""}};
  for (std::size_t i = 0; i < session.before.size(); ++i) {
    line.chapters.push_back({chapterName(session, i), 0, ""});
    tellVerdict(line.chapters.back(), session.before[i]);
  }
  line.curves = liveCurves();
  session.figures = session.figures_before = {};
  session.figures_s = session.figures_before_s = device::monotonicSeconds();
  session.view.time_s = 0;
  session.view.is_playing = false;
}

/// @param part  in free assembly, the part to take in hand; none: the procedure's next step
void startRun(Session& session, GlfwWindow& window, std::optional<std::size_t> part = {}) {
  session.drag = HandDrag(session.scene.device.scale);
  LiveSettings settings;
  settings.record = nextRecording(session);
  settings.speed = session.options.speed;
  settings.models = session.options.models;
  settings.hand = session.run_hand = part && !isByPerson(session.hand) ? "mouse" : session.hand;
  settings.wish = session.drag.wish();
  settings.has_sound = session.options.has_sound;
  settings.snaps = session.view.snaps;
  session.is_at_work = true;
  session.first_step = part ? 0 : session.work.nextStep();
  session.steps_known = 0;
  session.before = session.work.results();
  beginLine(session);
  session.run =
      std::make_unique<LiveRun>(session.work.sceneToRun(part), settings, [&window] { window.wake(); });
  session.run->ask();
}

void stopRun(Session& session) {
  session.run.reset();
  session.status = {};
}

void backToTour(Session& session) {
  stopRun(session);
  session.work.begin(false);
  session.is_at_work = false;
  session.run_line = {};
  session.view.time_s = 0;
}

/// Ends the run and shows the parts that were put down, with no part in hand.
void rest(Session& session) {
  session.before = session.work.results();
  beginLine(session);
}

void goOn(Session& session, GlfwWindow& window) {
  if (session.work.isFree()) return rest(session);
  if (!session.work.isOver()) return startRun(session, window);
  rest(session);
  session.say("all steps are done; the key Z undoes the last step");
}

void undo(Session& session, GlfwWindow& window) {
  if (!session.is_at_work) return session.say("there is no step to undo; the key R runs the procedure");
  const bool was_in_hand = session.work.isFree() && session.run;
  stopRun(session);
  // In free assembly, a part in hand returns to the place where it was taken. In the procedure, the current
  // step begins anew if no step is done.
  if (!was_in_hand && !session.work.undo() && session.work.isFree()) session.say("there is no step to undo");
  goOn(session, window);
}

void redo(Session& session, GlfwWindow& window) {
  if (!session.is_at_work || !session.work.redo()) return session.say("there is no step to redo");
  stopRun(session);
  goOn(session, window);
}

void switchFree(Session& session) {
  if (session.work.isFree()) return backToTour(session);
  stopRun(session);
  session.work.begin(true);
  session.is_at_work = true;
  rest(session);
  session.view.wants_fit = true;  // free assembly lays the parts out side by side
  session.say("free assembly: click on a part; the key Enter takes it in hand and puts it down");
}

void takeOrPutDown(Session& session, GlfwWindow& window) {
  if (!session.work.isFree())
    return session.say("the key U begins free assembly, in which you can take any part");
  std::optional<std::size_t> held;
  if (session.run) {
    if (const scenes::BodySnapshot* body = partInHand(session.shown)) {
      held = body->part;
      session.work.putDown({body->part, body->X_WP});
    }
    stopRun(session);
  }
  const std::optional<PickedPlace>& picked = session.view.picked;
  if (picked && picked->part != held) return startRun(session, window, picked->part);
  if (!held) session.say("click on a part first, then take it");
  rest(session);
}

/// The last measured least distance from the part in hand to another part.
std::optional<double> clearanceOf(const Session& session, const scenes::Snapshot& shot) {
  const scenes::BodySnapshot* body = partInHand(shot);
  if (body == nullptr) return {};
  const std::optional<MeasuredGaps> measured = session.gaps->of(body->part);
  constexpr double kOld_s = 0.5;
  if (!measured || measured->gaps.empty() || shot.time_s - measured->time_s > kOld_s) return {};
  return measured->gaps.front().distance_m;
}

void addToCurves(Session& session, const scenes::Snapshot& shot) {
  Timeline& line = session.run_line;
  addInstant(line, shot, clearanceOf(session, shot));
  session.view.time_s = shot.time_s;
  if (shot.step < 0) return;
  addChapters(line, static_cast<std::size_t>(shot.step), shot.time_s, [&](std::size_t step) {
    return session.work.isFree() ? session.scene.parts[shot.target_part].part.name
                                 : chapterName(session, step);
  });
}

/// Stores the steps that the run has finished since the last call.
void noteSteps(Session& session) {
  scenes::AssembleResult& result = session.status.result;
  if (session.work.isFree()) return;
  for (; session.steps_known < result.steps.size(); ++session.steps_known) {
    if (result.finished.bodies.empty()) break;
    const std::size_t part = session.scene.steps[session.first_step + session.steps_known].part;
    session.work.putDown({part, result.finished.bodies[part].X_WP}, result.steps[session.steps_known]);
  }
  addEarlierSteps(session.before, session.scene.steps.size(), result);
  for (std::size_t i = 0; i < result.steps.size() && i + 1 < session.run_line.chapters.size(); ++i)
    tellVerdict(session.run_line.chapters[i + 1], result.steps[i]);
}

/// Stores the run's counts; rates are averaged over the last second.
void keepFigures(Session& session, const scenes::RunFigures& figures) {
  constexpr double kRate_s = 1;
  const double now_s = device::monotonicSeconds();
  if (session.figures.ticks == 0) {  // the run's first counts: models were built before, which takes time
    session.figures = session.figures_before = figures;
    session.figures_s = session.figures_before_s = now_s;
  }
  if (now_s - session.figures_before_s >= 2 * kRate_s) {
    session.figures_before = session.figures;
    session.figures_before_s = session.figures_s;
  }
  if (now_s - session.figures_s < kRate_s) return;
  session.figures = figures;
  session.figures_s = now_s;
}

/// Marks the clicked place for all who watch; a second call with the same place removes the mark.
void pointAtPicked(Session& session) {
  FollowedSession& followed = *session.followed;
  const std::optional<PickedPlace>& picked = session.view.picked;
  const bool is_new = picked && picked->p_W != followed.pointing();
  if (!is_new && !followed.pointing())
    return session.say("click on a place first; the key M then marks it for all");
  followed.point(is_new ? std::optional(picked->p_W) : std::nullopt);
  session.say(is_new ? "all who watch see the mark; the key M removes it" : "the mark is removed");
}

}  // namespace

void followWork(Session& session) {
  if (!session.run) {
    session.shown = session.work.snapshot();
    return;
  }
  session.run->snap(session.view.snaps);
  session.run->listenAt(session.view.camera.pose());
  session.status = session.run->status();
  for (const std::string& words : session.run->takeMessages()) session.say(words);
  noteSteps(session);
  if (std::optional<scenes::Snapshot> shot = session.run->take()) {
    if (shot->step >= 0) shot->step += static_cast<int>(session.first_step);
    if (!session.status.is_over) addToCurves(session, *shot);
    if (shot->figures) keepFigures(session, *shot->figures);
    session.drag.watch(*shot);
    session.shown = std::move(*shot);
    session.run->ask();
  }
}

void watchGaps(Session& session) {
  std::vector<std::size_t> parts;
  if (const scenes::BodySnapshot* body = partInHand(session.shown)) parts.push_back(body->part);
  if (session.view.picked && std::ranges::find(parts, session.view.picked->part) == parts.end())
    parts.push_back(session.view.picked->part);
  session.gaps->request(session.shown, std::move(parts));
}

void followSession(Session& session) {
  FollowedSession& followed = *session.followed;
  if (!session.is_at_work) {
    session.is_at_work = true;
    beginLine(session);
  }
  followed.poll();
  followed.listenAt(session.view.camera.pose());
  for (const std::string& words : followed.takeMessages()) session.say(words);
  if (std::optional<scenes::Snapshot> shot = followed.take()) {
    addToCurves(session, *shot);
    session.shown = std::move(*shot);
  }
  for (const auto& [step, verdict] : followed.steps())
    if (const auto chapter = static_cast<std::size_t>(step) + 1;
        step >= 0 && chapter < session.run_line.chapters.size())
      session.run_line.chapters[chapter].verdict = words(verdict);
}

void carryOutPoint(Session& session) {
  if (!std::exchange(session.view.wants_point, false)) return;
  if (session.followed == nullptr)
    return session.say("marks are for people who watch a session together: vps view --session NAME");
  pointAtPicked(session);
}

void carryOutWork(Session& session, GlfwWindow& window) {
  ViewState& view = session.view;
  if (std::exchange(view.wants_mouse, false)) {
    session.hand = "mouse";
    view.wants_run = true;
  }
  const bool wants[] = {std::exchange(view.wants_run, false), std::exchange(view.wants_undo, false),
                        std::exchange(view.wants_redo, false), std::exchange(view.wants_free, false),
                        std::exchange(view.wants_take, false)};
  if (std::exchange(view.wants_one_step, false) && session.run) session.run->oneStep();
  if (std::ranges::none_of(wants, [](bool wanted) { return wanted; })) return;
  if (session.followed != nullptr)
    return session.say("this window only watches the session; vps render runs it with the session's device");
  if (session.is_recording) return session.say("the window only plays a recording; vps replay runs it again");
  if (wants[0] && session.is_at_work)
    backToTour(session);
  else if (wants[0])
    startRun(session, window);
  if (wants[1]) undo(session, window);
  if (wants[2]) redo(session, window);
  if (wants[3]) switchFree(session);
  if (wants[4]) takeOrPutDown(session, window);
}

}  // namespace vps::viewer
