// SPDX-License-Identifier: BSD-3-Clause
// Voxel and point spacing by the sizes of the parts and of what they meet, where a scene states none.
#pragma once

#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Voxels across the least size that has to be resolved: of a part that moves, of a bore or slot and of what
/// fits into it. Measured with a peg of 8 mm (scenes/peg_in_hole): with 1 mm it is brought home less than 1
/// um deep, with 2 mm it gets 129 um deep into the rim of its hole.
inline constexpr double kVoxelsAcross = 8;

/// The voxmap of one part takes no more memory than that of a cube of this size with the voxels of the preset
/// `normal` [m]. Larger parts get larger voxels: the exact surfaces measure contacts, so that the
/// voxels need only find them.
inline constexpr double kLargestUsual_m = 0.15;

/// Sets voxel and spacing where the scene leaves them open (Scene::chooses_voxel, chooses_spacing). One rule
/// for all sizes:
/// - a voxel is that of the preset `normal`, or an eighth of the least size that has to be resolved
///   (meeting sizes: parts across, bores and slots, and the walls that fit into them), if that is less,
/// - but not so small that the part's voxmap takes more than that of a cube of kLargestUsual_m.
/// In a scene without steps each part that moves has its own voxel, and the fixed parts have one together. In
/// a scene with steps all parts have the same, as fitFidelity() chooses it. A spacing that is stated is kept.
/// Where many parts are so large that memory chooses their voxels, these are coarser by one more factor, so
/// that all models together take no more than kMostModels_bytes. Depends on the scene alone. Notes
/// the choice in Scene::resolution_choice, also where memory does not allow what has to be resolved.
/// O(triangles log triangles); nothing is built.
VPS_SCENES_API void chooseResolution(Scene& scene);

}  // namespace vps::scenes
