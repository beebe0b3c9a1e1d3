// SPDX-License-Identifier: BSD-3-Clause
#include "web/hub.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "mesh/scene_meshes.h"
#include "run/presentation.h"
#include "vps_device/metronome.h"
#include "vps_scenes/cad/colors.h"
#include "web/web_files.h"

namespace vps::viewer {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kKeptNews = 50;
constexpr int kMostRefused = 10;
// Triangles of all fine parts together, and of one coarse part, which a browser shows until the fine part has
// arrived.
constexpr std::size_t kFineTriangles = 400000, kCoarseTriangles = 10000;

std::string jsonText(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json vectorJson(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}
Json poseJson(const Pose& X) {
  const Eigen::Quaterniond q(X.R);
  return {X.p.x(), X.p.y(), X.p.z(), q.x(), q.y(), q.z(), q.w()};
}

std::string colorText(const std::array<float, 3>& linear) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", scenes::srgbByte(linear[0]), scenes::srgbByte(linear[1]),
                scenes::srgbByte(linear[2]));
  return text;
}

Json partsJson(const RenderScene& drawn, const scenes::Scene& scene) {
  Json parts = Json::array();
  for (std::size_t i = 0; i < drawn.size(); ++i)
    parts.push_back({{"name", scene.parts[i].part.name},
                     {"color", colorText(drawn[i].color)},
                     {"fixed", drawn[i].is_fixed},
                     {"pose", poseJson(drawn[i].X_WP)},
                     {"triangles", drawn[i].mesh->triangles.size()}});
  return parts;
}

Json stepsJson(const scenes::Scene& scene) {
  Json steps = Json::array();
  for (const scenes::SceneStep& step : scene.steps)
    steps.push_back({{"part", step.part},
                     {"name", scene.parts[step.part].part.name},
                     {"target", poseJson(step.X_WP_target)}});
  return steps;
}

/// Bounds of the fixed parts, and of each step's part at its start and target.
Box boxAround(const RenderScene& drawn, const scenes::Scene& scene) {
  const std::vector<PartExtent> extents = partExtents(drawn);
  scenes::Snapshot shot;
  for (const scenes::SceneStep& step : scene.steps)
    for (const Pose& X_WP : {step.X_WP_start, step.X_WP_target})
      shot.bodies.push_back({step.part, X_WP, scenes::BodyRole::Mounted});
  return visibleBounds(extents, shot, false, false);
}

/// Path of a part's file: "/part/RUN/PART/LEVEL.glb".
struct PartName {
  int run = 0;
  std::size_t part = 0;
  bool is_coarse = false;
};
std::optional<PartName> partNameOf(std::string_view target) {
  constexpr std::string_view kStart = "/part/";
  if (!target.starts_with(kStart)) return {};
  PartName name;
  const char* end = target.data() + target.size();
  const auto run = std::from_chars(target.data() + kStart.size(), end, name.run);
  if (run.ec != std::errc() || run.ptr == end || *run.ptr != '/') return {};
  const auto part = std::from_chars(run.ptr + 1, end, name.part);
  if (part.ec != std::errc()) return {};
  const std::string_view level(part.ptr, static_cast<std::size_t>(end - part.ptr));
  if (level != "/coarse.glb" && level != "/fine.glb") return {};
  name.is_coarse = level == "/coarse.glb";
  return name;
}

}  // namespace

int WebHub::join(BrowserEnd& end) {
  const int number = ++last_browser_;
  Browser& browser = browsers_.emplace(number, end).first->second;
  greet(number, browser);
  for (const std::string& news : news_) end.sendText(news);
  for (const auto& [other, pointer] : pointers_) end.sendText(pointer);
  tellAll(jsonText({{"watchers", browsers_.size()}}));
  return number;
}

void WebHub::leave(int browser) {
  if (browsers_.erase(browser) == 0) return;
  if (pointers_.contains(browser)) {
    showPointer(browser, {});
    run_.point(browser, {});
  }
  if (holder_ == browser) {
    if (HandDrag* drag = run_.drag(); drag != nullptr && shot_) drag->letGo(shot_->snapshot);
    holder_ = 0;
    tellHand();
  }
  tellAll(jsonText({{"watchers", browsers_.size()}}));
}

std::string WebHub::helloText(int number) const {
  return R"({"hello":{"you":)" + std::to_string(number) + R"(,"present_ms":)" +
         std::to_string(kPresentAfter_ns / 1'000'000) + R"(,"run":)" +
         std::to_string(has_scene_ ? run_number_ : 0) + (has_scene_ ? "," + scene_text_ : "") + "}}";
}

