// SPDX-License-Identifier: BSD-3-Clause
// The window's loop: events, panels, and requests for pictures.
#include "vps_viewer/window/window.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>

#include "glfw/session.h"
#include "sound/live_sound.h"
#include "view/procedure_view.h"
#include "vps/errors.h"
#include "vps_scenes/run/replay.h"

namespace vps::viewer {
namespace {

// A larger window stretches a picture of this size, since 4096 x 4096 pixels with their samples take 1 GiB.
constexpr int kGreatestPicture = 4096;
constexpr double kFrame_s = 1.0 / 60, kIdle_s = 0.5;
constexpr std::chrono::milliseconds kSessionPoll{20};

PictureSize pictureSize(const PictureArea& area) {
  const double shrink =
      std::min(1.0, double(kGreatestPicture) / std::max({1, area.size.width, area.size.height}));
  return {static_cast<int>(area.size.width * shrink), static_cast<int>(area.size.height * shrink)};
}

void typed(Session& session, const std::string& key) {
  if (session.run && key == "Space") return session.run->pause(!session.run->isPaused());
  if (session.followed != nullptr && key == "Space")
    return session.say("a session cannot be paused from this window");
  for (const KeyBinding& binding : keyBindings())
    if (key == binding.key) apply(binding.action, session.view, session.shownLine(), session.box_W());
}

void takePicture(Session& session, PictureWorker& worker, GlfwWindow& window) {
  const std::string failure = worker.failure();
  if (failure != session.picture_failure && !failure.empty()) session.say(failure);
  session.picture_failure = failure;
  std::optional<DrawnPicture> picture = worker.take();
  if (!picture) return;
  window.setPicture(picture->image);
  session.picture_ms = 1e3 * picture->wall_s;
  session.is_draft = picture->is_draft;
  session.drawn_by = worker.description().substr(0, worker.description().find(' '));
}

void addTiles(Session& session, const scenes::Display& display) {
  std::vector<DisplayOutput> outputs = outputsOf(display, session.view.stereo);
  session.view.outputs = outputs.size();
  if (session.view.output && *session.view.output >= outputs.size()) session.view.output.reset();
  if (session.view.output) outputs = {outputs[*session.view.output]};
  const std::vector<TilePlace> places = tilePlaces(outputs, session.area.size);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const DisplayOutput& output = outputs[i];
    session.tiles.push_back(
        {viewer::eyesOf(display, display.screens[output.screen], display.viewers[output.viewer]), places[i],
         output.eye});
    session.tile_names.push_back(output.name);
  }
}

/// Two eyes, left and right of the camera, for pictures of the given size.
EyePair eyesAbout(const Camera& camera, PictureSize size) {
  return viewer::eyesOf(camera, kEyeShare * (camera.eye_W - camera.target_W).norm(),
                        double(size.width) / std::max(1, size.height));
}

/// Places the pictures of both eyes side by side, for two projectors that share one desktop.
void addSpectralTiles(Session& session) {
  const PictureSize half = {session.area.size.width / 2, session.area.size.height};
  const EyePair eyes = eyesAbout(session.view.camera, half);
  session.tiles = {{eyes, {0, 0, half.width, half.height}, -1},
                   {eyes, {half.width, 0, half.width, half.height}, 1}};
}

/// Lays out the tiles of the picture area, and finds the tile under the mouse.
void layOut(Session& session) {
  session.tiles.clear();
  session.tile_names.clear();
  session.focus = session.area;
  if (session.heads) {
    addTiles(session, session.heads->at(session.shown.time_s));
    for (const std::string& news : session.heads->takeNews()) session.say(news);
  } else if (session.view.stereo == StereoMode::Spectral) {
    addSpectralTiles(session);
  }
  if (session.tiles.empty()) return;
  const ImGuiIO& io = ImGui::GetIO();
  for (std::size_t i = 0; i < session.tiles.size() && !ImGui::IsAnyMouseDown(); ++i)
    if (session.tiles[i].place.has(io.MousePos.x - session.area.x, io.MousePos.y - session.area.y))
      session.tile = i;
  session.tile = std::min(session.tile, session.tiles.size() - 1);
  const PictureTile& used = session.tiles[session.tile];
  session.focus = {session.area.x + static_cast<float>(used.place.x),
                   session.area.y + static_cast<float>(used.place.y),
                   {used.place.width, used.place.height}};
  if (session.heads) session.view.camera = middleEye(used.eyes);
}

/// Switches interleaved stereo off in a window that is larger than the greatest texture: stretching the
/// picture would mix the rows of both eyes.
void limitStereo(Session& session, const GlfwWindow& window) {
  const int most = window.greatestPicture();
  if (session.view.stereo != StereoMode::Interleaved ||
      (session.area.size.width <= most && session.area.size.height <= most))
    return;
  session.say("interleaved stereo needs a window of at most " + std::to_string(most) + " pixels across");
  session.view.stereo = StereoMode::Mono;
}

/// Requests both eyes' pictures side by side, one for each buffer. In stereo modes other than Mono both
/// buffers get the same picture, since that picture holds both eyes already.
void addStereoBuffers(PictureRequest& wanted) {
  const int width = wanted.options.width, height = wanted.options.height;
  EyePair eyes = wanted.eyes ? *wanted.eyes : eyesAbout(wanted.camera, {width, height});
  wanted.options.width = 2 * width;
  if (wanted.stereo == StereoMode::Mono && wanted.tiles.empty()) {
    wanted.eyes.reset();
    wanted.tiles = {{{eyes.left, eyes.left}, {0, 0, width, height}, 0},
                    {{eyes.right, eyes.right}, {width, 0, width, height}, 0}};
    return;
  }
  if (wanted.tiles.empty()) wanted.tiles = {{eyes, {0, 0, width, height}, 0}};
  wanted.eyes.reset();
  for (std::size_t i = 0, count = wanted.tiles.size(); i < count; ++i) {
    PictureTile again = wanted.tiles[i];
    again.place.x += width;
    wanted.tiles.push_back(again);
  }
  if (wanted.rows.width > 0) wanted.rows.width *= 2;
}

void askForPicture(Session& session, PictureWorker& worker, const GlfwWindow& window) {
  const double size_m = snapshotBounds(session.drawn, session.shown).size().norm();
  session.placed = exploded(session.scene, session.shown, session.view.explode, size_m);
  if (std::exchange(session.view.wants_fit, false))
    session.view.camera = fitted(session.view.camera, session.box_W(), session.view.size);
  const PictureSize size = pictureSize(session.area);
  if (size.width < 16 || size.height < 16) return;
  PictureRequest wanted = {
      session.placed, session.view.camera, session.view.draw, session.view.stereo, {}, {}, {}};
  if (session.tiles.size() == 1 && session.tiles[0].eye == 0)
    wanted.eyes = session.tiles[0].eyes;
  else if (session.tiles.empty() && wanted.stereo != StereoMode::Mono)
    wanted.eyes = eyesAbout(wanted.camera, size);
  else
    wanted.tiles = session.tiles;
  for (PictureTile& tile : wanted.tiles) {
    const double shrink = double(size.width) / std::max(1, session.area.size.width);
    const auto scaled = [shrink](int px) { return static_cast<int>(std::lround(shrink * px)); };
    tile.place = {scaled(tile.place.x), scaled(tile.place.y), scaled(tile.place.width),
                  scaled(tile.place.height)};
  }
  if (wanted.stereo == StereoMode::Interleaved)
    wanted.rows = {session.area.size.width, session.area.size.height,
                   window.screenRow() + static_cast<int>(session.area.y)};
  if (session.heads) wanted.options.show_ground = false;  // the room has a floor of its own
  wanted.options.width = size.width;
  wanted.options.height = size.height;
  if (window.hasStereo()) addStereoBuffers(wanted);
  worker.request(wanted);
}

/// Saves the whole window as a PNG file.
void savePicture(Session& session, const GlfwWindow& window) {
  std::string file;
  do {
    file = session.options.pictures + "_" + std::to_string(++session.pictures) + ".png";
  } while (std::filesystem::exists(file));
  try {
    savePng(window.readBack(), file);
    session.say("saved " + file);
  } catch (const std::exception& error) {
    session.say(error.what());
  }
}

/// Draws the name of each tile in its upper left corner, if there are several.
void drawTileNames(const Session& session) {
  if (session.tiles.size() < 2 || session.view.is_full_screen) return;
  for (std::size_t i = 0; i < session.tile_names.size(); ++i) {
    const TilePlace& place = session.tiles[i].place;
    const ImVec2 at(session.area.x + static_cast<float>(place.x) + 8,
                    session.area.y + static_cast<float>(place.y) + 6);
    const ImVec2 size = ImGui::CalcTextSize(session.tile_names[i].c_str());
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2},
                       IM_COL32(255, 255, 255, 200), 4);
    list.AddText(at, IM_COL32(20, 20, 20, 255), session.tile_names[i].c_str());
  }
}

