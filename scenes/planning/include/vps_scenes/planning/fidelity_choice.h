// SPDX-License-Identifier: BSD-3-Clause
// Chooses a fidelity for a scene by building models and counting points and bytes (no time is measured), and
// voxel and point spacing from the sizes of the parts if a scene states none.
#pragma once

#include <string>

#include "vps/errors.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Cost model of a physics step [us]: a constant, and a term for each point that may be near contact in the
/// step (the points of the moved part, and as many points of the other parts as the moved part can cover).
/// The constants were fitted once to the 99th percentile of processor time in `vps trade
/// scenes/peg_in_hole/scene.toml` on a shared 2-core Xeon; for another machine, `vps trade` measures which
/// setting reaches a required physics rate. The cost model depends only on numbers of points, so that the
/// choice of a fidelity is the same on every machine.
inline constexpr double kStepBase_us = 400, kStepPoint_us = 0.055;

struct FidelityChoice {
  Fidelity fidelity;
  bool is_met = false;
  std::string failure_reason;  ///< which bound cannot be kept, and the remedy; empty when all bounds are kept
  double error_m = 0;          ///< measured error of depth, as defined in FidelityWish::tolerance_m
  std::size_t points = 0, points_near = 0,
              bytes = 0;  ///< numbers and memory of the built models; bytes include the cooked field
  double step_us = 0;     ///< step time by the cost model
};

struct ChoiceOptions {
  Progress progress;
  /// Memory that models may take while they are built; 0: half of this machine's memory. The limit never
  /// changes a choice: a scene that needs more memory gets no choice.
  double machine_bytes = 0;
};

/// Finds the coarsest voxel that keeps the tolerance (measured against the exact surfaces at seeded points),
/// with a point spacing of twice the voxel. To keep the rate and the memory limit, the search then takes
/// fewer points (up to four times the spacing, a sixteenth of the points). If the wish states no tolerance,
/// the search also uses points on one side only to keep the rate, and larger voxels to keep the memory limit.
/// The search starts from the scene's own fidelity. If the wish is met, the scene's parts keep the models of
/// the choice. Deterministic: the same scene gives the same choice on every machine. The search takes seconds
/// for a scene of ten parts. Throws LoadError for a part that cannot be modelled.
VPS_SCENES_API FidelityChoice chooseFidelity(Scene& scene, FidelityWish wish,
                                             const ChoiceOptions& options = {});

/// Chooses the fidelity of a scene whose file says `auto`, and notes the choice in the scene; otherwise
/// chooses the voxel and the spacing that the file leaves open (chooseResolution()). Every scene needs this
/// call between loadScene() and its use. Throws LoadError with file and line if the wish cannot be met, and
/// in the cases of chooseFidelity().
VPS_SCENES_API void resolveFidelity(Scene& scene, const ChoiceOptions& options = {});

/// The fidelity as lines of a scene file.
VPS_SCENES_API std::string toToml(const Fidelity& fidelity);

/// The choice in words: "voxel 0.18 mm, spacing 0.35 mm, both sides: 12345 points, 8.1 MB, a step of 900 us
/// by the cost model, ...".
VPS_SCENES_API std::string describe(const FidelityChoice& choice);

/// Voxels across the least size that has to be resolved: of a moved part, of a bore or slot, and of the part
/// that fits into the bore or slot. Measured with a peg of 8 mm (scenes/peg_in_hole): with voxels of 1 mm the
/// peg reaches its target less than 1 um deep, with voxels of 2 mm it penetrates the rim of its hole by 129
/// um.
inline constexpr double kVoxelsAcross = 8;

/// Size of a cube [m] that bounds a part's voxmap: the voxmap takes no more memory than that of this cube
/// with the voxels of the preset `normal`. Larger parts get larger voxels, which suffice to find contacts
/// because the depths of the contacts are measured on the exact surfaces.
inline constexpr double kLargestUsual_m = 0.15;

/// Sets voxel and spacing if the scene leaves them open (Scene::chooses_voxel, chooses_spacing). The rule is
/// the same for scenes of all sizes:
/// - A voxel is that of the preset `normal`, or an eighth of the least size that has to be resolved (width of
/// parts, bores and slots, and the walls that fit into slots), whichever is less.
/// - The voxel is enlarged if the part's voxmap would take more memory than that of a cube of
/// kLargestUsual_m.
///
/// In a scene without steps each movable part has its own voxel, and the fixed parts share one voxel. In a
/// scene with steps all parts share one voxel, as fitFidelity() chooses it. A stated spacing is kept. If the
/// sum of all models would exceed kMostModels_bytes, the voxels of parts that the memory rule enlarged grow
/// by one common factor. The choice depends on the scene alone. Notes the choice in Scene::resolution_choice,
/// also if the memory limit prevents the required resolution. O(triangles log triangles); no model is built.
VPS_SCENES_API void chooseResolution(Scene& scene);

}  // namespace vps::scenes
