// SPDX-License-Identifier: BSD-3-Clause
// run_view.js as text.
#pragma once

namespace vps::viewer::inline v0 {

extern const char* const kRunViewScript;

}  // namespace vps::viewer::inline v0
