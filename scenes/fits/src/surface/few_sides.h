// SPDX-License-Identifier: BSD-3-Clause
// Faces of few flat sides that may be meant as round.
#pragma once

#include <string>

#include "surface/part_surface.h"

namespace vps::scenes {

/// How the faces of 7 to 24 flat sides whose corners lie on one circle were read, in words; empty if there
/// are none. From 16 sides on such a face is read as a coarse cylinder, with fewer sides as a prism. Squares
/// and hexagons are meant as such and are not mentioned. O(facets).
std::string fewSidesWords(const PartSurface& surface);

}  // namespace vps::scenes
