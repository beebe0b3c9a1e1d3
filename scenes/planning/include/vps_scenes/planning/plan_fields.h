// SPDX-License-Identifier: BSD-3-Clause
// Field tables of a plan, for JSON.
#pragma once

#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

inline constexpr auto kPlannedPoseFields = std::make_tuple(
    field("position_m", &Pose::p,
          "translation of the world motion that brings the part from its target to this pose"),
    field("rotation_xyzw", &Pose::quaternion,
          "rotation of the world motion that brings the part from its target to this pose"));

inline constexpr auto kPlannedStepFields = std::make_tuple(
    field("name", &PlannedStep::name,
          "name of the part, or of the subassembly, which has a scene of its own"),
    field("parts", &PlannedStep::parts, "the part, or the parts of the subassembly"),
    field("way", &PlannedStep::kind, "`straight`, `screw`, or `legs`: several straight or turning legs"),
    list("before", &PlannedStep::before_W, kPlannedPoseFields),
    field("insertion", &PlannedStep::insertion_W,
          "unit direction of the last leg, in the world; 0 for a turn"),
    field("lead_m", &PlannedStep::lead_m, "lead of a screw: its travel in one turn; negative: left-hand"),
    field("allowance_m", &PlannedStep::allowance_m,
          "depth beyond the drawn overlap that facets need to pass each other on the path; no path without "
          "this depth was found; 0: the path needs no such depth"),
    field("is_carried", &PlannedStep::is_carried,
          "a part in place keeps the step's part from falling at its target; false: the scene's step has "
          "`holds`"),
    field("falling", &PlannedStep::falling,
          "parts in place that nothing else carries until this step is done"),
    field("is_on_bench", &PlannedStep::is_on_bench,
          "the step starts on the bench around the base (`--bench`)"),
    field("clearance_m", &PlannedStep::clearance_m,
          "least clearance on the path to parts that it neither touches nor fits at its target; null: more "
          "than 5 mm"),
    field("nearest", &PlannedStep::nearest, "the part nearest to the path, at `clearance_m`"),
    field("fit_clearance_m", &PlannedStep::fit_clearance_m,
          "diametral clearance of the step's tightest fit with parts in place; null: the part has no such "
          "fit"));
static_assert(coversAllMembers<PlannedStep>(kPlannedStepFields));

inline constexpr auto kPlannedOrderFields = std::make_tuple(
    field("before", &PlannedOrder::before, "the step that has to come first"),
    field("after", &PlannedOrder::after, "the step that has to come later"),
    field(
        "reason", &PlannedOrder::reason,
        "`way`: no path is left for `before` once `after` is in place; `carries`: `before` carries `after`"));
static_assert(coversAllMembers<PlannedOrder>(kPlannedOrderFields));

inline constexpr auto kNotFoundFields =
    std::make_tuple(field("name", &BlockedPart::name,
                          "a part for which no path was found; nothing proves that there is none"),
                    field("by", &BlockedPart::by, "parts that stop `name` in the directions that were tried"),
                    field("is_searched", &BlockedPart::is_searched,
                          "false: the search for paths of several legs ended at its work limit"));
inline constexpr auto kBlockedPartFields = std::make_tuple(
    field("name", &BlockedPart::name, "a part that is proven to have no path"),
    field("by", &BlockedPart::by, "parts that stop `name` in the directions that were tried"),
    field("is_searched", &BlockedPart::is_searched,
          "false: the search for paths of several legs ended at its work limit"),
    field("enclosed_by", &BlockedPart::enclosed_by,
          "a part that `name`, as a rigid body, is proven to be unable to leave on any path"),
    field("moves_m", &BlockedPart::moves_m,
          "with `enclosed_by`: upper bound of how far the middle of the moved part can move"),
    field("turns_rad", &BlockedPart::turns_rad,
          "with `enclosed_by`: upper bound of how far the part can turn about each axis, but about "
          "that of a round part"));
static_assert(coversAllMembers<BlockedPart>(kBlockedPartFields));

inline constexpr auto kPlannedAssemblyFields = std::make_tuple(
    field("name", &PlannedAssembly::name, "name of the assembly or subassembly"),
    field("fixed", &PlannedAssembly::fixed,
          "parts with which the assembly begins, including those of `blocked` and `not_found`"),
    field("fixed_reason", &PlannedAssembly::fixed_reason,
          "why the assembly begins with the first of `fixed`, in words"),
    list("steps", &PlannedAssembly::steps, kPlannedStepFields),
    list("order", &PlannedAssembly::order, kPlannedOrderFields),
    list(
        "blocked", [](const PlannedAssembly& one) { return one.withoutPath(true); }, kBlockedPartFields),
    list(
        "not_found", [](const PlannedAssembly& one) { return one.withoutPath(false); }, kNotFoundFields));

inline constexpr auto kDrawnTwiceFields =
    std::make_tuple(field("first", &DrawnTwice::first, "a part"),
                    field("second", &DrawnTwice::second, "a part of equal geometry in the same place"));
static_assert(coversAllMembers<DrawnTwice>(kDrawnTwiceFields));

