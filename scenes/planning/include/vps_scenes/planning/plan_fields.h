// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a plan as JSON shows them.
#pragma once

#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

inline constexpr auto kPlannedPoseFields = std::make_tuple(
    field("position_m", &Pose::p, "of the motion of the world that brings the part there from its target"),
    field("rotation_xyzw", &Pose::quaternion, "of the same motion"));

inline constexpr auto kPlannedStepFields = std::make_tuple(
    field("name", &PlannedStep::name, "of the part, or of the subassembly, which has a scene of its own"),
    field("parts", &PlannedStep::parts, "the part, or those of the subassembly"),
    field("way", &PlannedStep::kind, "`straight`, `screw`, or `legs`: several straight or turning ones"),
    list("before", &PlannedStep::before_W, kPlannedPoseFields),
    field("insertion", &PlannedStep::insertion_W,
          "unit direction of the last leg, in the world; 0 for a turn"),
    field("lead_m", &PlannedStep::lead_m, "of a screw: its way in one turn; negative: left-hand"),
    field("allowance_m", &PlannedStep::allowance_m,
          "how much deeper than drawn facets may be in each other on its way, which it needs: no way without "
          "that was found; 0: it needs none"),
    field("is_carried", &PlannedStep::is_carried,
          "something in place keeps it from falling; false: its step says `holds`"),
    field("falling", &PlannedStep::falling, "parts in place that nothing else carries until it is there"),
    field("is_on_bench", &PlannedStep::is_on_bench,
          "it starts beside the others around the base (`--bench`)"),
    field(
        "clearance_m", &PlannedStep::clearance_m,
        "least clearance on the way to parts that it neither touches nor fits at home; null: more than 5 mm"),
    field("nearest", &PlannedStep::nearest, "the part of that clearance"),
    field("fit_clearance_m", &PlannedStep::fit_clearance_m,
          "diametral clearance of its tightest fit with parts in place; null: it has none"));
static_assert(coversAllMembers<PlannedStep>(kPlannedStepFields));

inline constexpr auto kPlannedOrderFields =
    std::make_tuple(field("before", &PlannedOrder::before, "this step comes before"),
                    field("after", &PlannedOrder::after, "this one"),
                    field("reason", &PlannedOrder::reason,
                          "`way`: later it has no way; `carries`: the later one stands on it"));
static_assert(coversAllMembers<PlannedOrder>(kPlannedOrderFields));

inline constexpr auto kBlockedPartFields =
    std::make_tuple(field("name", &BlockedPart::name, "a part that was not taken off"),
                    field("by", &BlockedPart::by, "what stops it in the directions that were tried"),
                    field("is_searched", &BlockedPart::is_searched,
                          "false: the search for ways of several legs ended at its limit of work"));
static_assert(coversAllMembers<BlockedPart>(kBlockedPartFields));

inline constexpr auto kPlannedAssemblyFields = std::make_tuple(
    field("name", &PlannedAssembly::name, "the assembly, or a subassembly"),
    field("fixed", &PlannedAssembly::fixed, "parts with which it begins; the blocked ones are among them"),
    field("fixed_reason", &PlannedAssembly::fixed_reason, "why it begins with the first, in words"),
    list("steps", &PlannedAssembly::steps, kPlannedStepFields),
    list("order", &PlannedAssembly::order, kPlannedOrderFields),
    list("blocked", &PlannedAssembly::blocked, kBlockedPartFields));
static_assert(coversAllMembers<PlannedAssembly>(kPlannedAssemblyFields));

inline constexpr auto kDrawnTwiceFields =
    std::make_tuple(field("first", &DrawnTwice::first, "a part"),
                    field("second", &DrawnTwice::second, "a part of equal geometry in the same place"));
static_assert(coversAllMembers<DrawnTwice>(kDrawnTwiceFields));

inline constexpr auto kFastenerFields = std::make_tuple(
    field("part", &Fastener::part, "a part with the shape of a fastener"),
    field("kind", &Fastener::kind, "`screw`, `stud`, `nut`, `washer`, `pin`, `key`, `circlip`"),
    field("words", &Fastener::words, "with its sizes"));
