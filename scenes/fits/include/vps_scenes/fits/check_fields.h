// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a check: their keys in JSON, their lines in CSV, and their columns on the terminal and on
// the page.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/fits/rules.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

/// Whether the parts overlap by more than contact allows.
inline bool isOverlapping(const CheckedPair& pair) {
  return pair.state >= PairState::PressFit;
}

inline constexpr auto kCheckedPairFields = std::make_tuple(
    shown<CheckedPair>(field("a", &CheckedPair::a, "name of the pair's first part"),
                       {.column = {.heading = "<part"}}),
    shown<CheckedPair>(field("b", &CheckedPair::b, "name of the pair's second part"),
                       {.column = {.heading = "<and"}}),
    shown<CheckedPair>(
        field("state", &CheckedPair::state,
              "`apart`, `contact` (within the error, or nearer than 5 nm), `press fit` (a declared overlap), "
              "`thread`, `seal` or "
              "`insert` (an overlap that is declared or recognised as such, see `explanation`), or `clash` "
              "(any other overlap)"),
        {.column = {.heading = "<state",
                    .text = stateWords,
                    .is_bad = [](const CheckedPair& pair) { return pair.isClash(); }}}),
    shown<CheckedPair>(field("clearance_m", &CheckedPair::clearance_m,
                             "least distance of the surfaces; 0 where the meshes overlap"),
                       {.column = {.heading = "clearance [um]",
                                   .per_SI = 1e6,
                                   .is_shown = [](const CheckedPair& pair) { return !isOverlapping(pair); }},
                        .csv_place = 1,
                        .error = "error_m"}),
    shown<CheckedPair>(
        field("interference_depth_m", &CheckedPair::interference_depth_m,
              "greatest depth of a point of one part's surface below the other part's surface, or diameter "
              "of the greatest ball inside both parts, whichever is greater"),
        {.column = {.heading = "overlap [um]",
                    .per_SI = 1e6,
                    .is_shown = [](const CheckedPair& pair) { return pair.interference_depth_m > 0; }},
         .csv_place = 1,
         .error = "error_m"}),
    shown<CheckedPair>(
        field("interference_volume_m3", &CheckedPair::interference_volume_m3, "shared volume of a clash"),
        {.column = {.heading = "volume [mm3]", .is_shown = isOverlapping, .text = volumeWords},
         .csv_place = 1,
         .error = "volume_error_m3"}),
    field("volume_error_m3", &CheckedPair::volume_error_m3, "bound of the error of `interference_volume_m3`"),
    shown<CheckedPair>(field("error_m", &CheckedPair::error_m,
                             "bound of the error of clearance and depth: chords of the meshes, rounding, "
                             "search"),
                       {.column = {.heading = "error [um]", .per_SI = 1e6}}),
    shown<CheckedPair>(field("at_m", &CheckedPair::at_W,
                             "the deepest point, or the middle of the nearest points, in the world"),
                       {.column = {.heading = "at [mm]", .per_SI = 1e3}}),
    field("is_allowed", &CheckedPair::is_allowed, "the scene allows the overlap (`allow_overlap`)"),
    field("is_uncertain", &CheckedPair::is_uncertain,
          "the check cannot decide whether the parts overlap, because one of them has a surface that "
          "encloses no volume (`no_inside`)"),
    field("press_fit_m", &CheckedPair::press_fit_m, "declared interference (`press_fit`); 0: none"),
    field(
        "explanation", &CheckedPair::explanation,
        "what was assumed about a thread, a seal or an insert; of a clash, why it is none; empty: nothing is "
        "known"),
    field("fastener", &CheckedPair::fastener,
          "the screw, seal or insert of a thread, seal or insert; empty for other pairs"),
    field("nominal", &CheckedPair::nominal, "nominal size of a thread, as M8; empty: none"),
    field("squash", &CheckedPair::squash,
          "greatest squash of a seal, divided by the width of its section; 0: no seal"));
static_assert(coversAllMembers<CheckedPair>(kCheckedPairFields));

