// SPDX-License-Identifier: BSD-3-Clause
// A scene as data, as read from its file: parts, poses, device, operator, fidelity, procedure. README.md of
// this folder links to the documentation of the file.
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
#include "vps_scenes/cad/colors.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// The properties of a part that do not depend on its place, in the part's own frame P.
struct Part {
  std::string name;
  Mesh mesh;
  Material material;
  Color color = {0.7f, 0.72f, 0.75f};  ///< linear RGB, 0 to 1
  FaceColors face_colors = {};         ///< colours of the triangles, if the part has several colours
};

/// The feature that a part's tolerance of size describes.
enum class SizeOf { Shaft, Hole };
inline const char* toText(SizeOf of) {
  return of == SizeOf::Hole ? "hole" : "shaft";
}

/// Distribution of a deviation within its limits.
enum class Distribution {
  Normal,   ///< normal, around the mean; the limits are three standard deviations away
  Uniform,  ///< uniform between the limits
};
inline const char* toText(Distribution distribution) {
  return distribution == Distribution::Uniform ? "uniform" : "normal";
}

/// Tolerances of a part, for study() (study.h). A run of the scene itself does not use them.
struct PartTolerance {
  std::string size_class;           ///< class of ISO 286: "H7" of a hole, "g6" of a shaft; empty: none
  double nominal_m = 0;             ///< nominal size for size_class; 0: taken from the mesh
  double lower_m = 0, upper_m = 0;  ///< limits of the deviation from the drawn diameter or width
  SizeOf size_of = SizeOf::Shaft;   ///< feature that lower_m and upper_m describe
  double position_m = 0;            ///< greatest displacement along each axis of the part
  double angle_rad = 0;             ///< greatest rotation about each axis of the part
  double friction = 0;              ///< greatest difference from the material's friction
  Distribution distribution = Distribution::Normal;
};

struct ScenePart {
  Part part;
  Pose X_WP;     ///< designed pose, from the scene file or else from the CAD file
  Twist V_WP_W;  ///< velocity of the part's origin at the start of simulate(); assemble() starts at rest
  bool is_fixed = false;       ///< the part never moves and is in place from the start
  bool allow_overlap = false;  ///< the part may start inside another part (interference fits)
  bool is_scenery = false;     ///< assemble() leaves the part out: nothing collides with it
  /// Declared interference of a press fit: the excess of the part's size over the hole's, in diameter or
  /// width for a fit that check() finds, else in depth; 0: none.
  double press_fit_m = 0;
  double youngs_modulus_Pa =
      210e9;  ///< default of Young's modulus and Poisson's ratio: steel, EN 1993-1-1, 3.2.6
  double poissons_ratio = 0.3;
  PartTolerance tolerance;
  std::string file;                  ///< file that the mesh was read from, for messages
  std::vector<std::string> members;  ///< names of the united parts of a group; empty for a single part
  /// See ImportedPart::within; of a united part: what all its members are within.
  std::vector<std::string> within;
  std::string fastener;                ///< fastener recognized by its shape, in words: "nut M8"; empty: none
  std::optional<double> deflection_m;  ///< see ImportedPart, also for rounding_m
  double rounding_m = 0;
  /// Voxel and spacing of the part's own models, if chooseResolution() (resolution.h) chose other values than
  /// the scene's; 0: the values of Scene::fidelity. In the fixed field, every part has the scene's values.
  double voxel_m = 0, spacing_m = 0;
  /// The models of the part at the scene's fidelity; null before they are built, and for a part that is only
  /// drawn.
  std::shared_ptr<const PartModel> model;
  bool is_cropped = false;  ///< `model` covers only the regions of its model plan
};

/// Motion by which the hand brings a part to its target.
enum class StepMotion {
  Push,   ///< the part moves along the last leg of its path
  Screw,  ///< the part also rotates about the last leg, through its centre of mass
};

inline const char* toText(StepMotion motion) {
  return motion == StepMotion::Screw ? "screw" : "push";
}

