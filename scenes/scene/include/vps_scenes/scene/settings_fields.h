// SPDX-License-Identifier: BSD-3-Clause
// The keys of a scene file: one field table for each of its TOML tables, in the order of the documentation,
// which is made from these tables. Rows of `field()` are read and written without further code. They are also
// archived, except those of kSceneKeys, kPartKeys, kToleranceFields and kFidelityWishFields: what a recording
// needs of these is named in run/src/record/scene_archive.cpp. Rows of `Key` are documented only;
// loadScene(), sceneText() and the archive name their members.
#pragma once

#include "vps_scenes/scene/fields.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

template <>
inline constexpr int kValueCount<Sides> = 2;
template <>
inline constexpr int kValueCount<Gradient> = 2;
template <>
inline constexpr int kValueCount<ContactMethod> = 2;
template <>
inline constexpr int kValueCount<StepMotion> = 2;

template <>
inline constexpr int kValueCount<SizeOf> = 2;
template <>
inline constexpr int kValueCount<Distribution> = 2;

inline constexpr Range kRate_Hz{.min = 1, .max = 1e6};
inline constexpr Range kCount{.min = 1, .max = 1e6};

/// Keys at the top of a scene file.
inline constexpr auto kSceneKeys = std::make_tuple(
    Key{"name", "text", "the folder's name", "name of the scene in reports"},
    Key{"unit", "`\"um\"`, `\"mm\"`, `\"cm\"`, `\"m\"`, `\"inch\"`", "none",
        "unit of lengths that are plain numbers, and of meshes that state no unit"},
    Key{"gravity", "3 numbers [m/s^2]", "`[0, 0, -9.81]`", "acceleration of gravity in the world"},
    Key{"cad", "file", "none",
        "CAD file of an assembly: each part of the file is a part of the scene, with its name and designed "
        "pose"},
    Key{"cad_fallback", "file", "none",
        "file that is read instead of `cad` if this build lacks the library for the format of `cad`; both "
        "files have the same part names"},
    Key{"deflection", "length", "`\"1um\"`",
        "greatest distance between a curved face and its triangles, for STEP and IGES files"},
    Key{"missing", "text", "none",
        "geometry of the CAD file that no part has; each command warns of this geometry; `vps import` writes "
        "the key"},
    field("release_s", &Scene::release_s,
          "time for which a mounted part stays dynamic before it joins the fixed field",
          {.range = kNotNegative, .type = "seconds"}),
    Key{"material", "table", "steel",
        "`density`, `friction`, `restitution`, `stiffness` of all parts that state no values of their own"},
    Key{"part"}, Key{"group"}, Key{"step"}, Key{"device"}, Key{"operator"}, Key{"coupling"}, Key{"fidelity"},
    Key{"record"});

inline constexpr auto kMaterialFields = std::make_tuple(
    field("density", &Material::density_kg_m3, "density of the material",
          {.range = kPositive, .type = "kg/m^3"}),
    field("friction", &Material::friction,
          "Coulomb coefficient of the material on itself; two parts have the geometric mean "
          "of their coefficients",
          {.range = kNotNegative}),
    field("restitution", &Material::restitution,
          "coefficient of restitution, 0 inelastic to 1 elastic; two parts have the product of their values",
          {.range = {.min = 0, .max = 1}, .type = "0 to 1"}),
    field("stiffness", &Material::stiffness_N_per_m3,
          "penalty stiffness per area; two parts have the lower of their values",
          {.range = kPositive, .type = "N/m^3"}));
static_assert(coversAllMembers<Material>(kMaterialFields));

/// `[[part]]`: tolerances for `vps study`. The tolerances are not archived, since a recording holds a single
/// run.
inline constexpr auto kToleranceFields = std::make_tuple(
    field(
        "size_tolerance", &PartTolerance::size_class,
        "`vps study`: tolerance class of ISO 286 of the part's fit, `\"H7\"` (a hole) or `\"g6\"` (a shaft)",
        {.default_text = "none"}),
    field("nominal_size", &PartTolerance::nominal_m, "`vps study`: nominal size for `size_tolerance`",
          {.quantity = Quantity::Length,
           .range = kNotNegative,
           .default_text = "the drawn size, rounded to half a millimetre"}),
    field(
        "size_lower", &PartTolerance::lower_m,
        "`vps study`: least deviation of diameter or width from the drawn one, in place of `size_tolerance`",
        {.quantity = Quantity::Length}),
    field("size_upper", &PartTolerance::upper_m,
          "`vps study`: greatest deviation of diameter or width from the drawn one",
          {.quantity = Quantity::Length}),
    field("size_of", &PartTolerance::size_of,
          "`vps study`: the feature that `size_lower` and `size_upper` describe"),
    field("position_tolerance", &PartTolerance::position_m,
          "`vps study`: greatest displacement of the part along each of its axes",
          {.quantity = Quantity::Length, .range = kNotNegative}),
    field("angle_tolerance_deg", &PartTolerance::angle_rad,
          "`vps study`: greatest rotation of the part about each of its axes",
          {.quantity = Quantity::Angle, .range = kNotNegative}),
    field("friction_tolerance", &PartTolerance::friction,
          "`vps study`: greatest deviation of the friction coefficient from `friction`",
          {.range = kNotNegative}),
    field("distribution", &PartTolerance::distribution,
          "`vps study`: distribution of each deviation; normal: the limits are three standard deviations "
          "from their mean; uniform: constant density between the limits"));
