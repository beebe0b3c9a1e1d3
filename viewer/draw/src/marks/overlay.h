// SPDX-License-Identifier: BSD-3-Clause
// Title, caption and legend, drawn over a finished picture.
#pragma once

#include "marks/text.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

struct LegendColors {
  Eigen::Vector3f hand, target;  ///< linear RGB
};

void drawOverlay(Image& image, const scenes::Snapshot& snapshot, const DrawOptions& options,
                 const LegendColors& colors, const Lettering& lettering);

}  // namespace vps::viewer