inline constexpr auto kFastenerFields = std::make_tuple(
    field("part", &Fastener::part, "a part with the shape of a fastener"),
    field("kind", &Fastener::kind, "`screw`, `stud`, `nut`, `washer`, `pin`, `key`, `circlip`, `headed pin`"),
    field("words", &Fastener::words, "the fastener in words, with its sizes"));
static_assert(coversAllMembers<Fastener>(kFastenerFields));

inline constexpr auto kOverlapChoiceFields = std::make_tuple(
    field("a", &OverlapChoice::a, "a part"),
    field("b", &OverlapChoice::b,
          "a part that overlaps `a` as drawn, or leaves it no clearance; empty for `no volume`"),
    field(
        "kind", &OverlapChoice::kind,
        "classification of the overlap: `thread` (as in `check`), `insert`, `press fit`, `twice` (drawn "
        "twice), "
        "`flexible` (a spring, belt or seal drawn undeformed), `line to line` (a shaft as wide as its hole), "
        "`no volume` (a surface without a body), or `clash`: nothing explains it"),
    field("words", &OverlapChoice::words,
          "the classification in words, with the change made to the planned scene"),
    field("left_out", &OverlapChoice::left_out, "a part that is scenery in the planned scene; empty: none"),
    field("changed", &OverlapChoice::changed,
          "a part that has another mesh or a `press_fit` in the planned scene; empty: none"),
    field("press_fit_m", &OverlapChoice::press_fit_m, "press fit that the changed part gets; 0: none"));

inline constexpr auto kPlannedContactFields = std::make_tuple(
    field("a", &PlannedContact::a, "a part"), field("b", &PlannedContact::b, "a part near `a`"),
    field("state", &PlannedContact::state, "state of the pair, as `vps check` reports it"),
    field("clearance_m", &PlannedContact::clearance_m, "least distance of the surfaces of `a` and `b`"),
    field("fits", &PlannedContact::fits,
          "kinds of the fits between `a` and `b`, with the name in a standard"),
    field("blocked", &PlannedContact::blocked_W,
          "unit directions in which `b` stops `a`, out of the axes of the world, of `a` and of the fits of "
          "`a`"),
    field("free", &PlannedContact::free_W,
          "directions out of the axes named at `blocked` in which `b` does not stop `a`"));
static_assert(coversAllMembers<PlannedContact>(kPlannedContactFields));

inline constexpr auto kEqualPartsFields =
    std::make_tuple(field("names", &EqualParts::names, "parts of equal geometry"));
static_assert(coversAllMembers<EqualParts>(kEqualPartsFields));

inline constexpr auto kPlanFields = std::make_tuple(
    field("assembly", &PlanResult::assembly, "name of the planned assembly"),
    list("fasteners", &PlanResult::fasteners, kFastenerFields),
    list("choices", &PlanResult::choices, kOverlapChoiceFields),
    field("blocked_count", &PlanResult::enclosed, "number of parts that are proven to have no path"),
    field(
        "not_found_count", [](const PlanResult& plan) { return plan.blocked() - plan.enclosed(); },
        "number of parts for which no path was found, without a proof that there is none"),
    list("assemblies", &PlanResult::assemblies, kPlannedAssemblyFields),
    list("contacts", &PlanResult::contacts, kPlannedContactFields),
    list("equal", &PlanResult::equal, kEqualPartsFields),
    list("overlaps", &PlanResult::overlaps, kCheckedPairFields),
    list("twice", &PlanResult::twice, kDrawnTwiceFields),
    list("uncertain", &PlanResult::uncertain, kCheckedPairFields),
    field("cut_motions", &PlanResult::cut_motions,
          "number of straight motions that count as stopped because they were too long to "
          "follow to their end"));
inline constexpr auto kPlanWallFields =
    std::make_tuple(field("check_s", &PlanResult::check_wall_s, "time to check the parts as drawn"),
                    field("plan_s", &PlanResult::plan_wall_s, "time to plan the disassembly"));

inline constexpr auto kWayFaultFields = std::make_tuple(
    field(
        "kind", &WayFault::kind,
        "`through` (overlaps a part in place), `order` (the part in place has to come later), `support` (no "
        "part carries the moved part when the hand lets go), `clearance` (less clearance than planned)"),
    field("part", &WayFault::part, "the part that moves"),
    field("against", &WayFault::against, "the part in place that the path overlaps"),
    field("depth_m", &WayFault::depth_m, "greatest depth on the path"),
    field("allowed_m", &WayFault::allowed_m,
          "allowed depth: the depth at the target, plus 10 um; a depth is a fault if it is greater by more "
          "than "
          "0.2 um, the error of both measurements"),
    field("at_m", &WayFault::at_W, "position of the greatest depth, in the world"),
    field("clearance_m", &WayFault::clearance_m, "for a `clearance` fault: least distance on the path"),
    field("planned_m", &WayFault::planned_m, "for a `clearance` fault: planned least distance"),
    field(
        "error_m", &WayFault::error_m,
        "bound of the error of `depth_m`: the distance of both meshes from their true faces; null: unknown"));
static_assert(coversAllMembers<WayFault>(kWayFaultFields));

}  // namespace vps::scenes