inline constexpr auto kPressFields = std::make_tuple(
    field("hub_m", &CheckedPress::hub_m, "outer diameter of the largest ring of material around the bore"),
    field("hole_m", &CheckedPress::hole_m, "diameter of the shaft's hole; 0: no hole"),
    shown<CheckedPress>(field("pressure_Pa", &CheckedPress::pressure_Pa,
                              "pressure in the joint, for the interference as drawn"),
                        {.csv_place = 2}),
    field("hub_stress_Pa", &CheckedPress::hub_stress_Pa, "greatest equivalent stress in the hub (Tresca)"),
    shown<CheckedPress>(
        field("force_N", &CheckedPress::force_N,
              "force that presses the shaft into the bore along the fit's whole length, or out of the bore"),
        {.csv_place = 2}),
    shown<CheckedPress>(field("declared_force_N", &CheckedPress::declared_force_N,
                              "force that presses the shaft into the bore, for the declared interference"),
                        {.csv_place = 2}),
    field("shaft_modulus_Pa", &CheckedPress::shaft_modulus_Pa,
          "Young's modulus of the shaft, from the scene or assumed"),
    field("hub_modulus_Pa", &CheckedPress::hub_modulus_Pa,
          "Young's modulus of the hub, from the scene or assumed"),
    field("friction", &CheckedPress::friction,
          "coefficient of friction in the joint, from the scene or assumed"));
static_assert(coversAllMembers<CheckedPress>(kPressFields));

/// The fit's kind by the shape of its faces.
inline std::string kindInWords(const CheckedFit& fit) {
  if (fit.kind == FitKind::Thread) return "thread";
  return fit.kind == FitKind::Shaft ? "round" : "two parallel faces";
}

inline constexpr auto kCheckedFitFields = std::make_tuple(
    shown<CheckedFit>(
        field("kind", &CheckedFit::kind,
              "`shaft` in a bore, `key` (two parallel faces between two others) or `thread`"),
        {.column = {.heading = "<fit"}, .page_column = {.heading = "<kind", .text = kindInWords}}),
    shown<CheckedFit>(field("shaft", &CheckedFit::shaft, "name of the inner part"),
                      {.column = {.heading = "<of"}, .page_column = {.heading = "<inner part"}}),
    shown<CheckedFit>(field("bore", &CheckedFit::bore, "name of the outer part"),
                      {.column = {.heading = "<in"}, .page_column = {.heading = "<outer part"}}),
    field("axis", &CheckedFit::axis_W, "axis of the cylinders, or normal of the key's faces, in the world"),
    field("at_m", &CheckedFit::at_W, "the middle of the fit, in the world"),
    shown<CheckedFit>(field("shaft_m", &CheckedFit::shaft_m,
                            "diameter of the shaft, major diameter of the screw, or width of the key"),
                      {.column = {.heading = "size [mm]", .per_SI = 1e3, .digits = 3},
                       .page_column = {.heading = "inner [mm]", .per_SI = 1e3, .digits = 4},
                       .csv_place = 3,
                       .error = "error_m"}),
    shown<CheckedFit>(field("bore_m", &CheckedFit::bore_m,
                            "diameter of the bore, major diameter of the nut, or width of the slot"),
                      {.page_column = {.heading = "outer [mm]", .per_SI = 1e3, .digits = 4},
                       .csv_place = 3,
                       .error = "error_m"}),
    field("along", &CheckedFit::along_W, "direction of the fit's length, in the world"),
    shown<CheckedFit>(field("length_m", &CheckedFit::length_m, "length of the fit"),
                      {.column = {.heading = "length [mm]", .per_SI = 1e3, .place = 1}}),
    shown<CheckedFit>(
        field("diametral_clearance_m", &CheckedFit::diametral_clearance_m,
              "bore minus shaft; negative: interference"),
        {.column = {.heading = "clearance [um]",
                    .per_SI = 1e6,
                    .is_bad = [](const CheckedFit& fit) { return fit.diametral_clearance_m < 0; }},
         .csv_place = 1,
         .error = "error_m"}),
    shown<CheckedFit>(
        field("offset_m", &CheckedFit::offset_m, "greatest distance of the axes of shaft and bore"),
        {.column = {.heading = "axes apart [um]",
                    .per_SI = 1e6,
                    .is_shown = [](const CheckedFit& fit) { return fit.kind != FitKind::Key; },
                    .is_bad = [](const CheckedFit& fit) { return fit.isEccentric(); }}}),
    shown<CheckedFit>(field("error_m", &CheckedFit::error_m,
                            "bound of the clearance's error, from the corners' distance to the faces"),
                      {.column = {.heading = "error [um]", .per_SI = 1e6}}),
    shown<CheckedFit>(field("iso_286", &CheckedFit::iso_286,
                            "common fit of ISO 286 whose zones contain both sizes; empty: none"),
                      {.column = {.heading = "<standard", .place = 1, .text = standardOf}}),
    field("lead_m", &CheckedFit::lead_m,
          "lead of a thread, the axial advance in one turn; negative: left-hand"),
    field("starts", &CheckedFit::starts, "number of starts of a thread"),
    field("thread", &CheckedFit::thread, "name of a thread in ISO 262, as M16 or M16x1.5-LH; empty: none"),
    group("press", &CheckedFit::press, kPressFields));
