// SPDX-License-Identifier: BSD-3-Clause
// Judges the clashes of a check by what is known about fasteners and seals.
#pragma once

#include <map>
#include <vector>

#include "fits/faces.h"
#include "surface/placed_surface.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// The faces of the parts of a check, by surface: parts of equal geometry share theirs.
using FacesOfParts = std::map<const PartSurface*, FitFaces>;

/// Gives each clash that is a thread, a seal or an insert that state, and explains it or the clash that
/// remains in CheckedPair::explanation. A pair that a rule of `wishes` names is judged by this rule alone.
/// Runs on all cores. Throws LoadError for a rule that matches no part.
/// @param faces of all parts that clash
void judgeByKnowledge(const std::vector<PlacedSurface>& parts, const FacesOfParts& faces,
                      const OverlapWishes& wishes, const Progress& progress, CheckResult& result);

}  // namespace vps::scenes
