// SPDX-License-Identifier: BSD-3-Clause
// Colours by two sets of narrow primaries, one for each eye.
#pragma once

#include "vps_viewer/draw/image.h"

namespace vps::viewer {

/// The picture in the primaries of that eye's filter: the same colours for whoever looks through the glasses,
/// as far as the primaries can mix them; white stays white.
Image throughSpectralFilter(const Image& image, bool is_left);

}  // namespace vps::viewer