/// Index of the output that options.output names. Throws LoadError if the display file has no such output.
std::optional<std::size_t> firstOutput(const WindowOptions& options) {
  if (options.output.empty() || !options.display) return {};
  std::string names;
  const std::vector<DisplayOutput> outputs = outputsOf(*options.display, options.stereo);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].name == options.output) return i;
    names += (i > 0 ? ", " : "") + outputs[i].name;
  }
  throw LoadError(options.display->file, "",
                  "has no output '" + options.output + "'; its outputs are " + names);
}

void fillScreen(Session& session, GlfwWindow& window) {
  if (window.isFullScreen() == session.view.is_full_screen) return;
  const int monitor = std::max(0, session.options.full_screen - 1);
  if (!window.setFullScreen(session.view.is_full_screen, monitor)) {
    session.view.is_full_screen = window.isFullScreen();
    session.say("there is no monitor " + std::to_string(monitor + 1) +
                " to fill; monitors are counted from 1");
  }
}

void drawFrame(Session& session, GlfwWindow& window, PictureWorker& worker) {
  window.beginFrame(session.view.is_dark);
  drawPanels(session, window);
  limitStereo(session, window);
  layOut(session);
  session.view.size = session.focus.size;
  useMouse(session);
  // The key M follows the click that picks a place. Dear ImGui reports a press and its release one frame
  // apart, so the mark waits until no button is down.
  if (!ImGui::IsAnyMouseDown()) carryOutPoint(session);
  askForPicture(session, worker, window);
  if (window.hasPicture())
    ImGui::GetBackgroundDrawList()->AddImage(window.picture(), {session.area.x, session.area.y},
                                             {session.area.x + static_cast<float>(session.area.size.width),
                                              session.area.y + static_cast<float>(session.area.size.height)});
  if (session.view.stereo == StereoMode::Mono) {  // marks over the picture have no depth
    drawPathMarks(session);
    drawPointerMarks(session);
  }
  drawHandMarks(session);
  drawTileNames(session);
  drawFailure(session);
  window.endFrame();
  if (std::exchange(session.view.wants_picture_file, false)) savePicture(session, window);
  window.present();
}

