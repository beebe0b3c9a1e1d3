// SPDX-License-Identifier: BSD-3-Clause
// Voxel and point spacing from the sizes of the parts and of the faces they fit, if a scene states none.
#pragma once

#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Voxels across the least size that has to be resolved: of a moved part, of a bore or slot, and of what fits
/// into it. Measured with a peg of 8 mm (scenes/peg_in_hole): with voxels of 1 mm the peg reaches its target
/// less than 1 um deep, with voxels of 2 mm it penetrates the rim of its hole by 129 um.
inline constexpr double kVoxelsAcross = 8;

/// Size of a cube [m] that bounds a part's voxmap: the voxmap takes no more memory than that of this cube
/// with the voxels of the preset `normal`. Larger parts get larger voxels, which suffice to find contacts
/// because the exact surfaces measure them.
inline constexpr double kLargestUsual_m = 0.15;

/// Sets voxel and spacing if the scene leaves them open (Scene::chooses_voxel, chooses_spacing). One rule for
/// all sizes:
/// - A voxel is that of the preset `normal`, or an eighth of the least size that has to be resolved (width of
/// parts, bores and slots, and the walls that fit into them), whichever is less.
/// - The voxel is enlarged if the part's voxmap would take more memory than that of a cube of
/// kLargestUsual_m.
///
/// In a scene without steps each movable part has its own voxel, and the fixed parts share
/// one. In a scene with steps all parts share one voxel, as fitFidelity() chooses it. A stated spacing is
/// kept. If the sum of all models would exceed kMostModels_bytes, the voxels of parts that the memory rule
/// enlarged grow by one common factor. Depends on the scene alone. Notes the choice in
/// Scene::resolution_choice, also if the memory limit prevents the required resolution. O(triangles log
/// triangles); no model is built.
VPS_SCENES_API void chooseResolution(Scene& scene);

}  // namespace vps::scenes
