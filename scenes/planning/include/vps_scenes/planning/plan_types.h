// SPDX-License-Identifier: BSD-3-Clause
// What a plan is made from and what it finds: steps and their ways, order, contacts, overlaps, faults of
// ways.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/fits/fasteners.h"

namespace vps::scenes {

/// What a plan had found by the time it was stopped. A later plan of the same parts need not find it again.
struct PlanFindings {
  std::vector<std::uint64_t> motions;  ///< straight motions of pairs, each with its answer
  std::vector<std::string> taken_off;  ///< parts and sets of parts, in this order
};

struct PlanSettings {
  /// Parts that stand still, by name; empty: one is proposed, the part that holds most among the largest.
  std::vector<std::string> fixed;
  Vec3 up_W = Vec3::UnitZ();  ///< unit, against gravity
  /// The parts start beside each other around those that stand still, and are lifted over them. False: each
  /// starts on its last leg, just outside.
  bool has_bench = false;
  const PlanFindings* known = nullptr;  ///< of an earlier plan of the same parts; null: none
  PlanFindings* found = nullptr;  ///< where to put what was found, also if `progress` throws; null: nowhere
};

enum class WayKind {
  Straight,  ///< in one direction
  Screw,     ///< turned out of a thread, then straight
  Legs,      ///< several straight or turning legs
};
VPS_SCENES_API const char* toText(WayKind kind);

/// A part, or a subassembly that moves as one, and how it comes to its place.
struct PlannedStep {
  std::string name;                ///< of the part, or of the subassembly
  std::vector<std::string> parts;  ///< the part alone, or all parts of the subassembly
  WayKind kind = WayKind::Straight;
  /// Where it is before, as motions of the world applied to its pose at home: first the start, outside of the
  /// boxes of all that is in place, then the way points.
  std::vector<Pose> before_W;
  Vec3 insertion_W = Vec3::Zero();  ///< unit; of the last leg on the way home
  double lead_m = 0;                ///< of a screw: its way in one turn; negative: left-hand
  /// Of a straight way that is stopped if facets may be no deeper in each other than they are drawn: how much
  /// more they may be, for the distance of meshes from the faces and 5 um. No way without it was found. 0:
  /// the way needs none.
  double allowance_m = 0;
  bool is_carried = false;           ///< something in place keeps it from falling once it is home
  std::vector<std::string> falling;  ///< parts in place already that nothing carries until it is there
  bool is_on_bench = false;          ///< it starts there, see PlanSettings
  /// Least clearance on the whole way to parts in place that it does not touch or fit at home, to a
  /// micrometre; empty: none of them is nearer than kNearWay_m.
  std::optional<double> clearance_m;
  std::string nearest;  ///< the part of that clearance
  /// Diametral clearance of its tightest fit with parts in place; empty: it has none.
  std::optional<double> fit_clearance_m;
};
inline constexpr double kNearWay_m = 5e-3;

/// Why one step comes before another.
enum class OrderReason {
  Way,      ///< once `after` is in place, `before` has no way
  Carries,  ///< `after` stands on `before`
};
VPS_SCENES_API const char* toText(OrderReason reason);
struct PlannedOrder {
  std::string before, after;  ///< names of steps, or of fixed parts
  OrderReason reason = OrderReason::Way;
};

/// A part that was not taken off, and what stops it in the directions that were tried.
struct BlockedPart {
  std::string name;
  std::vector<std::string> by;
  bool is_searched = true;  ///< false: the search for ways of several legs ended at its limit of work
};

/// The assembly, or a subassembly, which is put together by itself before.
struct PlannedAssembly {
  std::string name;
  std::vector<std::string> fixed;  ///< where it begins; the parts that are blocked as well
  std::string fixed_reason;        ///< why it begins there, in words
  std::vector<PlannedStep> steps;  ///< in the order of assembly
  std::vector<PlannedOrder> order;
  std::vector<BlockedPart> blocked;
};

/// Two parts that touch, fit into each other, or are near.
struct PlannedContact {
  std::string a, b;
  PairState state = PairState::Apart;
  double clearance_m = 0;         ///< least distance of the surfaces
  std::vector<std::string> fits;  ///< "shaft H7/g6", "thread M8", ...
  std::vector<Vec3> blocked_W;    ///< unit directions, of the likely ones, in which b stops a
  std::vector<Vec3> free_W;       ///< and those in which it does not; b leaves a in their opposites
};

/// Parts of equal geometry, of which each can take another's place.
struct EqualParts {
  std::vector<std::string> names;
};

/// Two parts of equal geometry in one place.
struct DrawnTwice {
  std::string first, second;
};

/// What an overlap of two parts as drawn is taken for.
enum class OverlapKind {
  Thread,      ///< a screw and its nut or hole, drawn as plain cylinders
  PressFit,    ///< a shaft that is a little larger than its bore
  Twice,       ///< one part drawn twice
  Flexible,    ///< a spring, belt or seal that is drawn undeformed
  LineToLine,  ///< no overlap: a shaft that is drawn exactly as wide as its hole
  NoVolume,    ///< no overlap: a part that is no body
  Clash,       ///< nothing explains it
};
VPS_SCENES_API const char* toText(OverlapKind kind);

/// A cylinder of a part that is made thinner or wider, in the part's frame.
struct Resized {
  Vec3 axis = Vec3::UnitZ(), p = Vec3::Zero();
  double from_m = 0, to_m = 0;  ///< along the axis from p
  double from_radius_m = 0, to_radius_m = 0;
};

/// An overlap, a fit without clearance or a part without volume, and what is done about it.
struct OverlapChoice {
  std::string a, b;  ///< b is empty for a part without volume
  OverlapKind kind = OverlapKind::Clash;
  std::string words;               ///< all of it, for a person
  std::string left_out;            ///< a part that is scenery in the planned scenes; empty: none
  std::string changed;             ///< a part that is changed there; empty: none
  double press_fit_m = 0;          ///< that it is given
  std::optional<Resized> resized;  ///< how its mesh is changed
};

struct PlanResult {
  std::string assembly;
  std::vector<Fastener> fasteners;
  std::vector<OverlapChoice>
      choices;  ///< parts without volume, one for each overlap that is not allowed, shafts drawn line to line
  std::vector<PlannedAssembly> assemblies;  ///< the whole first, then its subassemblies
  std::vector<PlannedContact> contacts;     ///< the graph of contacts and of what blocks what
  std::vector<EqualParts> equal;            ///< two or more of each
  /// Overlaps as drawn. On their ways these parts may overlap as deep as they are drawn.
  std::vector<CheckedPair> overlaps;
  std::vector<DrawnTwice> twice;       ///< among the overlaps too
  std::vector<CheckedPair> uncertain;  ///< pairs of which it cannot be told whether they overlap
  /// Straight motions of a part past another one that were too long to follow to their end; they count as
  /// stopped.
  std::size_t cut_motions = 0;
  double check_wall_s = 0, plan_wall_s = 0;
  [[nodiscard]] std::size_t steps() const;
  [[nodiscard]] std::size_t blocked() const;
};

enum class WayFaultKind {
  Through,    ///< its way leads through a part in place
  Order,      ///< the same, and that part would pass if it were mounted later
  Support,    ///< nothing in place carries it when it is let go
  Clearance,  ///< it passes a part nearer than was planned
};
VPS_SCENES_API const char* toText(WayFaultKind kind);

/// What is wrong with a step as its scene states it.
struct WayFault {
  WayFaultKind kind = WayFaultKind::Through;
  std::string part, against;
  double depth_m = 0;    ///< of the meshes
  double allowed_m = 0;  ///< what they overlap at the target, and 10 um
  Vec3 at_W = Vec3::Zero();
  double clearance_m = 0, planned_m = 0;  ///< of a lost clearance
};

}  // namespace vps::scenes