static_assert(coversAllMembers<PartTolerance>(kToleranceFields));

/// `[[part]]`
inline constexpr auto kPartKeys = std::make_tuple(
    Key{"file", "file", "", "mesh or CAD file, in any format that `vps import` reads"},
    Key{"node", "text", "",
        "the part's name within the file, if the file has several parts; `\"*\"`: the whole file as one "
        "part"},
    Key{"name", "text", "`node`, or the file's stem", "name of the part, unique in the scene"},
    Key{"pose", "pose", "as in the file", "designed pose in the world"},
    Key{"velocity_m_s", "3 numbers", "0",
        "velocity of the part's origin in the world, at the start of `vps simulate`"},
    Key{"angular_velocity_rad_s", "3 numbers", "0",
        "angular velocity of the part in the world, at the start of `vps simulate`"},
    field("fixed", &ScenePart::is_fixed, "the part never moves and is in place from the start"),
    group("", path(&ScenePart::part, &Part::material), kMaterialFields),
    Key{"color", "`\"#rrggbb\"` or 3 numbers 0 to 1", "as in the file, or grey", "colour in sRGB"},
    field("deflection", &ScenePart::deflection_m,
          "greatest distance of the mesh from the exact faces; `vps import` writes the key",
          {.quantity = Quantity::Length, .range = kNotNegative, .default_text = "the file's, or estimated"}),
    field("rounding", &ScenePart::rounding_m,
          "greatest displacement of the vertices by a file that rounded them to 32-bit floats; `vps import` "
          "writes the key",
          {.quantity = Quantity::Length, .range = kNotNegative, .default_text = "the file's"}),
    field("allow_overlap", &ScenePart::allow_overlap,
          "the part may start inside another one (interference fits)"),
    field("press_fit", &ScenePart::press_fit_m,
          "declared interference of a part that is pressed in, in diameter or width: `vps check` compares an "
          "overlap with this length and computes the force",
          {.quantity = Quantity::Length, .range = kNotNegative, .default_text = "none"}),
    field("youngs_modulus", &ScenePart::youngs_modulus_Pa,
          "Young's modulus, for the force of a press fit; assumed: steel",
          {.range = kPositive, .type = "Pa"}),
    field("poissons_ratio", &ScenePart::poissons_ratio,
          "Poisson's ratio, for the force of a press fit; assumed: steel", {.range = {.min = 0, .max = 0.5}}),
    field("scenery", &ScenePart::is_scenery,
          "`vps assemble` leaves the part out: the part is not fixed, no step moves it, and nothing collides "
          "with it"),
    field("fastener", &ScenePart::fastener,
          "kind of fastener that `vps plan` recognized by the shape, as `\"nut M8\"`; information for "
          "readers, without effect",
          {.default_text = "none"}),
    group("", &ScenePart::tolerance, kToleranceFields));

/// `[[group]]`
inline constexpr auto kGroupKeys = std::make_tuple(
    Key{"name", "text", "required", "name of the body, which the steps use in place of its parts' names"},
    Key{"parts", "list of texts", "required", "names of two or more parts, which are in no other group"});