void loop(Session& session, GlfwWindow& window) {
  using Clock = std::chrono::steady_clock;
  session.shown = session.placed = session.line.at(0);
  const PictureSize size = window.size();
  session.view.camera = cameraFor(standardViews()[0], session.box_W(), size);
  session.view.draw.show_legend = false;
  session.view.draw.supersampling = 1;
  // Each point and each cube has edges of its own, which would darken the picture.
  if (!session.options.show.isNone()) session.view.draw.show_edges = false;
  session.view.is_dark = session.view.draw.is_dark = session.options.is_dark;
  session.view.speed = session.options.speed > 0 ? session.options.speed : 1;
  session.view.wants_run = session.options.runs;
  session.view.stereo = session.options.stereo;
  session.view.is_full_screen = session.options.full_screen > 0;
  // Run, gap watch and headset wake the window from their threads, so they end before it, also after an
  // exception.
  const struct Ending {
    Session& session;
    ~Ending() {
      session.run.reset();
      session.gaps.reset();
      session.headset.reset();
    }
  } ending{session};
  session.gaps = std::make_unique<GapWatch>(session.scene, [&window] { window.wake(); });
  PictureWorker worker(session.drawn, [&window] { window.wake(); });
  beginHeadset(session, window);
  Clock::time_point last = Clock::now();
  bool is_fitted = false;
  const auto is_stopped = [&] { return session.options.stop != nullptr && session.options.stop->load(); };
  while (!window.isClosed() && !session.view.wants_close && !is_stopped()) {
    const bool moves = session.view.is_playing || (session.heads && session.heads->isLive()) ||
                       (session.followed != nullptr && !session.followed->isOver());
    const bool has_news = window.wait(moves ? kFrame_s : kIdle_s);
    const Clock::time_point now = Clock::now();
    advance(session.view, session.line, std::chrono::duration<double>(now - last).count());
    last = now;
    carryOutWork(session, window);
    if (session.followed != nullptr)
      followSession(session);
    else if (session.is_at_work)
      followWork(session);
    else
      session.shown = session.line.at(session.view.time_s);
    watchGaps(session);
    useHeadset(session);
    takePicture(session, worker, window);
    fillScreen(session, window);
    const PictureSize size_now = window.size();
    if (size_now.width <= 0 || size_now.height <= 0) continue;  // minimised
    if (has_news || moves) drawFrame(session, window, worker);
    if (!std::exchange(is_fitted, true))
      session.view.camera = cameraFor(standardViews()[0], session.box_W(), session.area.size);
  }
}

