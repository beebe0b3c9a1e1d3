// SPDX-License-Identifier: BSD-3-Clause
// run_view.js as text.
#pragma once

namespace vps::viewer {

extern const char* const kRunViewScript;

}  // namespace vps::viewer
