// SPDX-License-Identifier: BSD-3-Clause
#include "openxr/controllers.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace vps::viewer {
namespace {

constexpr const char* kHands[] = {"/user/hand/left", "/user/hand/right"};

XrAction makeAction(XrActionSet set, XrActionType type, const char* name, const char* words,
                    const std::array<XrPath, 2>& hands) {
  auto wanted = xrStruct<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
  wanted.actionType = type;
  wanted.countSubactionPaths = static_cast<std::uint32_t>(hands.size());
  wanted.subactionPaths = hands.data();
  std::snprintf(static_cast<char*>(wanted.actionName), XR_MAX_ACTION_NAME_SIZE, "%s", name);
  std::snprintf(static_cast<char*>(wanted.localizedActionName), XR_MAX_LOCALIZED_ACTION_NAME_SIZE, "%s",
                words);
  XrAction action = XR_NULL_HANDLE;
  check(xrCreateAction(set, &wanted, &action), "xrCreateAction");
  return action;
}

}  // namespace

XrPath Controllers::path(const char* text) const {
  XrPath found = XR_NULL_PATH;
  check(xrStringToPath(instance_, text, &found), "xrStringToPath");
  return found;
}

/// Suggests bindings for a kind of controller. A runtime that does not know the profile ignores it.
void Controllers::suggest(const char* profile, const char* trigger) const {
  std::vector<XrActionSuggestedBinding> bindings;
  for (const std::string hand : kHands) {
    bindings.push_back({aim_, path((hand + "/input/aim/pose").c_str())});
    bindings.push_back({take_, path((hand + trigger).c_str())});
    bindings.push_back({tremble_, path((hand + "/output/haptic").c_str())});
  }
  auto wanted = xrStruct<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
  wanted.interactionProfile = path(profile);
  wanted.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
  wanted.suggestedBindings = bindings.data();
  xrSuggestInteractionProfileBindings(instance_, &wanted);
}

Controllers::Controllers(XrInstance instance, XrSession session) : instance_(instance), session_(session) {
  for (std::size_t i = 0; i < 2; ++i) hands_[i] = path(kHands[i]);
  auto wanted = xrStruct<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
  std::snprintf(static_cast<char*>(wanted.actionSetName), XR_MAX_ACTION_SET_NAME_SIZE, "assembly");
  std::snprintf(static_cast<char*>(wanted.localizedActionSetName), XR_MAX_LOCALIZED_ACTION_SET_NAME_SIZE,
                "Assembly");
  check(xrCreateActionSet(instance, &wanted, &set_), "xrCreateActionSet");
  aim_ = makeAction(set_, XR_ACTION_TYPE_POSE_INPUT, "hand", "Hand", hands_);
  take_ = makeAction(set_, XR_ACTION_TYPE_BOOLEAN_INPUT, "take", "Take the part", hands_);
  tremble_ = makeAction(set_, XR_ACTION_TYPE_VIBRATION_OUTPUT, "tremble", "Force on the hand", hands_);
  // The runtime converts an analogue trigger to the bool by its own threshold (OpenXR 1.0, section 11.4).
  suggest("/interaction_profiles/khr/simple_controller", "/input/select/click");
  suggest("/interaction_profiles/oculus/touch_controller", "/input/trigger/value");
  suggest("/interaction_profiles/valve/index_controller", "/input/trigger/value");
  suggest("/interaction_profiles/htc/vive_controller", "/input/trigger/value");
  suggest("/interaction_profiles/microsoft/motion_controller", "/input/trigger/value");
  for (std::size_t i = 0; i < 2; ++i) {
    auto space = xrStruct<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
    space.action = aim_;
    space.subactionPath = hands_[i];
    space.poseInActionSpace = identityPose();
    check(xrCreateActionSpace(session, &space, &spaces_[i]), "xrCreateActionSpace");
  }
  auto attached = xrStruct<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
  attached.countActionSets = 1;
  attached.actionSets = &set_;
  check(xrAttachSessionActionSets(session, &attached), "xrAttachSessionActionSets");
}

Controllers::~Controllers() {
  for (const XrSpace space : spaces_)
    if (space != XR_NULL_HANDLE) xrDestroySpace(space);
  xrDestroyActionSet(set_);  // destroys its actions, too
}

std::array<Controller, 2> Controllers::at(XrSpace room, XrTime time) const {
  std::array<Controller, 2> found;
  const XrActiveActionSet active = {set_, XR_NULL_PATH};
  auto sync = xrStruct<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
  sync.countActiveActionSets = 1;
  sync.activeActionSets = &active;
  // The session is not in focus, for example while the runtime shows a menu: no trigger counts as held.
  if (xrSyncActions(session_, &sync) != XR_SUCCESS) return found;
  for (std::size_t i = 0; i < 2; ++i) {
    auto of = xrStruct<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    of.action = take_;
    of.subactionPath = hands_[i];
    auto held = xrStruct<XrActionStateBoolean>(XR_TYPE_ACTION_STATE_BOOLEAN);
    if (XR_SUCCEEDED(xrGetActionStateBoolean(session_, &of, &held)))
      found[i].is_taking = held.isActive == XR_TRUE && held.currentState == XR_TRUE;
    auto place = xrStruct<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    constexpr XrSpaceLocationFlags kWhole =
        XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
    if (XR_FAILED(xrLocateSpace(spaces_[i], room, time, &place)) || (place.locationFlags & kWhole) != kWhole)
      continue;
    found[i].X_RH = poseOf(place.pose);
    found[i].is_tracked = found[i].X_RH.isFinite();
  }
  return found;
}

void Controllers::tremble(std::size_t hand, double share) const {
  auto of = xrStruct<XrHapticActionInfo>(XR_TYPE_HAPTIC_ACTION_INFO);
  of.action = tremble_;
  of.subactionPath = hands_[hand];
  auto wanted = xrStruct<XrHapticVibration>(XR_TYPE_HAPTIC_VIBRATION);
  wanted.amplitude = static_cast<float>(std::clamp(share, 0.0, 1.0));
  wanted.duration = 50'000'000;  // ns, until the next request
  wanted.frequency = XR_FREQUENCY_UNSPECIFIED;
  xrApplyHapticFeedback(session_, &of, reinterpret_cast<const XrHapticBaseHeader*>(&wanted));
}

}  // namespace vps::viewer
