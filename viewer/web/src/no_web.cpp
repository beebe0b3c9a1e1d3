// SPDX-License-Identifier: BSD-3-Clause
// Replaces the web page in a build with VPS_WEB=OFF.
#include "vps/errors.h"
#include "vps_viewer/web/web.h"

namespace vps::viewer {

std::string missingForWeb() {
  return "this program was built without the web page (VPS_WEB=OFF); build it with 'cmake --preset release "
         "&& "
         "cmake --build build/release'";
}

void serveSession(const WebOptions&) {
  throw LoadError("--web", "", missingForWeb());
}
void serveScene(const scenes::Scene&, const WebOptions&) {
  throw LoadError("--web", "", missingForWeb());
}
void serveRecording(const device::RecordedRun&, const WebOptions&) {
  throw LoadError("--web", "", missingForWeb());
}

}  // namespace vps::viewer
