// SPDX-License-Identifier: BSD-3-Clause
// The instruction book of a plan: an HTML page that prints as a cover and one sheet for each step.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/planning/book.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct BookOptions {
  Progress progress;         ///< may be empty; called before each picture
  bool has_pictures = true;  ///< false: words and tables only, without OpenGL
  int width = 1200, height = 780;
};

/// A step in sentences: its path, what has to be in place before, what has to be held, clearance, fits, play,
/// torque. Directions are named as the pictures show them: from the front, right and above.
VPS_VIEWER_API std::vector<std::string> bookLines(const scenes::Book& book, const scenes::BookStep& step);

/// Writes the page: a cover with an exploded view and the parts list, a sheet for each step, and a sheet with
/// the parts for which no path was found. Pictures are drawn and written one after the other, so that memory
/// does not grow with their number. The same input gives the same bytes. Errors of `out` are the caller's to
/// check; exceptions of `progress` pass through.
/// @param scene  the scene from which the book was made
/// @return why pictures are missing, with a remedy; empty: none is missing
VPS_VIEWER_API std::string writeBook(std::ostream& out, const scenes::Scene& scene, const scenes::Book& book,
                                     const BookOptions& options = {});

}  // namespace vps::viewer
