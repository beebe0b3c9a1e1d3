// SPDX-License-Identifier: BSD-3-Clause
#include "rows.h"

namespace vps::bench {

const std::vector<HapticCase>& allHapticCases() {
  static const std::vector<HapticCase> cases = {
      {"kinematics", kinematicsRow}, {"statics", staticsRow},
      {"passivity", passivityRow},   {"ringing", ringingRow},
      {"stiffest", stiffestWallRow}, {"press", pressRow},
      {"slide", slideRow},           {"free", freeMotionRow},
#ifdef VPS_HAS_SCENES
      {"injected", injectedRow},     {"tick", tickRow},
      {"points", pointsRow},
#endif
  };
  return cases;
}

}  // namespace vps::bench
