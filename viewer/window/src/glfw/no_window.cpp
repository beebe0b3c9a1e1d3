// SPDX-License-Identifier: BSD-3-Clause
// The window in a build without GLFW or Dear ImGui.
#include <stdexcept>

#include "vps_viewer/window/window.h"

namespace vps::viewer {

std::string missingForWindow() {
  return "this build has no window; install libglfw3-dev and libimgui-dev, then build again";
}

void viewScene(const scenes::Scene&, const WindowOptions&) {
  throw std::runtime_error(missingForWindow());
}

void viewRecording(const device::RecordedRun&, const WindowOptions&) {
  throw std::runtime_error(missingForWindow());
}

std::optional<scenes::Verdict> viewSession(const WindowOptions&) {
  throw std::runtime_error(missingForWindow());
}

}  // namespace vps::viewer
