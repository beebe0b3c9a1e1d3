// SPDX-License-Identifier: BSD-3-Clause
// Parts as they are drawn, for tests of checks.
#pragma once

#include <string>

#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

inline DrawnPart part(const std::string& name, const Mesh& mesh, const Pose& X_WP = Pose(),
                      bool is_fixed = false) {
  DrawnPart out{name, mesh, X_WP, {}};
  out.is_fixed = is_fixed;
  return out;
}

}  // namespace vps::scenes