static_assert(coversAllMembers<Fastener>(kFastenerFields));

inline constexpr auto kOverlapChoiceFields = std::make_tuple(
    field("a", &OverlapChoice::a, "a part"),
    field("b", &OverlapChoice::b,
          "another one that overlaps it as drawn, or leaves it no clearance; empty for `no volume`"),
    field("kind", &OverlapChoice::kind,
          "what that is taken for: `thread` (drawn as cylinders), `press fit`, `twice` (drawn twice), "
          "`flexible` "
          "(a spring, belt or seal drawn undeformed), `line to line` (a shaft as wide as its hole), "
          "`no volume` (a surface, which is no body), or `clash`: nothing explains it"),
    field("words", &OverlapChoice::words, "in words, with what is done"),
    field("left_out", &OverlapChoice::left_out, "a part that is scenery in the planned scene; empty: none"),
    field("changed", &OverlapChoice::changed, "a part with another mesh or `press_fit` there; empty: none"),
    field("press_fit_m", &OverlapChoice::press_fit_m, "that it is given; 0: none"));

inline constexpr auto kPlannedContactFields = std::make_tuple(
    field("a", &PlannedContact::a, "a part"), field("b", &PlannedContact::b, "another one that is near it"),
    field("state", &PlannedContact::state, "as `vps check` tells it"),
    field("clearance_m", &PlannedContact::clearance_m, "least distance of their surfaces"),
    field("fits", &PlannedContact::fits, "kinds of fit, with the name in a standard"),
    field("blocked", &PlannedContact::blocked_W,
          "unit directions, of the axes of the world, of a and of its fits, in which b stops a"),
    field("free", &PlannedContact::free_W, "those of them in which it does not"));
static_assert(coversAllMembers<PlannedContact>(kPlannedContactFields));

inline constexpr auto kEqualPartsFields =
    std::make_tuple(field("names", &EqualParts::names, "parts of equal geometry"));
static_assert(coversAllMembers<EqualParts>(kEqualPartsFields));

inline constexpr auto kPlanFields =
    std::make_tuple(field("assembly", &PlanResult::assembly, "what was planned"),
                    list("fasteners", &PlanResult::fasteners, kFastenerFields),
                    list("choices", &PlanResult::choices, kOverlapChoiceFields),
                    field("blocked_count", &PlanResult::blocked, "parts that were not taken off"),
                    list("assemblies", &PlanResult::assemblies, kPlannedAssemblyFields),
                    list("contacts", &PlanResult::contacts, kPlannedContactFields),
                    list("equal", &PlanResult::equal, kEqualPartsFields),
                    list("overlaps", &PlanResult::overlaps, kCheckedPairFields),
                    list("twice", &PlanResult::twice, kDrawnTwiceFields),
                    list("uncertain", &PlanResult::uncertain, kCheckedPairFields),
                    field("cut_motions", &PlanResult::cut_motions,
                          "straight motions too long to follow to their end, which count as stopped"));
inline constexpr auto kPlanWallFields =
    std::make_tuple(field("check_s", &PlanResult::check_wall_s, "time to check the parts as drawn"),
                    field("plan_s", &PlanResult::plan_wall_s, "time to take them apart"));

inline constexpr auto kWayFaultFields = std::make_tuple(
    field("kind", &WayFault::kind,
          "`through` a part in place, `order` (that part has to come later), `support` (nothing "
          "carries it when it is let go), `clearance` (less than was planned)"),
    field("part", &WayFault::part, "the part that moves"),
    field("against", &WayFault::against, "the part in place that its way leads through"),
    field("depth_m", &WayFault::depth_m, "greatest depth on the way"),
    field("allowed_m", &WayFault::allowed_m, "depth at the target, and 10 um"),
    field("at_m", &WayFault::at_W, "where, in the world"),
    field("clearance_m", &WayFault::clearance_m, "of a lost clearance: least distance on the way"),
    field("planned_m", &WayFault::planned_m, "and as planned"));
static_assert(coversAllMembers<WayFault>(kWayFaultFields));

}  // namespace vps::scenes
