// SPDX-License-Identifier: BSD-3-Clause
// A build without OpenXR.
#include "vps_viewer/headset.h"

namespace vps::viewer::inline v0 {

std::string headsetWords() {
  return "this build does not look for headsets (Debian: libopenxr-dev); a headset shows the scene by its "
         "browser: vps watch SCENE --web 8080";
}

}  // namespace vps::viewer::inline v0