void openAndLoop(Session& session, const std::string& title) {
  for (const std::string& note : session.options.notes) session.say(note);
  session.view.output = firstOutput(session.options);
  GlfwWindow window(title, {session.options.width, session.options.height},
                    session.options.has_stereo_buffers);
  if (session.options.has_stereo_buffers && !window.hasStereo()) {
    const std::string words =
        "this driver has no buffer for each eye (quad-buffered stereo); the key S chooses another stereo "
        "mode";
    session.say(words);
    if (session.options.say) session.options.say(words);
  }
  window.on_key = [&session](const std::string& key) { typed(session, key); };
  loop(session, window);
}

}  // namespace

std::string missingForWindow() {
  return "";
}

void viewScene(const scenes::Scene& scene, const WindowOptions& options) {
  if (options.has_sound) askForShortPeriods();
  Session session(scene, options);
  session.line = sceneTour(scene);
  for (const std::string& warning : scene.warnings) session.say(warning);
  openAndLoop(session, scene.name + " - vps view");
}

void viewRecording(const device::RecordedRun& run, const WindowOptions& options) {
  const scenes::Scene scene = scenes::recordedScene(run);
  Session session(scene, options);
  session.line = recordedTimeline(scene, run);
  session.is_recording = true;
  openAndLoop(session, run.file + " - vps view");
}

std::optional<scenes::Verdict> viewSession(const WindowOptions& options) {
  requireDisplay();  // checked before the wait for the session, which may be long
  if (options.has_sound) askForShortPeriods();
  const auto is_stopped = [&] { return options.stop != nullptr && options.stop->load(); };
  std::unique_ptr<scenes::SessionWatcher> watcher;
  for (bool has_said = false; !is_stopped(); has_said = true) {
    watcher = scenes::SessionWatcher::join(options.session, options.network);
    if (watcher != nullptr) break;
    if (!has_said && options.say)
      options.say("waiting for the session '" + options.session + "'; vps render starts it");
    std::this_thread::sleep_for(kSessionPoll);
  }
  if (watcher == nullptr) return {};
  FollowedSession followed(std::move(watcher), options.session, options.network, options.has_sound);
  Session session(followed.scene(), options);
  session.line = sceneTour(followed.scene());
  session.followed = &followed;
  openAndLoop(session, followed.scene().name + ", session " + options.session + " - vps view");
  return followed.verdict();
}

}  // namespace vps::viewer