/// `[[step]]`
inline constexpr auto kStepKeys = std::make_tuple(
    Key{"part", "text", "required", "name of the part to mount"},
    Key{"target", "pose", "the designed pose", "pose of the mounted part"},
    Key{"start", "pose", "see below",
        "pose in which the hand takes the part; position or rotation that is left out is the target's"},
    Key{"approach", "3 lengths", "see below", "offset of the start from the target, in the world"},
    Key{"way_points", "list of poses", "none",
        "poses of the part that the hand passes, from start to target"},
    field("tolerance", &SceneStep::tolerance_m,
          "greatest distance of the part's surface from its place at the target",
          {.quantity = Quantity::Length,
           .range = kNotNegative,
           .default_text =
               "20 um plus the clearance of the tightest fit that `vps check` finds at the target, at most "
               "0.1 mm; for a rectangular hole at least the distance by which the play lets the part lie in "
               "a corner (0.71 of the clearance plus 20 um, at most 0.5 mm); 0.5 mm if no fit is found, or "
               "with `holds`, since the operator then stops the part by sight alone"}),
    field("tolerance_deg", &SceneStep::tolerance_rad, "greatest rotation from the target",
          {.quantity = Quantity::Angle, .range = kNotNegative, .default_text = "not judged"}),
    field("clearance", &SceneStep::clearance_m,
          "diametral clearance of the tightest fit that the part enters; the part may penetrate another by a "
          "quarter of this clearance, and by 10 um at most",
          {.quantity = Quantity::Length, .range = kNotNegative, .default_text = "not stated"}),
    field("timeout_s", &SceneStep::timeout_s, "simulated time after which the step has failed",
          {.range = kPositive, .type = "seconds"}),
    field("holds", &SceneStep::is_held,
          "a fixture or the other hand holds the part after its release, so that it need not stay in place "
          "by itself",
          {.since = 4}),
    field("motion", &SceneStep::motion,
          "push: the part moves along the last leg of the path; screw: the part also rotates about the last "
          "leg, see below",
          {.since = 5}),
    field("pitch", &SceneStep::pitch_m,
          "lead of a screw, the travel in one turn; negative: a left-hand thread",
          {.quantity = Quantity::Length, .since = 5, .default_text = "found in the mesh"}),
    field("torque_Nm", &SceneStep::torque_Nm,
          "torque to which a screw is tightened: the hand turns the screw until it resists with this torque",
          {.range = kNotNegative,
           .since = 5,
           .default_text = "the screw is turned to the height of its target"}));
static_assert(coversAllMembers<SceneStep, 5>(kStepKeys));

/// `[device]`
inline constexpr auto kDeviceKeys = std::make_tuple(
    field("kind", &DeviceSettings::kind, "`dual_arm`, or a name that `vps device --list` shows"),
    // loadScene() reads this key without the field table, since it checks the file and the member is a path.
    Key{"parameters", "file", "none",
        "parameters that differ from [the built-in dual arm](../../device/data/dual_arm.toml)"},
    field("scale", &DeviceSettings::scale, "scene metres per device metre", {.range = kPositive}),
    field("quantised_encoders", &DeviceSettings::has_quantised_encoders,
          "the device's encoders have a finite resolution"),
    field("indexing", &DeviceSettings::has_indexing,
          "a path that exceeds the workspace or the rotation of the device is split, see below; false: such "
          "a path is an error",
          {.since = 3}),
    // loadScene() reads this key without the field table, since its value is a pose.
    Key{"placement", "pose", "none",
        "pose of the device in the scene, from `vps calibrate`, so that a part that a person holds appears "
        "at the hand. None: the device's axes are the scene's"});
static_assert(coversAllMembers<DeviceSettings, 2>(kDeviceKeys));

/// `[operator]`
inline constexpr auto kOperatorFields = std::make_tuple(
    field("seed", &OperatorSettings::seed, "seed of the operator's aim", {.range = kNotNegative}),
    field("aim_error", &OperatorSettings::aim_error_m, "standard deviation of the aim across the path",
          {.quantity = Quantity::Length, .range = kNotNegative}),
    field("aim_error_deg", &OperatorSettings::aim_error_rad, "standard deviation of the aimed orientation",
          {.quantity = Quantity::Angle, .range = kNotNegative}),
    field("aim_turn_deg", &OperatorSettings::aim_turn_rad,
          "greatest error about the axis of insertion, which the operator does not correct by sight",
          {.quantity = Quantity::Angle, .range = kNotNegative, .since = 4}),
    field("speed_m_s", &OperatorSettings::speed_m_s, "average speed along the path", {.range = kPositive}),
    field("press_N", &OperatorSettings::press_N,
          "force with which the operator presses a part into its place", {.range = kNotNegative}),
    field("force_limit_N", &OperatorSettings::force_limit_N, "the operator backs off above this force",
          {.range = kPositive}));
static_assert(coversAllMembers<OperatorSettings>(kOperatorFields));

