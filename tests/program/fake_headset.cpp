// SPDX-License-Identifier: BSD-3-Clause
// An OpenXR runtime for tests, which the loader finds by XR_RUNTIME_JSON. It writes the pictures of its
// headset to files, reads the wearer's hand from a file, and lists each call that the specification does not
// allow at its time.
//
// In the folder that VPS_FAKE_HEADSET names:
//   left.ppm, right.ppm   the newest pictures
//   frames.txt            number of pairs of pictures
//   errors.txt            calls that were not allowed, one line each
//   trembles.txt          amplitudes of vibrations, one line each
//   hand.txt              read: "x y z taking" of the right controller, in the room [m]; it points along -z
//   leave.txt             read: the wearer ends the session as soon as this file exists
#include <epoxy/gl.h>
#include <epoxy/glx.h>
#define XR_USE_PLATFORM_XLIB
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "fake_headset.h"

namespace {

namespace fs = std::filesystem;

fs::path folder() {
  return std::getenv("VPS_FAKE_HEADSET");
}

XrResult wrong(const std::string& what, XrResult result = XR_ERROR_CALL_ORDER_INVALID) {
  std::ofstream(folder() / "errors.txt", std::ios::app) << what << "\n";
  return result;
}

struct Swapchain {
  int width, height;
  GLuint texture = 0;
  bool is_acquired = false, is_waited = false, was_released = false;
};

// The state of the one session that a program has.
bool asked_requirements = false, is_begun = false, frame_waited = false, frame_begun = false,
     is_attached = false, was_synced = false, is_leaving = false;
long frame_count = 0;
std::vector<XrSessionState> events;
std::map<std::string, XrPath> paths;
XrPath nextPath(const std::string& text) {
  return paths.try_emplace(text, paths.size() + 1).first->second;
}
std::map<XrAction, XrActionType> actions;
std::map<XrSpace, int> spaces;  // -1: the room, otherwise the hand
int handOf(XrPath path) {
  return path == nextPath("/user/hand/left") ? 0 : 1;
}

template <class Handle>
Handle handle(std::uintptr_t number) {
  return reinterpret_cast<Handle>(number);
}

XrQuaternionf lookingDown() {
  return {static_cast<float>(std::sin(-0.5 * vps::kFakePitch_rad)), 0, 0,
          static_cast<float>(std::cos(0.5 * vps::kFakePitch_rad))};
}

XrResult createInstance(const XrInstanceCreateInfo* info, XrInstance* made) {
  if (info->enabledExtensionCount != 1 ||
      std::string(info->enabledExtensionNames[0]) != XR_KHR_OPENGL_ENABLE_EXTENSION_NAME)
    return wrong("xrCreateInstance without XR_KHR_opengl_enable", XR_ERROR_EXTENSION_NOT_PRESENT);
  *made = handle<XrInstance>(1);
  return XR_SUCCESS;
}
XrResult destroyInstance(XrInstance) {
  return XR_SUCCESS;
}
XrResult instanceExtensions(const char*, uint32_t room, uint32_t* count, XrExtensionProperties* found) {
  *count = 1;
  if (room == 0) return XR_SUCCESS;
  std::snprintf(found[0].extensionName, XR_MAX_EXTENSION_NAME_SIZE, "%s",
                XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  found[0].extensionVersion = XR_KHR_opengl_enable_SPEC_VERSION;
  return XR_SUCCESS;
}
XrResult instanceProperties(XrInstance, XrInstanceProperties* found) {
  found->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  std::snprintf(found->runtimeName, XR_MAX_RUNTIME_NAME_SIZE, "test headset");
  return XR_SUCCESS;
}
XrResult pollEvent(XrInstance, XrEventDataBuffer* event) {
  if (!is_leaving && is_begun && fs::exists(folder() / "leave.txt")) {
    is_leaving = true;
    events.push_back(XR_SESSION_STATE_STOPPING);
  }
  if (events.empty()) return XR_EVENT_UNAVAILABLE;
  XrEventDataSessionStateChanged changed{};
  changed.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  changed.session = handle<XrSession>(2);
  changed.state = events.front();
  events.erase(events.begin());
  std::memcpy(event, &changed, sizeof changed);
  return XR_SUCCESS;
}
XrResult getSystem(XrInstance, const XrSystemGetInfo* info, XrSystemId* found) {
  if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
  if (std::getenv("VPS_FAKE_UNPLUGGED") != nullptr) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *found = 1;
  return XR_SUCCESS;
}
XrResult blendModes(XrInstance, XrSystemId, XrViewConfigurationType, uint32_t room, uint32_t* count,
                    XrEnvironmentBlendMode* found) {
  *count = 1;
  if (room > 0) found[0] = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  return XR_SUCCESS;
}
XrResult viewSizes(XrInstance, XrSystemId, XrViewConfigurationType type, uint32_t room, uint32_t* count,
                   XrViewConfigurationView* found) {
  if (type != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO) return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
  *count = 2;
  if (room == 0) return XR_SUCCESS;
  if (room < 2) return XR_ERROR_SIZE_INSUFFICIENT;
  for (int i = 0; i < 2; ++i) {
    if (found[i].type != XR_TYPE_VIEW_CONFIGURATION_VIEW)
      return wrong("a view's size without its type", XR_ERROR_VALIDATION_FAILURE);
    found[i].recommendedImageRectWidth = found[i].maxImageRectWidth = vps::kFakeWidth_px;
    found[i].recommendedImageRectHeight = found[i].maxImageRectHeight = vps::kFakeHeight_px;
    found[i].recommendedSwapchainSampleCount = found[i].maxSwapchainSampleCount = 1;
  }
  return XR_SUCCESS;
}
XrResult requirements(XrInstance, XrSystemId, XrGraphicsRequirementsOpenGLKHR* found) {
  found->minApiVersionSupported = XR_MAKE_VERSION(3, 3, 0);
  found->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  asked_requirements = true;
  return XR_SUCCESS;
}
XrResult createSession(XrInstance, const XrSessionCreateInfo* info, XrSession* made) {
  if (!asked_requirements)
    return wrong("a session before its requirements", XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
  const auto* binding = static_cast<const XrGraphicsBindingOpenGLXlibKHR*>(info->next);
  if (binding == nullptr || binding->type != XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR ||
      binding->xDisplay == nullptr || binding->glxFBConfig == nullptr || binding->glxContext == nullptr ||
      binding->visualid == 0 || binding->glxDrawable == 0)
    return wrong("a session without a whole binding", XR_ERROR_GRAPHICS_DEVICE_INVALID);
  if (glXGetCurrentContext() != binding->glxContext)
    return wrong("a session whose context is not current", XR_ERROR_GRAPHICS_DEVICE_INVALID);
  *made = handle<XrSession>(2);
  events = {XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY};
  return XR_SUCCESS;
}
XrResult destroySession(XrSession) {
  return XR_SUCCESS;
}
XrResult beginSession(XrSession, const XrSessionBeginInfo* info) {
  if (is_begun || info->primaryViewConfigurationType != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO)
    return wrong("xrBeginSession");
  is_begun = true;
  events.insert(events.end(),
                {XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED});
  return XR_SUCCESS;
}
XrResult endSession(XrSession) {
  if (!is_begun || !is_leaving) return wrong("xrEndSession", XR_ERROR_SESSION_NOT_STOPPING);
  is_begun = false;
  events.insert(events.end(), {XR_SESSION_STATE_IDLE, XR_SESSION_STATE_EXITING});
  return XR_SUCCESS;
}
XrResult requestExit(XrSession) {
  if (!is_begun) return XR_ERROR_SESSION_NOT_RUNNING;
  is_leaving = true;
  events.push_back(XR_SESSION_STATE_STOPPING);
  return XR_SUCCESS;
}
XrResult createSpace(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* made) {
  if (info->referenceSpaceType != XR_REFERENCE_SPACE_TYPE_LOCAL ||
      info->poseInReferenceSpace.orientation.w != 1)
    return wrong("the space of the room", XR_ERROR_VALIDATION_FAILURE);
  *made = handle<XrSpace>(10 + spaces.size());
  spaces[*made] = -1;
  return XR_SUCCESS;
}
XrResult createActionSpace(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* made) {
  *made = handle<XrSpace>(10 + spaces.size());
  spaces[*made] = handOf(info->subactionPath);
  return XR_SUCCESS;
}
XrResult destroySpace(XrSpace) {
  return XR_SUCCESS;
}
/// Reads "x y z taking" from hand.txt. Returns false if there is no controller.
bool readHand(double (&p)[3], int& is_taking) {
  std::ifstream file(folder() / "hand.txt");
  return static_cast<bool>(file >> p[0] >> p[1] >> p[2] >> is_taking);
}
XrResult locateSpace(XrSpace space, XrSpace base, XrTime, XrSpaceLocation* found) {
  found->locationFlags = 0;
  double p[3];
  int is_taking = 0;
  if (spaces.at(base) != -1) return wrong("a hand that is not located in the room");
  if (spaces.at(space) != 1 || !readHand(p, is_taking)) return XR_SUCCESS;
  found->locationFlags = XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  found->pose = {{0, 0, 0, 1},
                 {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}};
  return XR_SUCCESS;
}
XrResult formats(XrSession, uint32_t room, uint32_t* count, int64_t* found) {
  *count = 2;
  if (room >= 2) found[0] = GL_RGBA8, found[1] = GL_SRGB8_ALPHA8;
  return XR_SUCCESS;
}
XrResult createSwapchain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* made) {
  if (info->format != GL_SRGB8_ALPHA8 || info->sampleCount != 1 || info->faceCount != 1 ||
      info->arraySize != 1)
    return wrong("a swapchain of another kind", XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED);
  auto* chain = new Swapchain{static_cast<int>(info->width), static_cast<int>(info->height)};
  glGenTextures(1, &chain->texture);
  glBindTexture(GL_TEXTURE_2D, chain->texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, chain->width, chain->height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               nullptr);
  *made = reinterpret_cast<XrSwapchain>(chain);
  return XR_SUCCESS;
}
Swapchain& of(XrSwapchain chain) {
  return *reinterpret_cast<Swapchain*>(chain);
}
XrResult destroySwapchain(XrSwapchain chain) {
  // The images of a swapchain are textures of the session's context.
  if (glXGetCurrentContext() == nullptr)
    return wrong("a swapchain destroyed without a context", XR_ERROR_RUNTIME_FAILURE);
  delete &of(chain);
  return XR_SUCCESS;
}
XrResult swapchainImages(XrSwapchain chain, uint32_t room, uint32_t* count,
                         XrSwapchainImageBaseHeader* found) {
  *count = 1;
  if (room == 0) return XR_SUCCESS;
  if (found->type != XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR)
    return wrong("an image without its type", XR_ERROR_VALIDATION_FAILURE);
  reinterpret_cast<XrSwapchainImageOpenGLKHR*>(found)->image = of(chain).texture;
  return XR_SUCCESS;
}
XrResult acquire(XrSwapchain chain, const XrSwapchainImageAcquireInfo*, uint32_t* index) {
  if (of(chain).is_acquired) return wrong("a picture that is acquired twice");
  of(chain).is_acquired = true;
  *index = 0;
  return XR_SUCCESS;
}
XrResult waitImage(XrSwapchain chain, const XrSwapchainImageWaitInfo*) {
  if (!of(chain).is_acquired || of(chain).is_waited) return wrong("a wait for no picture");
  of(chain).is_waited = true;
  return XR_SUCCESS;
}
XrResult release(XrSwapchain chain, const XrSwapchainImageReleaseInfo*) {
  if (!of(chain).is_waited) return wrong("a picture that is released before it was waited for");
  of(chain).is_acquired = of(chain).is_waited = false;
  of(chain).was_released = true;
  return XR_SUCCESS;
}
XrResult waitFrame(XrSession, const XrFrameWaitInfo*, XrFrameState* state) {
  if (!is_begun || frame_waited) return wrong("xrWaitFrame", XR_ERROR_SESSION_NOT_RUNNING);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  frame_waited = true;
  state->predictedDisplayTime = 1'000'000'000 + 20'000'000 * frame_count;
  state->predictedDisplayPeriod = 10'000'000'000;  // the headset is so slow that pictures are drawn in full
  state->shouldRender = XR_TRUE;
  return XR_SUCCESS;
}
XrResult beginFrame(XrSession, const XrFrameBeginInfo*) {
  if (!frame_waited || frame_begun) return wrong("xrBeginFrame");
  frame_begun = true;
  return XR_SUCCESS;
}
XrResult locateViews(XrSession, const XrViewLocateInfo* info, XrViewState* state, uint32_t room,
                     uint32_t* count, XrView* views) {
  if (spaces.at(info->space) != -1 || info->displayTime < 1'000'000'000) return wrong("xrLocateViews");
  *count = 2;
  if (room < 2) return room == 0 ? XR_SUCCESS : XR_ERROR_SIZE_INSUFFICIENT;
  state->viewStateFlags = XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT;
  for (int i = 0; i < 2; ++i) {
    views[i].pose = {lookingDown(), {static_cast<float>((i == 0 ? -0.5 : 0.5) * vps::kFakeEyes_m), 0, 0}};
    const double inner = vps::kFakeInner_rad, outer = vps::kFakeOuter_rad;
    views[i].fov = {static_cast<float>(i == 0 ? -outer : -inner), static_cast<float>(i == 0 ? inner : outer),
                    static_cast<float>(vps::kFakeUp_rad), static_cast<float>(-vps::kFakeDown_rad)};
  }
  return XR_SUCCESS;
}
void savePicture(const XrSwapchainSubImage& place, const char* name) {
  const Swapchain& chain = of(place.swapchain);
  std::vector<unsigned char> rows(3 * static_cast<std::size_t>(chain.width) * chain.height);
  glBindTexture(GL_TEXTURE_2D, chain.texture);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
  const XrRect2Di& rect = place.imageRect;
  {
    std::ofstream file(folder() / "unfinished.ppm", std::ios::binary);
    file << "P6 " << rect.extent.width << " " << rect.extent.height << " 255\n";
    for (int y = rect.extent.height - 1; y >= 0; --y)  // the first row of OpenGL is at the bottom
      file.write(reinterpret_cast<const char*>(rows.data()) +
                     3 * (static_cast<std::size_t>(rect.offset.y + y) * chain.width + rect.offset.x),
                 3 * rect.extent.width);
  }
  fs::rename(folder() / "unfinished.ppm", folder() / name);
}
XrResult endFrame(XrSession, const XrFrameEndInfo* info) {
  if (!frame_begun) return wrong("xrEndFrame");
  frame_begun = frame_waited = false;
  if (info->environmentBlendMode != XR_ENVIRONMENT_BLEND_MODE_OPAQUE)
    return wrong("a frame's blend mode", XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED);
  if (info->layerCount == 0) return XR_SUCCESS;
  const auto& layer = *reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[0]);
  if (layer.type != XR_TYPE_COMPOSITION_LAYER_PROJECTION || layer.viewCount != 2 ||
      spaces.at(layer.space) != -1)
    return wrong("a frame's layer", XR_ERROR_LAYER_INVALID);
  for (int i = 0; i < 2; ++i) {
    const XrCompositionLayerProjectionView& view = layer.views[i];
    if (view.type != XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW || !of(view.subImage.swapchain).was_released ||
        of(view.subImage.swapchain).is_acquired || view.pose.orientation.w != lookingDown().w ||
        view.fov.angleUp <= view.fov.angleDown)
      return wrong("a frame's view", XR_ERROR_LAYER_INVALID);
    savePicture(view.subImage, i == 0 ? "left.ppm" : "right.ppm");
  }
  ++frame_count;
  std::ofstream(folder() / "frames.txt") << frame_count << "\n";
  return XR_SUCCESS;
}
XrResult stringToPath(XrInstance, const char* text, XrPath* found) {
  *found = nextPath(text);
  return XR_SUCCESS;
}
XrResult createActionSet(XrInstance, const XrActionSetCreateInfo*, XrActionSet* made) {
  *made = handle<XrActionSet>(5);
  return XR_SUCCESS;
}
XrResult destroyActionSet(XrActionSet) {
  return XR_SUCCESS;
}
XrResult createAction(XrActionSet, const XrActionCreateInfo* info, XrAction* made) {
  *made = handle<XrAction>(20 + actions.size());
  actions[*made] = info->actionType;
  return XR_SUCCESS;
}
XrResult suggest(XrInstance, const XrInteractionProfileSuggestedBinding* info) {
  if (is_attached) return wrong("a binding after the actions were attached");
  return info->interactionProfile == nextPath("/interaction_profiles/khr/simple_controller")
             ? XR_SUCCESS
             : XR_ERROR_PATH_UNSUPPORTED;
}
XrResult attach(XrSession, const XrSessionActionSetsAttachInfo*) {
  if (is_attached) return wrong("actions that are attached twice");
  is_attached = true;
  return XR_SUCCESS;
}
XrResult sync(XrSession, const XrActionsSyncInfo* info) {
  if (!is_attached || info->countActiveActionSets != 1) return wrong("xrSyncActions");
  was_synced = true;
  return XR_SUCCESS;
}
XrResult stateBoolean(XrSession, const XrActionStateGetInfo* info, XrActionStateBoolean* state) {
  if (!was_synced || actions.at(info->action) != XR_ACTION_TYPE_BOOLEAN_INPUT)
    return wrong("xrGetActionStateBoolean");
  double p[3];
  int is_taking = 0;
  const bool is_there = handOf(info->subactionPath) == 1 && readHand(p, is_taking);
  state->isActive = is_there ? XR_TRUE : XR_FALSE;
  state->currentState = is_there && is_taking != 0 ? XR_TRUE : XR_FALSE;
  return XR_SUCCESS;
}
XrResult tremble(XrSession, const XrHapticActionInfo* info, const XrHapticBaseHeader* wanted) {
  if (wanted->type != XR_TYPE_HAPTIC_VIBRATION || handOf(info->subactionPath) != 1 ||
      actions.at(info->action) != XR_ACTION_TYPE_VIBRATION_OUTPUT)
    return wrong("xrApplyHapticFeedback");
  std::ofstream(folder() / "trembles.txt", std::ios::app)
      << reinterpret_cast<const XrHapticVibration*>(wanted)->amplitude << "\n";
  return XR_SUCCESS;
}

XrResult procAddr(XrInstance, const char* name, PFN_xrVoidFunction* found) {
  static const std::map<std::string, PFN_xrVoidFunction> kCalls = {
#define VPS_CALL(name, function) {name, reinterpret_cast<PFN_xrVoidFunction>(function)}
      VPS_CALL("xrGetInstanceProcAddr", procAddr),
      VPS_CALL("xrEnumerateInstanceExtensionProperties", instanceExtensions),
      VPS_CALL("xrCreateInstance", createInstance),
      VPS_CALL("xrDestroyInstance", destroyInstance),
      VPS_CALL("xrGetInstanceProperties", instanceProperties),
      VPS_CALL("xrPollEvent", pollEvent),
      VPS_CALL("xrGetSystem", getSystem),
      VPS_CALL("xrEnumerateEnvironmentBlendModes", blendModes),
      VPS_CALL("xrEnumerateViewConfigurationViews", viewSizes),
      VPS_CALL("xrGetOpenGLGraphicsRequirementsKHR", requirements),
      VPS_CALL("xrCreateSession", createSession),
      VPS_CALL("xrDestroySession", destroySession),
      VPS_CALL("xrBeginSession", beginSession),
      VPS_CALL("xrEndSession", endSession),
      VPS_CALL("xrRequestExitSession", requestExit),
      VPS_CALL("xrCreateReferenceSpace", createSpace),
      VPS_CALL("xrCreateActionSpace", createActionSpace),
      VPS_CALL("xrLocateSpace", locateSpace),
      VPS_CALL("xrDestroySpace", destroySpace),
      VPS_CALL("xrEnumerateSwapchainFormats", formats),
      VPS_CALL("xrCreateSwapchain", createSwapchain),
      VPS_CALL("xrDestroySwapchain", destroySwapchain),
      VPS_CALL("xrEnumerateSwapchainImages", swapchainImages),
      VPS_CALL("xrAcquireSwapchainImage", acquire),
      VPS_CALL("xrWaitSwapchainImage", waitImage),
      VPS_CALL("xrReleaseSwapchainImage", release),
      VPS_CALL("xrWaitFrame", waitFrame),
      VPS_CALL("xrBeginFrame", beginFrame),
      VPS_CALL("xrEndFrame", endFrame),
      VPS_CALL("xrLocateViews", locateViews),
      VPS_CALL("xrStringToPath", stringToPath),
      VPS_CALL("xrCreateActionSet", createActionSet),
      VPS_CALL("xrDestroyActionSet", destroyActionSet),
      VPS_CALL("xrCreateAction", createAction),
      VPS_CALL("xrSuggestInteractionProfileBindings", suggest),
      VPS_CALL("xrAttachSessionActionSets", attach),
      VPS_CALL("xrSyncActions", sync),
      VPS_CALL("xrGetActionStateBoolean", stateBoolean),
      VPS_CALL("xrApplyHapticFeedback", tremble),
#undef VPS_CALL
  };
  const auto call = kCalls.find(name);
  *found = call == kCalls.end() ? nullptr : call->second;
  return *found == nullptr ? XR_ERROR_FUNCTION_UNSUPPORTED : XR_SUCCESS;
}

// Types of the loader's interface (OpenXR loader specification, "Runtime interface negotiation"), whose
// header Debian does not package.
struct LoaderInfo {
  std::uint32_t struct_type, struct_version;
  std::size_t struct_size;
  std::uint32_t min_interface, max_interface;
  XrVersion min_api, max_api;
};
struct RuntimeRequest {
  std::uint32_t struct_type, struct_version;
  std::size_t struct_size;
  std::uint32_t interface_version;
  XrVersion api_version;
  PFN_xrGetInstanceProcAddr get_instance_proc_addr;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const LoaderInfo* loader, RuntimeRequest* runtime) {
  if (loader->min_interface > 1 || loader->max_interface < 1) return XR_ERROR_INITIALIZATION_FAILED;
  runtime->interface_version = 1;
  runtime->api_version = XR_MAKE_VERSION(1, 0, 0);
  runtime->get_instance_proc_addr = procAddr;
  return XR_SUCCESS;
}
