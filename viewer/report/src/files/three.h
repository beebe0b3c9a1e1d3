// SPDX-License-Identifier: BSD-3-Clause
// Where three.js is, which draws in browsers.
#pragma once

namespace vps::viewer {

inline constexpr const char* kThreeFolder =
    "/usr/share/javascript/three/";  // of Debian's package libjs-three

}  // namespace vps::viewer