std::string WebHub::handText() const {
  return jsonText({{"hand", {{"may_take", may_take_}, {"holder", holder_}}}});
}

void WebHub::greet(int number, Browser& browser) {
  browser.coder = SnapshotCoder(center_W_);
  browser.drawn = 0;
  browser.seen = 0;
  browser.end->sendText(helloText(number));
  browser.end->sendText(handText());
  browser.end->sendText(jsonText({{"doing", doing_}}));
  browser.end->sendText(playbackText());
}

std::string WebHub::playbackText() const {
  if (!playback_) return jsonText({{"playback", nullptr}});
  return jsonText({{"playback",
                    {{"begin_s", playback_->begin_s},
                     {"end_s", playback_->end_s},
                     {"is_playing", playback_->is_playing}}}});
}

void WebHub::tellAll(const std::string& text) {
  for (auto& [number, browser] : browsers_) browser.end->sendText(text);
}
void WebHub::tellHand() {
  tellAll(handText());
}

void WebHub::showPointer(int who, const std::optional<Vec3>& p_W) {
  Json place = nullptr;
  if (p_W) place = vectorJson(*p_W);
  const std::string text = jsonText({{"pointer", {{"who", who}, {"p", place}}}});
  if (p_W)
    pointers_[who] = text;
  else
    pointers_.erase(who);
  tellAll(text);
}

void WebHub::beginScene() {
  run_number_ = run_.number();
  const scenes::Scene* scene = run_.scene();
  has_scene_ = scene != nullptr;
  may_take_ = run_.drag() != nullptr;
  holder_ = 0;
  shot_.reset();
  sounds_.reset();
  shots_ = 0;
  pointers_.clear();
  meshes_.clear();
  files_.clear();
  if (has_scene_) {
    const RenderScene drawn = drawnMeshes(*scene);
    const Box box = boxAround(drawn, *scene);
    center_W_ = box.center();
    radius_m_ = std::max(1e-6, 0.5 * box.size().norm());
    const std::string object = jsonText({{"name", scene->name},
                                         {"center", vectorJson(center_W_)},
                                         {"radius", radius_m_},
                                         {"parts", partsJson(drawn, *scene)},
                                         {"steps", stepsJson(*scene)}});
    scene_text_ = object.substr(1, object.size() - 2);
  }
  for (auto& [number, browser] : browsers_) greet(number, browser);
}

void WebHub::poll(double now_s) {
  run_.poll();
  if (run_.number() != run_number_ || (run_.scene() != nullptr) != has_scene_) beginScene();
  if (const bool may_take = run_.drag() != nullptr; may_take != may_take_) {
    may_take_ = may_take;
    if (!may_take) holder_ = 0;
    tellHand();
  }
  if (const std::optional<Playback> playback = run_.playback(); playback != playback_) {
    playback_ = playback;
    tellAll(playbackText());
  }
  for (const WatchedNews& news : run_.takeNews()) {
    Json json = {{"time_s", news.time_s}, {"text", news.text}};
    if (news.verdict) json["verdict"] = toText(*news.verdict);
    news_.push_back(jsonText({{"news", std::move(json)}}));
    if (news_.size() > kKeptNews) news_.pop_front();
    tellAll(news_.back());
  }
  for (const scenes::SessionPointer& pointer : run_.takePointers()) showPointer(pointer.who, pointer.p_W);
  if (std::string doing = run_.doing(); doing != doing_) {
    doing_ = std::move(doing);
    tellAll(jsonText({{"doing", doing_}}));
  }
  if (std::optional<WatchedShot> shot = run_.takeShot()) {
    shot_ = std::move(shot);
    ++shots_;
    if (HandDrag* drag = run_.drag()) drag->watch(shot_->snapshot);
    if (sounds_) sounds_->hear(shot_->snapshot, shot_->taken_ns);
  }
  sendSounds();
  if (shot_) sendShots(now_s);
}

void WebHub::sendSounds() {
  const bool is_heard = std::any_of(browsers_.begin(), browsers_.end(),
                                    [](const auto& entry) { return entry.second.has_sound; });
  if (!is_heard || !has_scene_) return sounds_.reset();
  if (!sounds_) sounds_ = std::make_unique<BlowSounds>(*run_.scene());
  for (const BlowSound& sound : sounds_->take()) {
    const std::string bytes = blowBytes(sound);
    for (auto& [number, browser] : browsers_)
      if (browser.has_sound && browser.end->isFree()) browser.end->sendBytes(bytes);
  }
}

