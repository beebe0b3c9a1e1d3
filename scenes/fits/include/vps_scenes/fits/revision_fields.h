// SPDX-License-Identifier: BSD-3-Clause
// The differences of two revisions: their keys in JSON, and their columns on the terminal and on the page.
#pragma once

#include <string>

#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/fits/revisions.h"

namespace vps::scenes {

/// The differences of a part in words: "moved, shape", "renamed", "removed".
VPS_SCENES_API std::string changeWords(const PartChange& change);
/// The name in the new revision, and the old one if it differs: "bolt (was screw)".
VPS_SCENES_API std::string nameWords(const PartChange& change);
/// The motion: "0.1000 mm along +x", "(0.100, 0.200, 0.000) mm, turned by 0.50 deg about +z"; empty: not
/// moved.
VPS_SCENES_API std::string motionWords(const PartChange& change);
/// What a change of shape is: "volume 812.30 -> 809.11 mm3, surfaces up to 50.0 um apart"; empty: none.
VPS_SCENES_API std::string shapeWords(const PartChange& change);
/// Verdicts before and after: "fits -> blocked"; empty: the same, or the part is in one revision only.
VPS_SCENES_API std::string verdictWords(const PartChange& change);
/// "clash -> contact", or one state if both are equal.
VPS_SCENES_API std::string stateChangeWords(const PairChange& change);
/// A clearance, or an overlap as a negative number, in micrometres: "12.00 -> -5.00"; "-" where none was
/// measured.
VPS_SCENES_API std::string gapWords(const PairChange& change);
/// "H7/g6 -> H7/k6", "new: H7/g6", "gone: H7/g6"; sizes for a fit that is in no standard.
VPS_SCENES_API std::string standardWords(const FitChange& change);
/// Diameters or widths of shaft and bore in millimetres: "9.9900 -> 10.0020 in 10.0000".
VPS_SCENES_API std::string sizeWords(const FitChange& change);
/// Diametral clearances in micrometres: "10.00 -> -2.00".
VPS_SCENES_API std::string clearanceWords(const FitChange& change);
/// Play in micrometres or milliradians: "10.0 -> 12.5 um", "free -> 5.0 um".
VPS_SCENES_API std::string playChangeWords(const PlayChange& change);

inline constexpr auto kShapeMeasureFields =
    std::make_tuple(field("volume_m3", &ShapeMeasures::volume_m3,
                          "volume that the mesh encloses; without a meaning for a mesh that is not closed"),
                    field("area_m2", &ShapeMeasures::area_m2, "area of the surface"),
                    field("size_m", &ShapeMeasures::size_m, "size of the box along the part's own axes"));
static_assert(coversAllMembers<ShapeMeasures>(kShapeMeasureFields));

inline constexpr auto kPartChangeFields = std::make_tuple(
    shown<PartChange>(
        field("name", &PartChange::name, "name in the new revision; empty for a part that was removed"),
        {.column = {.heading = "<part", .text = nameWords}}),
    field("old_name", &PartChange::old_name, "name in the old revision; empty for a part that was added"),
    shown<PartChange>(field("is_added", &PartChange::is_added, "the part is in the new revision only"),
                      {.column = {.heading = "<change", .text = changeWords}}),
    field("is_removed", &PartChange::is_removed, "the part is in the old revision only"),
    field("is_moved", &PartChange::is_moved,
          "a corner of the part's box moved by more than the rounding of the files"),
    field("is_reshaped", &PartChange::is_reshaped,
          "the surfaces differ by more than the errors of both meshes"),
    field("is_renamed", &PartChange::is_renamed,
          "the part has another name, and not only another counter of equal parts (`bolt_2`)"),
    shown<PartChange>(field("by_m", &PartChange::by_W,
                            "displacement of the middle of the part's box, from the old to the new place"),
                      {.column = {.heading = "<moved by", .text = motionWords}}),
    field("turn_rad", &PartChange::turn_W, "rotation vector about the middle of the part's box"),
    field("most_m", &PartChange::most_m, "greatest displacement of a corner of the part's box"),
    group("old_shape", &PartChange::old_shape, kShapeMeasureFields),
    group("new_shape", &PartChange::new_shape, kShapeMeasureFields),
    shown<PartChange>(field("deviation_m", &PartChange::deviation_m,
                            "greatest distance of a point of one revision's surface from the surface of the "
                            "other one, after the motion"),
                      {.column = {.heading = "<shape", .text = shapeWords}}),
    field("deviation_error_m", &PartChange::deviation_error_m,
          "how much greater than `deviation_m` the distance may be"),
    shown<PartChange>(
        field("old_verdict", &PartChange::old_verdict,
              "answer for the part alone in the old revision: the worst of its groups in `places.groups`; "
              "`not_shown` for a part near no other one, or that does not exist"),
        {.column = {.heading = "<verdict", .text = verdictWords}}),
    field("new_verdict", &PartChange::new_verdict, "the same in the new revision"));
static_assert(coversAllMembers<PartChange>(kPartChangeFields));

inline constexpr auto kPairChangeFields = std::make_tuple(
    shown<PairChange>(field("a", &PairChange::a, "name of the pair's first part in the new revision"),
                      {.column = {.heading = "<part"}}),
    shown<PairChange>(field("b", &PairChange::b, "name of the pair's second part in the new revision"),
                      {.column = {.heading = "<and"}}),
    shown<PairChange>(field("old_state", &PairChange::old_state,
                            "state in the old revision; `not near`: farther apart than `--near`"),
                      {.column = {.heading = "<state", .text = stateChangeWords}}),
    field("new_state", &PairChange::new_state, "state in the new revision"),
    shown<PairChange>(
        field("old_gap_m", &PairChange::old_gap_m,
              "clearance in the old revision, or minus the depth of the overlap; null: not near"),
        {.column = {.heading = "clearance, or overlap < 0 [um]", .text = gapWords}}),
    field("new_gap_m", &PairChange::new_gap_m, "the same in the new revision"),
    shown<PairChange>(field("error_m", &PairChange::error_m, "sum of the errors of both"),
                      {.column = {.heading = "error [um]", .per_SI = 1e6}}));
static_assert(coversAllMembers<PairChange>(kPairChangeFields));

inline constexpr auto kFitChangeFields = std::make_tuple(
    shown<FitChange>(field("kind", &FitChange::kind, "`shaft`, `key` or `thread`"),
                     {.column = {.heading = "<fit"}}),
    shown<FitChange>(field("shaft", &FitChange::shaft, "name of the inner part in the new revision"),
                     {.column = {.heading = "<of"}}),
    shown<FitChange>(field("bore", &FitChange::bore, "name of the outer part in the new revision"),
                     {.column = {.heading = "<in"}}),
    field("is_added", &FitChange::is_added, "the fit is in the new revision only"),
    field("is_removed", &FitChange::is_removed, "the fit is in the old revision only"),
    shown<FitChange>(field("old_standard", &FitChange::old_standard,
                           "fit of ISO 286 or thread of ISO 262 in the old revision; empty: none"),
                     {.column = {.heading = "<standard", .text = standardWords}}),
    field("new_standard", &FitChange::new_standard, "the same in the new revision"),
    shown<FitChange>(field("old_shaft_m", &FitChange::old_shaft_m,
                           "diameter or width of the inner part in the old revision; 0: no fit"),
                     {.column = {.heading = "sizes [mm]", .text = sizeWords}}),
    field("new_shaft_m", &FitChange::new_shaft_m, "the same in the new revision"),
    field("old_bore_m", &FitChange::old_bore_m,
          "diameter or width of the outer part in the old revision; 0: no fit"),
    field("new_bore_m", &FitChange::new_bore_m, "the same in the new revision"),
    shown<FitChange>(field("old_clearance_m", &FitChange::old_clearance_m,
                           "outer minus inner size in the old revision; negative: interference"),
                     {.column = {.heading = "clearance [um]",
                                 .text = clearanceWords,
                                 .is_bad = [](const FitChange& c) { return c.new_clearance_m < 0; }}}),
    field("new_clearance_m", &FitChange::new_clearance_m, "the same in the new revision"),
    shown<FitChange>(field("error_m", &FitChange::error_m, "sum of the errors of both clearances"),
                     {.column = {.heading = "error [um]", .per_SI = 1e6}}));
static_assert(coversAllMembers<FitChange>(kFitChangeFields));

inline constexpr auto kPlayChangeFields = std::make_tuple(
    shown<PlayChange>(field("part", &PlayChange::part, "name of the part in the new revision"),
                      {.column = {.heading = "<part"}}),
    shown<PlayChange>(
        field("direction", &PlayChange::direction,
              "direction along the axes of `play_axes`, or `about +x` and so on for a rotation"),
        {.column = {.heading = "<direction"}}),
    field("is_turn", &PlayChange::is_turn, "the play is in radians, else in metres"),
    shown<PlayChange>(field("old_play", &PlayChange::old_play,
                            "play in the old revision; null: nothing stops the part, or it turns wholly"),
                      {.column = {.heading = "<play", .text = playChangeWords}}),
    field("new_play", &PlayChange::new_play, "the same in the new revision"),
    field("error", &PlayChange::error, "sum of the errors of both"));
static_assert(coversAllMembers<PlayChange>(kPlayChangeFields));

inline constexpr auto kRevisionFields = std::make_tuple(
    field("old_assembly", &RevisionChanges::old_assembly, "name of the old revision, the first argument"),
    field("new_assembly", &RevisionChanges::new_assembly, "name of the new revision, that of `--against`"),
    field("old_verdict", &RevisionChanges::old_verdict, "`verdict` of the old revision"),
    field("new_verdict", &RevisionChanges::new_verdict, "`verdict` of the new revision"),
    field("is_same", &RevisionChanges::isSame, "no part, clearance, fit, play or verdict differs"),
    list("parts", &RevisionChanges::parts, kPartChangeFields),
    list("pairs", &RevisionChanges::pairs, kPairChangeFields),
    list("fits", &RevisionChanges::fits, kFitChangeFields),
    list("play", &RevisionChanges::play, kPlayChangeFields));

}  // namespace vps::scenes
