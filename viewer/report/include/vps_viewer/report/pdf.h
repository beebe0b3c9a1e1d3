// SPDX-License-Identifier: BSD-3-Clause
// Pages of reports as PDF, printed by Chromium without a display.
#pragma once

#include <string>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// What is missing to print here, in words with its remedy; empty: nothing.
VPS_VIEWER_API std::string missingForPdf();

/// Prints an HTML file. Returns nothing on success, and otherwise the reason in words. It takes a few
/// seconds.
VPS_VIEWER_API std::string printPdf(const std::string& page, const std::string& pdf);
/// The same for the text of a page that shows nothing from other files.
VPS_VIEWER_API std::string printPdfOf(const std::string& html, const std::string& pdf);

}  // namespace vps::viewer