void WebHub::sendShots(double now_s) {
  for (auto& [number, browser] : browsers_) {
    const bool is_behind = browser.coder.number() - browser.drawn >= kMostUnseen;
    if (browser.seen == shots_ || is_behind || now_s < browser.next_s || !browser.end->isFree()) continue;
    browser.seen = shots_;
    browser.next_s = std::max(browser.next_s + period_s_, now_s);
    browser.end->sendBytes(browser.coder.encode(*shot_));
  }
}

bool WebHub::hear(int number, std::string_view text, double now_s) {
  const auto found = browsers_.find(number);
  if (found == browsers_.end()) return false;
  Browser& browser = found->second;
  if (!browser.rate.take(now_s)) return false;
  const std::optional<BrowserMessage> message = readBrowserMessage(text);
  if (!message) return ++browser.refused <= kMostRefused;
  obey(number, browser, *message);
  return true;
}

void WebHub::obey(int number, Browser& browser, const BrowserMessage& message) {
  switch (message.word) {
    case BrowserWord::Ack:
      // A number that was not sent yet is ignored, since otherwise the browser would get more snapshots than
      // it draws.
      if (message.number > browser.drawn && message.number <= browser.coder.number())
        browser.drawn = static_cast<std::uint32_t>(message.number);
      return;
    case BrowserWord::Ping: {
      const double now_ms = 1e-6 * static_cast<double>(device::monotonicClock().now_ns());
      return browser.end->sendText(jsonText({{"pong", message.number}, {"now_ms", now_ms}}));
    }
    case BrowserWord::Sound:
      browser.has_sound = message.number > 0;
      return;
    case BrowserWord::Play:
      return run_.play(message.number > 0);
    case BrowserWord::Seek:
      return run_.seek(message.number);
    case BrowserWord::Point:
      showPointer(number, message.vector);
      return run_.point(number, message.vector);
    default:
      return obeyHand(number, message);
  }
}

void WebHub::obeyHand(int number, const BrowserMessage& message) {
  HandDrag* drag = run_.drag();
  if (message.word == BrowserWord::Take) {
    if (drag != nullptr && holder_ == 0) holder_ = number;
    return tellHand();
  }
  if (drag == nullptr || holder_ != number || !shot_) return;
  switch (message.word) {
    case BrowserWord::Leave:
      drag->letGo(shot_->snapshot);
      holder_ = 0;
      return tellHand();
    case BrowserWord::Grab:
      return drag->grab(*message.vector, shot_->snapshot);
    case BrowserWord::Move:
      // The cursor must stay near the scene, so that nobody moves the handle too far away to bring it back.
      if (drag->isGrabbed() && (drag->cursorPoint() + *message.vector - center_W_).norm() <= 4 * radius_m_)
        drag->move(*message.vector);
      return;
    case BrowserWord::Turn:
      if (drag->isGrabbed() && message.vector->norm() <= 3.2) drag->turn(*message.vector);
      return;
    case BrowserWord::Drop:
      return drag->letGo(shot_->snapshot);
    default:
      return;
  }
}

std::shared_ptr<const std::string> WebHub::partFile(std::string_view target) {
  const std::optional<PartName> name = partNameOf(target);
  const scenes::Scene* scene = run_.scene();
  if (!name || scene == nullptr || !has_scene_ || name->run != run_number_ ||
      name->part >= scene->parts.size())
    return nullptr;
  std::shared_ptr<const std::string>& file = files_[{name->part, name->is_coarse}];
  if (file) return file;
  std::size_t total = 0;
  for (const scenes::ScenePart& part : scene->parts) total += part.part.mesh.triangles.size();
  const scenes::Part& part = scene->parts[name->part].part;
  const Mesh& mesh = part.mesh;
  const auto found = meshes_.try_emplace(name->part);
  if (found.second) found.first->second = buildShadingMesh(mesh, kCreaseAngle_rad, &part.face_colors);
  const double share = std::min(1.0, static_cast<double>(kFineTriangles) / static_cast<double>(total));
  const std::size_t wanted =
      name->is_coarse ? kCoarseTriangles
                      : static_cast<std::size_t>(share * static_cast<double>(mesh.triangles.size()));
  file = std::make_shared<const std::string>(partGlb(found.first->second, wanted, !name->is_coarse));
  return file;
}

}  // namespace vps::viewer