/// `[coupling]`
inline constexpr auto kCouplingFields = std::make_tuple(
    field("k_N_per_m", &CouplingWishes::k_N_per_m, "stiffness", {.range = kNotNegative}),
    field("b_Ns_per_m", &CouplingWishes::b_Ns_per_m, "damping", {.range = kNotNegative}),
    field("k_Nm_per_rad", &CouplingWishes::k_Nm_per_rad, "rotational stiffness", {.range = kNotNegative}),
    field("b_Nms_per_rad", &CouplingWishes::b_Nms_per_rad, "rotational damping", {.range = kNotNegative}),
    field("max_force_N", &CouplingWishes::max_force_N, "greatest force", {.range = kPositive}),
    field("max_torque_Nm", &CouplingWishes::max_torque_Nm, "greatest torque", {.range = kPositive}));
static_assert(coversAllMembers<CouplingWishes>(kCouplingFields));

/// `[fidelity]`: the settings themselves.
inline constexpr auto kFidelityFields = std::make_tuple(
    field("voxel", &Fidelity::voxel_m, "grid step of the voxmaps",
          {.quantity = Quantity::Length,
           .range = kPositive,
           .default_text = "the preset's; without a preset, `\"0.25mm\"`, or another value for parts and "
                           "fits below 2 mm and for large parts, see below"}),
    field("spacing", &Fidelity::spacing_m, "distance between the points of a pointshell",
          {.quantity = Quantity::Length,
           .range = kPositive,
           .default_text = "the preset's; without a preset, a quarter of the smallest moved part, between "
                           "two and four voxels, or two voxels with `penalty`"}),
    field("sides", &Fidelity::sides,
          "one: points of the moving part are tested against the field of the fixed parts; both: points of "
          "the fixed parts are tested as well"),
    field("gradient", &Fidelity::gradient, "how the field's gradient is interpolated"),
    field("contact_limit", &Fidelity::contact_limit,
          "greatest number of contacts of each pair of parts that the solver receives; checks of solved "
          "steps may add up to 16",
          {.range = {.min = 4, .max = kCount.max}}),
    field("haptic_rate_hz", &Fidelity::haptic_rate_hz, "rate of the haptic loop", {.range = kRate_Hz}),
    field("physics_rate_hz", &Fidelity::physics_rate_hz, "rate of the physics steps", {.range = kRate_Hz}),
    field("substeps", &Fidelity::substeps,
          "number of equal substeps of each physics step; `\"auto\"`: as many as the fastest rotation needs, "
          "see below",
          {.range = {.min = 0, .max = 1e4}, .since = 8, .type = "number or `\"auto\"`", .zero_word = "auto"}),
    field("solver_iterations", &Fidelity::solver_iterations, "iterations of the contact solver in a step",
          {.range = kCount}),
    field(
        "contact", &Fidelity::contact_method,
        "constraint: rigid contacts with a friction cone; penalty: each touching point pushes with stiffness "
        "times area times depth",
        {.since = 2}));
static_assert(coversAllMembers<Fidelity>(kFidelityFields));

/// `[fidelity]`: the bounds for `auto = true`. The bounds are not archived, since a recording holds the
/// values that were chosen.
inline constexpr auto kFidelityWishFields = std::make_tuple(
    field(
        "tolerance", &FidelityWish::tolerance_m,
        "greatest error of depth at 95 of 100 points of every surface",
        {.quantity = Quantity::Length, .range = kPositive, .default_text = "`\"10um\"` if no bound is set"}),
    field("budget_hz", &FidelityWish::budget_hz,
          "least number of physics steps that the machine must compute per second",
          {.range = kRate_Hz, .default_text = "no limit"}),
    field("memory_MB", &FidelityWish::memory_bytes, "greatest memory of all models",
          {.quantity = Quantity::Megabytes, .range = kPositive, .default_text = "no limit"}));
static_assert(coversAllMembers<FidelityWish, 1>(kFidelityWishFields));

/// `[fidelity]`: keys that choose the values of other keys.
inline constexpr auto kFidelityChoiceKeys =
    std::make_tuple(Key{"preset", "`\"fast\"`, `\"normal\"`, `\"fine\"`", "`\"normal\"`",
                        "preset that sets the keys that the table does not have"},
                    Key{"auto", "bool", "false",
                        "the program chooses `voxel` and `spacing`, see [FIDELITY.md](../FIDELITY.md)"});

/// All keys of `[fidelity]`.
inline constexpr auto kFidelityKeys =
    std::tuple_cat(kFidelityChoiceKeys, kFidelityWishFields, kFidelityFields);

/// `[record]`
inline constexpr auto kRecordFields = std::make_tuple(
    field("csv_rate_hz", &RecordSettings::csv_rate_hz,
          "rows per second of trace.csv and of the trace in a recording; above the physics rate: each step",
          {.range = kPositive}));
static_assert(coversAllMembers<RecordSettings>(kRecordFields));

}  // namespace vps::scenes