static_assert(coversAllMembers<CheckedFit>(kCheckedFitFields));

/// The directions of Play::m and Play::rad, in their order.
inline constexpr std::array<std::string_view, 6> kPlayDirections = {"+x", "-x", "+y", "-y", "+z", "-z"};

inline constexpr auto kPlayFields = std::make_tuple(
    shown<Play>(
        field(
            "play_m", [](const Play& play) { return std::vector<double>(play.m.begin(), play.m.end()); },
            "how far the part can move along +x, -x, +y, -y, +z, -z of `play_axes`; null: nothing stops the "
            "part"),
        {.csv_place = 1, .error = "play_errors_m", .elements = kPlayDirections}),
    shown<Play>(
        field(
            "play_rad",
            [](const Play& play) { return std::vector<double>(play.rad.begin(), play.rad.end()); },
            "how far the part can turn about the axes of `play_axes` through `play_center_m`; null: a whole "
            "turn"),
        {.csv_place = 1, .error = "play_errors_rad", .elements = kPlayDirections}),
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
    field(
        "read_as", &CheckedPart::read_as,
        "how faces of 7 to 24 flat sides, whose corners lie on a circle, were read: as prism or as cylinder; "
        "empty: there are none"),
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
    field(
        "allowed_m", &MovedPart::allowed_m,
        "limit of `most_m`: 0.5 mm (placement by eye); across its fits, a part may move by their tolerance"),
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

inline constexpr auto kCheckedGroupFields = std::make_tuple(
    field("parts", &CheckedGroup::parts, "parts that overlaps, as drawn, connect with each other"),
    field("verdict", &CheckedGroup::verdict, "as `places.verdict`, for the parts of this group"),
    field("reason", &CheckedGroup::reason, "reason for a verdict other than `fits`, in words"));

inline constexpr auto kCheckedPlacesFields = std::make_tuple(
    field("verdict", &CheckedPlaces::verdict,
          "`fits`: no parts overlap as drawn, or after the parts of `moved` are moved; `blocked`: it is "
          "proven that no places without overlap exist within 0.5 mm of the drawn ones (places farther away "
          "were not examined); `not_shown`: neither places without overlap nor a "
          "proof were found"),
    field("reason", &CheckedPlaces::reason, "reason for a verdict other than `fits`, in words"));

/// Whether a number was measured for the outcome.
inline bool isMeasured(const RuleOutcome& outcome) {
  return std::isfinite(outcome.value_m);
}

inline constexpr auto kRuleOutcomeFields = std::make_tuple(
    shown<RuleOutcome>(field("rule", &RuleOutcome::rule, "name of the rule; `--min-gap` for that option"),
                       {.column = {.heading = "<rule"}}),
    shown<RuleOutcome>(
        field("a", &RuleOutcome::a,
              "name of the pair's first part; the rule's text where no pair could be measured"),
        {.column = {.heading = "<part"}}),
    shown<RuleOutcome>(field("b", &RuleOutcome::b, "name of the pair's second part, as `a`"),
                       {.column = {.heading = "<and"}}),
    shown<RuleOutcome>(field("measure", &RuleOutcome::measure,
                             "the number that the rule bounds: `clearance`, `overlap` or `axis offset`"),
                       {.column = {.heading = "<measure"}}),
    shown<RuleOutcome>(
        field("value_m", &RuleOutcome::value_m,
              "the measured number; a clearance is negative by the depth of an overlap; null: not measured"),
        {.column = {.heading = "measured [um]", .per_SI = 1e6, .is_shown = isMeasured}}),
    shown<RuleOutcome>(field("error_m", &RuleOutcome::error_m, "bound of the error of `value_m`"),
                       {.column = {.heading = "error [um]", .per_SI = 1e6, .is_shown = isMeasured}}),
    shown<RuleOutcome>(
        field("bound_m", &RuleOutcome::bound_m, "least clearance, or greatest overlap or axis offset"),
        {.column = {.heading = "bound [um]", .per_SI = 1e6}}),
    shown<RuleOutcome>(field("margin_m", &RuleOutcome::margin_m,
                             "by how much the number is better than the bound; negative: worse"),
                       {.csv_place = 1, .error = "error_m"}),
    shown<RuleOutcome>(
        field("outcome", &RuleOutcome::state,
              "`kept`, `broken`, or `not decided`: the bound is within the error of the number, or `reason`"),
        {.column = {.heading = "<outcome",
                    .is_bad = [](const RuleOutcome& of) { return of.state == RuleState::Broken; }}}),
    field("reason", &RuleOutcome::reason, "why the rule is not decided, if not by the error; else empty"),
    field(
        "words", [](const RuleOutcome& of) { return inWords(of); }, "number, error and bound in words"));

inline constexpr auto kRuleCountFields = std::make_tuple(
    field("rule", &RuleCount::rule, "name of the rule"),
    field("kept", &RuleCount::kept,
          "number of outcomes in `rules`, one for each bound and pair, that are `kept`"),
    field("not_decided", &RuleCount::not_decided, "number of outcomes that are `not decided`"),
    field("broken", &RuleCount::broken, "number of outcomes that are `broken`"),
    field("apart", &RuleCount::apart,
          "number of pairs that keep the rule since they are farther apart than the check measures; they are "
          "not in `rules`"),
    field("left_out", &RuleCount::left_out,
          "number of pairs near each other that were left out of the check and not judged"));
static_assert(coversAllMembers<RuleCount>(kRuleCountFields));

inline constexpr auto kLeftOutPairFields =
    std::make_tuple(field("a", &LeftOutPair::a, "name of the first part of a pair that was not measured"),
                    field("b", &LeftOutPair::b, "name of the pair's second part"),
                    field("is_ignored", &LeftOutPair::is_ignored,
                          "true: `--ignore` leaves the pair out; false: `--between` does not name it"),
                    field("reason", &LeftOutPair::reason, "why the pair was left out, in words"));
static_assert(coversAllMembers<LeftOutPair>(kLeftOutPairFields));

inline constexpr auto kPartMoveFields = std::make_tuple(
    field("part", &PartMove::part, "name of a part that `--move` moved before the check"),
    field("axis", &PartMove::axis_W, "direction of the displacement, or axis of the rotation, in the world"),
    field("by_m", &PartMove::by_m, "displacement along `axis`"),
    field("turn_rad", &PartMove::turn_rad, "rotation about `axis` through the part's own origin"));
static_assert(coversAllMembers<PartMove>(kPartMoveFields));

inline constexpr auto kCheckWallFields = std::make_tuple(
    field("prepare_s", &CheckResult::prepare_wall_s, "time to prepare the parts"),
    field("pairs_s", &CheckResult::pairs_wall_s, "time to measure overlap and clearance of the pairs"),
    field("fits_s", &CheckResult::fits_wall_s, "time to find and judge the fits"),
    field("pictures_s", &CheckResult::pictures_wall_s, "time to make sections and clearance maps"),
    field("play_s", &CheckResult::play_wall_s, "time to measure play and removal directions"),
    field("places_s", &CheckResult::places_wall_s, "time of the search for places without overlap"));

}  // namespace vps::scenes
