// SPDX-License-Identifier: BSD-3-Clause
// A scene as data, as its file says it: parts, poses, device, operator, fidelity, procedure. The file's
// format is documented in scenes/README.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vps/byte_cache.h"
#include "vps/errors.h"
#include "vps/fidelity.h"
#include "vps/part_model.h"
#include "vps_scenes/cad/face_colors.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// What a scene says of a part itself, in the part's own frame P.
struct Part {
  std::string name;
  Mesh mesh;
  Material material;
  Color color = {0.7f, 0.72f, 0.75f};  ///< linear RGB, 0 to 1
  FaceColors face_colors = {};         ///< of its triangles, where they differ
};

/// What a part's tolerance of size is meant for.
enum class SizeOf { Shaft, Hole };
inline const char* toText(SizeOf of) {
  return of == SizeOf::Hole ? "hole" : "shaft";
}

/// How a deviation lies within its limits.
enum class Distribution {
  Normal,   ///< around the middle; the limits are three standard deviations away
  Uniform,  ///< evenly between the limits
};
inline const char* toText(Distribution distribution) {
  return distribution == Distribution::Uniform ? "uniform" : "normal";
}

/// How far a part may be off, for study() (study.h); no run of the scene itself uses it.
struct PartTolerance {
  std::string size_class;           ///< of ISO 286: "H7" of a hole, "g6" of a shaft; empty: none
  double nominal_m = 0;             ///< of size_class; 0: from the mesh
  double lower_m = 0, upper_m = 0;  ///< deviations of diameter or width from the drawn one
  SizeOf size_of = SizeOf::Shaft;   ///< of these deviations
  double position_m = 0;            ///< greatest displacement along each axis of the part
  double angle_rad = 0;             ///< greatest rotation about each axis of the part
  double friction = 0;              ///< greatest difference from the material's friction
  Distribution distribution = Distribution::Normal;
};

struct ScenePart {
  Part part;
  Pose X_WP;                   ///< as designed: the pose in the CAD file, or that of the scene file
  Twist V_WP_W;                ///< of its origin, at the start of simulate(); assemble() starts at rest
  bool is_fixed = false;       ///< never moves; in place from the start
  bool allow_overlap = false;  ///< may start inside another part (interference fits)
  bool is_scenery = false;     ///< of assemble(): nothing collides with it
  /// Of an interference fit, as declared: by how much the part may be larger than where it is pressed in. In
  /// diameter or width for a fit that check finds, else in depth; 0: none.
  double press_fit_m = 0;
  double youngs_modulus_Pa = 210e9;  ///< of steel, and Poisson's ratio: EN 1993-1-1, 3.2.6
  double poissons_ratio = 0.3;
  PartTolerance tolerance;
  std::string file;                    ///< file that the mesh was read from, for messages
  std::vector<std::string> members;    ///< of a group: the parts that it is made of
  std::string fastener;                ///< what it is taken for by its shape, in words: "nut M8"; empty: none
  std::optional<double> deflection_m;  ///< see ImportedPart, as rounding_m
  double rounding_m = 0;
  /// Of its own models, where chooseResolution() (resolution.h) found others right than the scene's; 0: those
  /// of Scene::fidelity. A part in the fixed field has the scene's.
  double voxel_m = 0, spacing_m = 0;
  /// Built from `part` at the scene's fidelity; null until then, and for a part that is only drawn.
  std::shared_ptr<const PartModel> model;
  bool is_cropped = false;  ///< `model` covers only the regions of the model plan that it was built for
};

/// How the hand brings a part home.
enum class StepMotion {
  Push,   ///< along the last leg of its path
  Screw,  ///< turned about that leg, through its centre of mass
};

inline const char* toText(StepMotion motion) {
  return motion == StepMotion::Screw ? "screw" : "push";
}

