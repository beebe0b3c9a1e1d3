// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a check as JSON and CSV show them.
#pragma once

#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

inline constexpr auto kCheckedPairFields = std::make_tuple(
    field("a", &CheckedPair::a, "name of the pair's first part"),
    field("b", &CheckedPair::b, "name of the pair's second part"),
    field("state", &CheckedPair::state,
          "`apart`, `contact` (within the error), `press fit` (a declared overlap) or `clash` (an "
          "overlap that is not declared)"),
    field("clearance_m", &CheckedPair::clearance_m,
          "least distance of the surfaces; 0 where the meshes overlap"),
    field(
        "interference_depth_m", &CheckedPair::interference_depth_m,
        "greatest depth of a point of one part's surface below the other part's surface, or diameter of the "
        "greatest ball inside both parts, whichever is greater"),
    field("interference_volume_m3", &CheckedPair::interference_volume_m3, "shared volume of a clash"),
    field("volume_error_m3", &CheckedPair::volume_error_m3, "bound of the error of `interference_volume_m3`"),
    field("error_m", &CheckedPair::error_m,
          "bound of the error of clearance and depth: chords of the meshes, rounding, search"),
    field("at_m", &CheckedPair::at_W, "the deepest point, or the middle of the nearest points, in the world"),
    field("is_allowed", &CheckedPair::is_allowed, "the scene allows the overlap (`allow_overlap`)"),
    field("is_uncertain", &CheckedPair::is_uncertain,
          "the check cannot decide whether the parts overlap, because one of them has a surface that "
          "encloses no volume (`no_inside`)"),
    field("press_fit_m", &CheckedPair::press_fit_m, "declared interference (`press_fit`); 0: none"));
static_assert(coversAllMembers<CheckedPair>(kCheckedPairFields));

inline constexpr auto kPressFields = std::make_tuple(
    field("hub_m", &CheckedPress::hub_m, "outer diameter of the largest ring of material around the bore"),
    field("hole_m", &CheckedPress::hole_m, "diameter of the shaft's hole; 0: no hole"),
    field("pressure_Pa", &CheckedPress::pressure_Pa, "pressure in the joint, for the interference as drawn"),
    field("hub_stress_Pa", &CheckedPress::hub_stress_Pa, "greatest equivalent stress in the hub (Tresca)"),
    field("force_N", &CheckedPress::force_N,
          "force that presses the shaft into the bore along the fit's whole length, or out of the bore"),
    field("declared_force_N", &CheckedPress::declared_force_N,
          "force that presses the shaft into the bore, for the declared interference"),
    field("shaft_modulus_Pa", &CheckedPress::shaft_modulus_Pa,
          "Young's modulus of the shaft, from the scene or assumed"),
    field("hub_modulus_Pa", &CheckedPress::hub_modulus_Pa,
          "Young's modulus of the hub, from the scene or assumed"),
    field("friction", &CheckedPress::friction,
          "coefficient of friction in the joint, from the scene or assumed"));
static_assert(coversAllMembers<CheckedPress>(kPressFields));

inline constexpr auto kCheckedFitFields = std::make_tuple(
    field("kind", &CheckedFit::kind,
          "`shaft` in a bore, `key` (two parallel faces between two others) or `thread`"),
    field("shaft", &CheckedFit::shaft, "name of the inner part"),
    field("bore", &CheckedFit::bore, "name of the outer part"),
    field("axis", &CheckedFit::axis_W, "axis of the cylinders, or normal of the key's faces, in the world"),
    field("at_m", &CheckedFit::at_W, "the middle of the fit, in the world"),
    field("shaft_m", &CheckedFit::shaft_m,
          "diameter of the shaft, major diameter of the screw, or width of the key"),
    field("bore_m", &CheckedFit::bore_m,
          "diameter of the bore, major diameter of the nut, or width of the slot"),
    field("along", &CheckedFit::along_W, "direction of the fit's length, in the world"),
    field("length_m", &CheckedFit::length_m, "length of the fit"),
    field("diametral_clearance_m", &CheckedFit::diametral_clearance_m,
          "bore minus shaft; negative: interference"),
    field("offset_m", &CheckedFit::offset_m, "greatest distance of the axes of shaft and bore"),
    field("error_m", &CheckedFit::error_m,
          "bound of the clearance's error, from the corners' distance to the faces"),
    field("iso_286", &CheckedFit::iso_286,
          "common fit of ISO 286 whose zones contain both sizes; empty: none"),
    field("lead_m", &CheckedFit::lead_m,
          "lead of a thread, the axial advance in one turn; negative: left-hand"),
    field("starts", &CheckedFit::starts, "number of starts of a thread"),
    field("thread", &CheckedFit::thread, "name of a thread in ISO 262, as M16 or M16x1.5-LH; empty: none"),
    group("press", &CheckedFit::press, kPressFields));
