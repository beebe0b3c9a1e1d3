// SPDX-License-Identifier: BSD-3-Clause
// Lengths as pages show them.
#pragma once

#include <string>

#include "files/html.h"

namespace vps::viewer {

/// The number of micrometres, without unit: "12.34".
inline std::string micrometres(double length_m, const char* form = "%.2f") {
  return html::format(1e6 * length_m, form);
}

/// Of round lengths, with the unit that suits them: "5 mm", "200 µm".
inline std::string lengthText(double length_m) {
  if (length_m >= 1) return html::format(length_m, "%g m");
  if (length_m >= 1e-3) return html::format(1e3 * length_m, "%g mm");
  if (length_m >= 1e-6) return html::format(1e6 * length_m, "%g µm");
  return html::format(1e9 * length_m, "%g nm");
}

}  // namespace vps::viewer
