// SPDX-License-Identifier: BSD-3-Clause
// A build without OpenXR.
#include "run/headset_session.h"

namespace vps::viewer {

struct HeadsetSession::Work {};

std::unique_ptr<HeadsetSession> HeadsetSession::begin(const RenderScene&, const Box&, std::function<void()>,
                                                      std::string& why_not) {
  why_not =
      "this build does not support headsets (Debian: libopenxr-dev, libx11-dev); a headset also shows the "
      "scene by its browser: vps watch SCENE --web 8080";
  return nullptr;
}
HeadsetSession::HeadsetSession(std::unique_ptr<Work> work) : work_(std::move(work)) {}
HeadsetSession::~HeadsetSession() = default;
void HeadsetSession::show(const scenes::Snapshot&, const DrawOptions&) {}
std::array<HeadsetHand, 2> HeadsetSession::hands() const {
  return {};
}
void HeadsetSession::tremble(std::size_t, double) {}
std::vector<std::string> HeadsetSession::takeMessages() {
  return {};
}
}  // namespace vps::viewer
