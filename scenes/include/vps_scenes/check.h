// SPDX-License-Identifier: BSD-3-Clause
// Exact measures of an assembly as drawn, without a hand: overlap and clearance of its parts, fits, play.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vps/mesh.h"
#include "vps/progress.h"
#include "vps_scenes/export.h"
#include "vps_scenes/import.h"
#include "vps_scenes/scene.h"

namespace vps::scenes::inline v0 {

/// A part where it belongs in the assembly.
struct DrawnPart {
  std::string name;
  Mesh mesh;
  Pose X_WP;
  /// Greatest distance of the mesh from the curved faces that it stands for, where the file format says it;
  /// empty: it is estimated from the angles between facets.
  std::optional<double> chord_m;
  bool allow_overlap = false;  ///< of an interference fit: its overlap is reported and is no clash
};

/// The parts of a CAD file at their poses.
VPS_SCENES_API std::vector<DrawnPart> drawnParts(const ImportedCad& cad);
/// The parts of a scene: those that a step mounts at the target of their last step, others at their pose.
VPS_SCENES_API std::vector<DrawnPart> drawnParts(const Scene& scene);

struct CheckSettings {
  double near_m = 1e-3;  ///< pairs with more clearance are not reported
  bool has_fits = true;
  bool has_play = true;  ///< with the ways out
};

enum class PairState {
  Apart,    ///< the clearance is more than its error
  Contact,  ///< the surfaces meet to within the error; coincident faces are contact
  Clash,    ///< the parts overlap by more than the error
};
VPS_SCENES_API const char* toText(PairState state);

/// Two parts that are near each other. All errors include the distance of the meshes from the faces that they
/// stand for.
struct CheckedPair {
  std::string a, b;
  PairState state = PairState::Apart;
  double clearance_m = 0;           ///< least distance of the surfaces; 0 where the meshes overlap
  double interference_depth_m = 0;  ///< of the meshes, as Overlap::depth_m
  double interference_volume_m3 = 0;
  double volume_error_m3 = 0;
  double error_m = 0;        ///< of clearance and depth
  Vec3 at_W = Vec3::Zero();  ///< of the deepest overlap, or between the nearest points
  bool is_allowed = false;   ///< an overlap that the scene allows
  [[nodiscard]] bool isClash() const { return state == PairState::Clash && !is_allowed; }
};

enum class FitKind {
  Shaft,  ///< a round shaft in a bore
  Key,    ///< two parallel faces between two others
};
VPS_SCENES_API const char* toText(FitKind kind);

/// A part that fits into another: found from facets that lie on a common cylinder or plane.
struct CheckedFit {
  FitKind kind = FitKind::Shaft;
  std::string shaft, bore;         ///< the inner and the outer part
  Vec3 axis_W = Vec3::UnitZ();     ///< of the cylinders; of a key across its faces. Unit
  Vec3 at_W = Vec3::Zero();        ///< on the axis, in the middle of the length
  double shaft_m = 0, bore_m = 0;  ///< diameters, or widths, as drawn
  double length_m = 0;  ///< over which both are found, along the axis; of a key the overlap's longer side
  double diametral_clearance_m = 0;  ///< negative: interference
  double error_m = 0;                ///< of the clearance
  std::string iso_286;               ///< "H7/g6" if both sizes lie in the zones of a common fit, else empty
};

/// How far a part moves along or turns about an axis before it touches, the other parts held. Infinite where
/// it moves away, or turns a whole turn.
struct Play {
  std::array<double, 6> m = {};    ///< +x, -x, +y, -y, +z, -z
  std::array<double, 6> rad = {};  ///< about the same axes
};

struct CheckedPart {
  std::string name;
  std::size_t triangles = 0;
  double chord_error_m = 0;             ///< greatest distance of the mesh from its curved faces
  std::string mesh_faults;              ///< in words; empty for a closed mesh
  std::optional<Play> play;             ///< none for a part that clashes, and if not asked for
  Mat3 play_axes_W = Mat3::Identity();  ///< columns: the axes of `play`
  Vec3 play_center_W = Vec3::Zero();    ///< through which the axes of rotation go
  double play_error_m = 0, play_error_rad = 0;
  std::vector<Vec3> ways_out_W;  ///< unit directions in which it leaves the others on a straight line
};

struct CheckResult {
  std::string assembly;
  std::vector<CheckedPair> pairs;  ///< clashes first, the deepest first; then by clearance
  std::vector<CheckedFit> fits;
  std::vector<CheckedPart> parts;
  double prepare_wall_s = 0, pairs_wall_s = 0, fits_wall_s = 0, play_wall_s = 0;
  [[nodiscard]] std::size_t clashes() const;
  /// The deepest overlap that is not allowed; null if there is none.
  [[nodiscard]] const CheckedPair* deepestClash() const;
};

/// Measures the parts as they stand, on all cores. The same bits on any number of threads. Throws LoadError
/// for parts without a surface, and of sizes at which the answers would mean nothing (below 10 um, above
/// 1 km).
VPS_SCENES_API CheckResult checkAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                                         const CheckSettings& settings = {}, const Progress& progress = {});

}  // namespace vps::scenes::inline v0