/// One step of the procedure: bring `part` from its start to its target, in contact with other parts.
struct SceneStep {
  std::size_t part = 0;
  Pose X_WP_start;
  Pose X_WP_target;
  std::vector<Pose> way_points;  ///< poses of the part that the operator passes, between start and target
  double tolerance_m = 0;        ///< greatest distance of the part's surface from its place at the target; 0:
                                 ///< chosen by the part's fit
  double tolerance_rad = 0;      ///< greatest rotation from the target; 0: only the surface is judged
  double clearance_m = 0;  ///< diametral clearance of the tightest fit, as stated in the file; 0: not stated
  double timeout_s = 20;
  /// A fixture or the other hand holds the part after its release, so that it need not stay in place by
  /// itself.
  bool is_held = false;
  StepMotion motion = StepMotion::Push;
  double pitch_m = 0;    ///< travel of a screw in one turn; negative: a left-hand thread
  double torque_Nm = 0;  ///< torque at which a screw is tight; 0: the screw is turned to its target's height
  /// The part is in place at its start until this step takes it off and puts it away at its target, see
  /// disassemblyOf(). A scene file has no key for this member.
  bool takes_off = false;
};
/// The pose of a part that is in place: after a step that mounts it, or before a step that takes it off.
inline const Pose& placeOf(const SceneStep& step) {
  return step.takes_off ? step.X_WP_start : step.X_WP_target;
}

/// The virtual operator. Values and sources: vps_device/operator.h.
struct OperatorSettings {
  std::uint64_t seed = 1;
  double aim_error_m = 0.3e-3;  ///< standard deviation of the aim across the path
  double aim_error_rad = 0.005;
  double aim_turn_rad = 0;  ///< greatest error of the aim about the axis of insertion, not corrected by sight
  double speed_m_s = 0.05;  ///< average speed along the path
  double press_N = 5;       ///< force with which the operator presses a part into its place
  double force_limit_N = 15;  ///< the operator backs off above this force
};

struct DeviceSettings {
  std::string kind = "dual_arm";  ///< dual_arm, or a name that `vps device --list` shows
  std::string data;               ///< parameter file; empty: the built-in dual arm
  double scale = 1;               ///< scene metres per device metre
  bool has_quantised_encoders = true;
  /// A path longer than the workspace is split; the device is clutched and recentred between the segments.
  bool has_indexing = true;
  /// Pose of the device in the scene, from `vps calibrate`: p_W = placement (scale p_D), so that a part that
  /// a person holds appears at the hand. Without a placement, the device's axes are the scene's.
  std::optional<Pose> placement;
};

/// Coupling gains that a scene prescribes. Empty gains follow from the device's parameters and the rates
/// (deriveGains()).
struct CouplingWishes {
  std::optional<double> k_N_per_m, b_Ns_per_m, k_Nm_per_rad, b_Nms_per_rad, max_force_N, max_torque_Nm;
};

struct RecordSettings {
  double csv_rate_hz = 250;  ///< rows of trace.csv per second; above the physics rate: a row for each step
};

/// Bounds that a fidelity must keep; an empty bound does not apply. chooseFidelity() finds a fidelity that
/// keeps the bounds.
struct FidelityWish {
  std::optional<double> budget_hz;    ///< least number of physics steps per second
  std::optional<double> tolerance_m;  ///< greatest error of depth at 95 of 100 points of every surface
  std::optional<double> memory_bytes;
  std::string place;  ///< "scene.toml:4", the line of `fidelity`, for messages
};

/// The content of a scene file. settings_fields.h has a row for each key.
struct Scene {
  std::string file;
  std::string name;
  std::vector<std::string> warnings;  ///< defects found in the CAD files, one line each
  std::string missing;                ///< geometry of the CAD files that is in no part, in words; empty: none
  std::vector<ScenePart> parts;
  std::vector<SceneStep> steps;
  Vec3 gravity_W = Vec3(0, 0, -9.81);
  Fidelity fidelity;
  /// Bounds of `fidelity = "auto"` before the choice. resolveFidelity() (fidelity_choice.h) must turn them
  /// into `fidelity` before a run.
  std::optional<FidelityWish> fidelity_wish;
  std::string fidelity_choice;  ///< choice for `auto`, in words; empty: none
  /// The file states no voxel, or no spacing, so that resolveFidelity() may replace the value of the preset
  /// `normal` by one that suits the sizes of the parts (resolution.h).
  bool chooses_voxel = false, chooses_spacing = false;
  std::string resolution_choice;  ///< voxel and spacing chosen by the sizes of the parts, in words; empty:
                                  ///< the preset's values
  CouplingWishes coupling;
  DeviceSettings device;
  OperatorSettings hand;
  RecordSettings record;
  double release_s = 2;  ///< a mounted part stays dynamic for this long before it joins the fixed field
};

/// Reads a scene file and the CAD files that it names; builds no models. Throws LoadError with file, line,
/// key and remedy, and any exception that `progress` throws.
/// @param cache  see ImportSettings::cache; may be null
VPS_SCENES_API Scene loadScene(const std::string& file, const Progress& progress = {},
                               const ByteCache* cache = nullptr);

}  // namespace vps::scenes