/// One step of the procedure: bring `part` from its start to its target by contact.
struct SceneStep {
  std::size_t part = 0;
  Pose X_WP_start;
  Pose X_WP_target;
  std::vector<Pose> way_points;  ///< poses of the part that the operator passes, between start and target
  double tolerance_m = 0;        ///< greatest distance of its surface from where it belongs; 0: from its fit
  double tolerance_rad = 0;      ///< greatest rotation from the target; 0: not judged, the surface is
  double clearance_m = 0;  ///< diametral clearance of the tightest fit, as stated in the file; 0: not stated
  double timeout_s = 20;
  /// A fixture or the other hand holds it after release, so that it need not stay by itself.
  bool is_held = false;
  StepMotion motion = StepMotion::Push;
  double pitch_m = 0;    ///< of a screw, for one turn; negative: a left-hand thread
  double torque_Nm = 0;  ///< at which a screw is tight; 0: it is turned to the height of its target
  /// The part is in place at its start until this step takes it off and puts it away at its target, see
  /// disassemblyOf(). Not a key of a scene file.
  bool takes_off = false;
};
/// Where the part is while it is in place: after a step that mounts it, or before one that takes it off.
inline const Pose& placeOf(const SceneStep& step) {
  return step.takes_off ? step.X_WP_start : step.X_WP_target;
}

/// The virtual operator. Values and sources: vps_device/operator.h.
struct OperatorSettings {
  std::uint64_t seed = 1;
  double aim_error_m = 0.3e-3;  ///< standard deviation of the aim across the path
  double aim_error_rad = 0.005;
  double aim_turn_rad = 0;    ///< greatest error about the axis of insertion that sight does not correct
  double speed_m_s = 0.05;    ///< average along the path
  double press_N = 5;         ///< force with which the operator presses a part home
  double force_limit_N = 15;  ///< the operator backs off above this
};

struct DeviceSettings {
  std::string kind = "dual_arm";  ///< dual_arm, or a name that `vps device --list` shows
  std::string data;               ///< parameter file; empty: the built-in dual arm
  double scale = 1;               ///< scene metres per device metre
  bool has_quantised_encoders = true;
  /// A path longer than the workspace is split; the device is clutched and recentred between the segments.
  bool has_indexing = true;
  /// Where the device stands in the scene, by `vps calibrate`: p_W = placement (scale p_D). Then a part that
  /// a person takes is where the hand is. None: the device's axes are the scene's.
  std::optional<Pose> placement;
};

/// Coupling gains that a scene prescribes; the others follow from the device's numbers and rates
/// (deriveGains).
struct CouplingWishes {
  std::optional<double> k_N_per_m, b_Ns_per_m, k_Nm_per_rad, b_Nms_per_rad, max_force_N, max_torque_Nm;
};

struct RecordSettings {
  double csv_rate_hz = 250;  ///< rows of trace.csv a second; above the physics rate: every step
};

/// Bounds that a fidelity must keep; what is not set does not matter. chooseFidelity() finds one.
struct FidelityWish {
  std::optional<double> budget_hz;    ///< physics steps a second
  std::optional<double> tolerance_m;  ///< greatest error of depth at 95 of 100 points of every surface
  std::optional<double> memory_bytes;
  std::string place;  ///< "scene.toml:4", the line of the wish, for messages
};

/// What a scene file says. settings_fields.h has a row for each of its keys.
struct Scene {
  std::string file;
  std::string name;
  std::vector<std::string> warnings;  ///< defects found in the CAD files, one line each
  std::string missing;                ///< geometry of the CAD files that no part has, in words; empty: none
  std::vector<ScenePart> parts;
  std::vector<SceneStep> steps;
  Vec3 gravity_W = Vec3(0, 0, -9.81);
  Fidelity fidelity;
  /// Of `fidelity = "auto"`: not yet chosen. resolveFidelity() (fidelity_choice.h) turns it into `fidelity`;
  /// without that no run takes the scene.
  std::optional<FidelityWish> fidelity_wish;
  std::string fidelity_choice;  ///< what was chosen for `auto`, in words; empty: nothing was
  /// The file states no voxel, or no spacing: resolveFidelity() may choose others than those of the preset
  /// `normal`, by the sizes of the parts (resolution.h).
  bool chooses_voxel = false, chooses_spacing = false;
  std::string resolution_choice;  ///< what was chosen by the parts' sizes, in words; empty: the preset serves
  CouplingWishes coupling;
  DeviceSettings device;
  OperatorSettings hand;
  RecordSettings record;
  double release_s = 2;  ///< a mounted part stays dynamic for this long before it joins the fixed field
};

/// Reads a scene file and the CAD files that it names; builds no models. Throws LoadError with file, line,
/// key and remedy, and what `progress` throws.
/// @param cache  see ImportSettings; may be null
VPS_SCENES_API Scene loadScene(const std::string& file, const Progress& progress = {},
                               const ByteCache* cache = nullptr);

}  // namespace vps::scenes
