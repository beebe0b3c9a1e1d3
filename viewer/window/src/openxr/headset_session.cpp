// SPDX-License-Identifier: BSD-3-Clause
#include "run/headset_session.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "openxr/controllers.h"
#include "openxr/eye_pictures.h"
#include "openxr/xr_instance.h"
#include "view/table_room.h"
#include "vps_device/metronome.h"
#include "vps_viewer/draw/renderer.h"

namespace vps::viewer {
namespace {

constexpr XrViewConfigurationType kTwoEyes = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr double kLeave_s = 1;      // assumed: a runtime ends a session within a frame or two
constexpr int kGreatestEye = 4096;  // limits the memory for samples, as for the window's picture

/// A pyramid that shows a controller, with its tip at the origin, pointing along -z.
Mesh pointerMesh(double scale) {
  const double length = 0.12 / scale, half = 0.018 / scale;
  Mesh mesh;
  mesh.vertices = {Vec3::Zero(), Vec3(-half, -half, length), Vec3(half, -half, length),
                   Vec3(half, half, length), Vec3(-half, half, length)};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
  return mesh;
}

/// The blend mode that the runtime prefers.
XrEnvironmentBlendMode firstBlendMode(const XrConnection& connection) {
  const auto ask = [&](std::uint32_t room, std::uint32_t& count, XrEnvironmentBlendMode* modes) {
    check(xrEnumerateEnvironmentBlendModes(connection.instance(), connection.system(), kTwoEyes, room, &count,
                                           modes),
          "xrEnumerateEnvironmentBlendModes");
  };
  std::uint32_t count = 0;
  ask(0, count, nullptr);
  std::vector<XrEnvironmentBlendMode> modes(count, XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
  ask(count, count, modes.data());
  return modes.empty() ? XR_ENVIRONMENT_BLEND_MODE_OPAQUE : modes.front();
}

HeadsetEye eyeOf(const XrView& view) {
  return {poseOf(view.pose), std::tan(view.fov.angleLeft), std::tan(view.fov.angleRight),
          std::tan(view.fov.angleDown), std::tan(view.fov.angleUp)};
}

/// Quality of the pictures, lowered so that drawing keeps the headset's frame rate. Level 0: full quality;
/// higher levels: drafts with fewer and fewer pixels.
class Effort {
 public:
  [[nodiscard]] DrawOptions apply(DrawOptions options) const {
    options.supersampling = 1;
    options.is_draft = level_ > 0;
    if (level_ > 1) {
      options.width = pictureLength_px(options.width / level_);
      options.height = pictureLength_px(options.height / level_);
    }
    return options;
  }
  void took(double wall_s, double period_s) {
    if (wall_s > period_s && level_ < kLeast) ++level_;
    if (wall_s < 0.2 * period_s && level_ > 0)
      --level_;  // a full picture takes several times as long as a draft
  }

 private:
  static constexpr int kLeast = 3;
  int level_ = 1;
};

}  // namespace

struct HeadsetSession::Work {
  Work(const RenderScene& drawn, const Box& box, std::function<void()> news)
      : scene(drawn),
        box_W(box),
        room(onTable(box)),
        pointer(pointerMesh(room.scale)),
        on_news(std::move(news)) {
    for (int i = 0; i < 2; ++i) scene.push_back({&pointer, {0.85f, 0.62f, 0.1f}, false, {}, nullptr});
  }
  void run();
  void begin(XrSession& session);
  void loop(XrSession session);
  /// Calls f() while no GLX context is current, as a Renderer needs it. The context is made current again
  /// afterwards, also if f() throws, since the session's objects are destroyed with it.
  template <typename F>
  void withoutContext(F f) {
    context->release();
    try {
      f();
    } catch (...) {
      context->makeCurrent();
      throw;
    }
    context->makeCurrent();
  }
  /// Handles the runtime's events. Returns whether the session continues.
  bool follow(XrSession session, bool& is_running);
  void frame(XrSession session, Renderer& renderer, std::array<std::unique_ptr<EyePictures>, 2>& eyes,
             const Controllers& controllers, XrSpace space);
  void drawEyes(const scenes::Snapshot& seen, const std::vector<XrView>& views, Renderer& renderer,
                std::array<std::unique_ptr<EyePictures>, 2>& eyes, double period_s,
                std::array<XrCompositionLayerProjectionView, 2>& pictures);
  scenes::Snapshot takeHands(const Controllers& controllers, XrSpace space, XrTime time);
  void say(const std::string& words) {
    {
      const std::lock_guard lock(mutex);
      messages.push_back(words);
    }
    on_news();
  }