static_assert(coversAllMembers<CheckedFit>(kCheckedFitFields));

inline constexpr auto kPlayFields = std::make_tuple(
    field(
        "play_m", [](const Play& play) { return std::vector<double>(play.m.begin(), play.m.end()); },
        "how far the part can move along +x, -x, +y, -y, +z, -z of `play_axes`; null: nothing stops the "
        "part"),
    field(
        "play_rad", [](const Play& play) { return std::vector<double>(play.rad.begin(), play.rad.end()); },
        "how far the part can turn about the axes of `play_axes` through `play_center_m`; null: a whole "
        "turn"),
    field(
        "play_errors_m",
        [](const Play& play) { return std::vector<double>(play.error_m.begin(), play.error_m.end()); },
        "errors of `play_m` at the contact that stops the part first; another contact may stop it still "
        "earlier. At a shallow contact, as in a taper, the errors exceed `play_error_m`; null: no bound, the "
        "part may move farther"),
    field(
        "play_errors_rad",
        [](const Play& play) { return std::vector<double>(play.error_rad.begin(), play.error_rad.end()); },
        "errors of `play_rad`, with the meaning of `play_errors_m`; null: no bound, the part may turn "
        "farther"));

inline constexpr auto kCheckedPartFields = std::make_tuple(
    field("name", &CheckedPart::name, "name of the part"),
    field("triangles", &CheckedPart::triangles, "number of triangles of the part's mesh"),
    field("chord_error_m", &CheckedPart::chord_error_m,
          "greatest distance of the mesh from the part's curved faces"),
    field("mesh_faults", &CheckedPart::mesh_faults, "faults of the mesh in words; empty: the mesh is closed"),
    field("no_inside", &CheckedPart::no_inside,
          "why the surface, or a part of it, encloses no volume; empty: the surface bounds a solid"),
    group("", &CheckedPart::play, kPlayFields),
    field("play_error_m", &CheckedPart::play_error_m,
          "bound of the error of `play_m` at contacts that are at right angles to the motion"),
    field("play_error_rad", &CheckedPart::play_error_rad,
          "bound of the error of `play_rad` at contacts that are at right angles to the motion"),
    field("play_certain", &CheckedPart::is_play_certain,
          "false: facets cross as drawn, curved faces of equal size touch, or the search ended early; the "
          "meshes can then stop a motion that the true faces allow"),
    field("play_center_m", &CheckedPart::play_center_W,
          "point where the axes of rotation meet, in the world"));

inline constexpr auto kMovedPartFields = std::make_tuple(
    field("name", &MovedPart::name, "name of the part"),
    field("by_m", &MovedPart::by_W, "displacement of the middle of the part's box, in the world"),
    field("turn_rad", &MovedPart::turn_W, "rotation vector about the middle of the part's box"),
    field("most_m", &MovedPart::most_m, "greatest displacement of a corner of the part's box"),
    field("allowed_m", &MovedPart::allowed_m,
          "limit of `most_m`: tolerance of the part's tightest fit, or 0.5 mm (placement by eye) without a "
          "fit"),
    field(
        "position_m",
        [](const MovedPart& part) {
          return std::vector<double>{part.X_WP.p.x(), part.X_WP.p.y(), part.X_WP.p.z()};
        },
        "position of the part's origin after the motion, in the world"),
    field(
        "rotation_xyzw",
        [](const MovedPart& part) {
          const Quat q = part.X_WP.quaternion();
          return std::vector<double>{q.x(), q.y(), q.z(), q.w()};
        },
        "rotation of the part after the motion, as a unit quaternion"));

inline constexpr auto kCheckedPlacesFields = std::make_tuple(
    field("verdict", &CheckedPlaces::verdict,
          "`fits`: no parts overlap as drawn, or after the parts of `moved` are moved; `blocked`: it is "
          "proven that no places without overlap exist; `not_shown`: neither places without overlap nor a "
          "proof were found"),
    field("reason", &CheckedPlaces::reason, "reason for a verdict other than `fits`, in words"));

inline constexpr auto kCheckWallFields = std::make_tuple(
    field("prepare_s", &CheckResult::prepare_wall_s, "time to prepare the parts"),
    field("pairs_s", &CheckResult::pairs_wall_s, "time to measure overlap and clearance of the pairs"),
    field("fits_s", &CheckResult::fits_wall_s, "time to find and judge the fits"),
    field("pictures_s", &CheckResult::pictures_wall_s, "time to make sections and clearance maps"),
    field("play_s", &CheckResult::play_wall_s, "time to measure play and removal directions"),
    field("places_s", &CheckResult::places_wall_s, "time of the search for places without overlap"));

}  // namespace vps::scenes