  RenderScene scene;
  Box box_W;
  TableRoom room;
  Mesh pointer;
  std::function<void()> on_news;
  XrConnection connection;
  std::optional<GlxContext> context;
  Effort effort;
  XrEnvironmentBlendMode blend = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;

  std::mutex mutex;  // guards the members below, up to `messages`
  scenes::Snapshot shown;
  DrawOptions options;
  std::array<HeadsetHand, 2> hands;
  std::array<std::optional<double>, 2> trembles;
  std::vector<std::string> messages;

  std::atomic<bool> is_ending{false};
  std::thread thread;  // declared last, since the thread uses the other members
};

void HeadsetSession::Work::begin(XrSession& session) {
  // Runtimes refuse a session before the program has called this function.
  PFN_xrGetOpenGLGraphicsRequirementsKHR ask = nullptr;
  check(xrGetInstanceProcAddr(connection.instance(), "xrGetOpenGLGraphicsRequirementsKHR",
                              reinterpret_cast<PFN_xrVoidFunction*>(&ask)),
        "xrGetInstanceProcAddr");
  auto needs = xrStruct<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
  check(ask(connection.instance(), connection.system(), &needs), "xrGetOpenGLGraphicsRequirementsKHR");
  const XrGraphicsBindingOpenGLXlibKHR binding = context->binding();
  auto wanted = xrStruct<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
  wanted.next = &binding;
  wanted.systemId = connection.system();
  check(xrCreateSession(connection.instance(), &wanted, &session), "xrCreateSession");
}

void HeadsetSession::Work::run() {
  XrSession session = XR_NULL_HANDLE;
  try {
    context->makeCurrent();
    begin(session);
    loop(session);
  } catch (const std::exception& error) {
    say(std::string("the headset stops showing the scene: ") + error.what());
  }
  {
    const std::lock_guard lock(mutex);
    hands = {};  // releases the part that a hand held
  }
  on_news();
  if (session != XR_NULL_HANDLE) xrDestroySession(session);
  context->release();
}

bool HeadsetSession::Work::follow(XrSession session, bool& is_running) {
  for (;;) {
    auto event = xrStruct<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    if (xrPollEvent(connection.instance(), &event) != XR_SUCCESS) return true;
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
      say("the headset's runtime ends; the window stays open");
      return false;
    }
    if (event.type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) continue;
    switch (reinterpret_cast<const XrEventDataSessionStateChanged&>(event).state) {
      case XR_SESSION_STATE_READY: {
        auto wanted = xrStruct<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
        wanted.primaryViewConfigurationType = kTwoEyes;
        check(xrBeginSession(session, &wanted), "xrBeginSession");
        is_running = true;
        say(connection.runtime() + " shows the scene on a table before you");
        break;
      }
      case XR_SESSION_STATE_STOPPING:
        check(xrEndSession(session), "xrEndSession");
        is_running = false;
        break;
      case XR_SESSION_STATE_LOSS_PENDING:
        say("the headset was disconnected; the window stays open");
        return false;
      case XR_SESSION_STATE_EXITING:
        if (!is_ending) say("the headset's session was ended; the window stays open");
        return false;
      default:
        break;
    }
  }
}

void HeadsetSession::Work::loop(XrSession session) {
  std::uint32_t count = 0;
  check(xrEnumerateViewConfigurationViews(connection.instance(), connection.system(), kTwoEyes, 0, &count,
                                          nullptr),
        "xrEnumerateViewConfigurationViews");
  if (count != 2) throw std::runtime_error("the headset's runtime does not offer two eyes");
  std::array<XrViewConfigurationView, 2> sizes;
  sizes.fill(xrStruct<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
  check(xrEnumerateViewConfigurationViews(connection.instance(), connection.system(), kTwoEyes, count, &count,
                                          sizes.data()),
        "xrEnumerateViewConfigurationViews");
  blend = firstBlendMode(connection);
  std::array<std::unique_ptr<EyePictures>, 2> eyes;
  for (std::size_t i = 0; i < 2; ++i)
    eyes[i] = std::make_unique<EyePictures>(
        session, std::min<int>(kGreatestEye, static_cast<int>(sizes[i].recommendedImageRectWidth)),
        std::min<int>(kGreatestEye, static_cast<int>(sizes[i].recommendedImageRectHeight)));
  const Controllers controllers(connection.instance(), session);
  auto local = xrStruct<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  local.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
  local.poseInReferenceSpace = identityPose();
  XrSpace space = XR_NULL_HANDLE;
  check(xrCreateReferenceSpace(session, &local, &space), "xrCreateReferenceSpace");

  std::optional<Renderer> renderer;
  withoutContext([&] { renderer.emplace(scene); });
  bool is_running = false;
  double leaving_s = 0;
  while (follow(session, is_running)) {
    const double now_s = device::monotonicSeconds();
    if (is_ending && (!is_running || (leaving_s > 0 && now_s > leaving_s + kLeave_s))) return;
    if (is_ending && leaving_s == 0) {
      leaving_s = now_s;
      xrRequestExitSession(session);
    }
    if (is_running)
      frame(session, *renderer, eyes, controllers, space);
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

scenes::Snapshot HeadsetSession::Work::takeHands(const Controllers& controllers, XrSpace space, XrTime time) {
  const std::array<Controller, 2> found = controllers.at(space, time);
  std::array<std::optional<double>, 2> wanted;
  scenes::Snapshot seen;
  bool is_news = false;
  {
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < 2; ++i) {
      is_news = is_news || found[i].is_taking || hands[i].is_taking;
      hands[i] = {found[i].is_tracked, found[i].is_taking, room.toScene(found[i].X_RH)};
    }
    seen = shown;
    std::swap(wanted, trembles);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (wanted[i]) controllers.tremble(i, *wanted[i]);
    if (found[i].is_tracked)
      seen.bodies.push_back({scene.size() - 2 + i, room.toScene(found[i].X_RH), scenes::BodyRole::Mounted});
  }
  if (is_news) on_news();
  return seen;
}

void HeadsetSession::Work::drawEyes(const scenes::Snapshot& seen, const std::vector<XrView>& views,
                                    Renderer& renderer, std::array<std::unique_ptr<EyePictures>, 2>& eyes,
                                    double period_s,
                                    std::array<XrCompositionLayerProjectionView, 2>& pictures) {
  DrawOptions wanted;
  {
    const std::lock_guard lock(mutex);
    wanted = options;
  }
  const double begun_s = device::monotonicSeconds();
  std::array<Image, 2> images;
  withoutContext([&] {
    for (std::size_t i = 0; i < 2; ++i) {
      wanted.width = eyes[i]->width();
      wanted.height = eyes[i]->height();
      images[i] = renderer.render(seen, cameraOf(room, eyeOf(views[i]), box_W), effort.apply(wanted));
    }
  });
  for (std::size_t i = 0; i < 2; ++i) {
    pictures[i].pose = views[i].pose;
    pictures[i].fov = views[i].fov;
    pictures[i].subImage = eyes[i]->put(images[i]);
  }
  effort.took(device::monotonicSeconds() - begun_s, period_s);
}

void HeadsetSession::Work::frame(XrSession session, Renderer& renderer,
                                 std::array<std::unique_ptr<EyePictures>, 2>& eyes,
                                 const Controllers& controllers, XrSpace space) {
  auto state = xrStruct<XrFrameState>(XR_TYPE_FRAME_STATE);
  check(xrWaitFrame(session, nullptr, &state), "xrWaitFrame");
  check(xrBeginFrame(session, nullptr), "xrBeginFrame");
  auto where = xrStruct<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
  where.viewConfigurationType = kTwoEyes;
  where.displayTime = state.predictedDisplayTime;
  where.space = space;
  auto found = xrStruct<XrViewState>(XR_TYPE_VIEW_STATE);
  std::vector<XrView> views(2, xrStruct<XrView>(XR_TYPE_VIEW));
  std::uint32_t count = 0;
  check(xrLocateViews(session, &where, &found, 2, &count, views.data()), "xrLocateViews");
  const scenes::Snapshot seen = takeHands(controllers, space, state.predictedDisplayTime);

  std::array<XrCompositionLayerProjectionView, 2> pictures;
  pictures.fill(xrStruct<XrCompositionLayerProjectionView>(XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW));
  auto layer = xrStruct<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  layer.space = space;
  layer.viewCount = 2;
  layer.views = pictures.data();
  const XrCompositionLayerBaseHeader* const layers[] = {
      reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer)};
  constexpr XrViewStateFlags kTurned = XR_VIEW_STATE_ORIENTATION_VALID_BIT;
  const bool draws = state.shouldRender == XR_TRUE && count == 2 && (found.viewStateFlags & kTurned) != 0;
  if (draws) drawEyes(seen, views, renderer, eyes, 1e-9 * double(state.predictedDisplayPeriod), pictures);

  auto end = xrStruct<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
  end.displayTime = state.predictedDisplayTime;
  end.environmentBlendMode = blend;
  end.layerCount = draws ? 1 : 0;
  end.layers = layers;
  check(xrEndFrame(session, &end), "xrEndFrame");
  const std::lock_guard lock(mutex);
}

std::unique_ptr<HeadsetSession> HeadsetSession::begin(const RenderScene& scene, const Box& box_W,
                                                      std::function<void()> on_news, std::string& why_not) {
  auto work = std::make_unique<Work>(scene, box_W, std::move(on_news));
  why_not = work->connection.whyNot();
  if (!why_not.empty()) return nullptr;
  try {
    work->context.emplace();
  } catch (const std::exception& error) {
    why_not = error.what();
    return nullptr;
  }
  Work& started = *work;
  started.thread = std::thread([&started] { started.run(); });
  return std::unique_ptr<HeadsetSession>(new HeadsetSession(std::move(work)));
}

HeadsetSession::HeadsetSession(std::unique_ptr<Work> work) : work_(std::move(work)) {}

HeadsetSession::~HeadsetSession() {
  work_->is_ending = true;
  work_->thread.join();
}

void HeadsetSession::show(const scenes::Snapshot& snapshot, const DrawOptions& options) {
  const std::lock_guard lock(work_->mutex);
  work_->shown = snapshot;
  work_->options = options;
  work_->options.show_ground = false;  // the room has a floor of its own
  work_->options.show_legend = work_->options.show_flash = false;
  work_->options.title.clear();
  work_->options.caption.clear();
}

std::array<HeadsetHand, 2> HeadsetSession::hands() const {
  const std::lock_guard lock(work_->mutex);
  return work_->hands;
}

void HeadsetSession::tremble(std::size_t hand, double share) {
  const std::lock_guard lock(work_->mutex);
  work_->trembles.at(hand) = share;
}

std::vector<std::string> HeadsetSession::takeMessages() {
  const std::lock_guard lock(work_->mutex);
  return std::exchange(work_->messages, {});
}

}  // namespace vps::viewer
