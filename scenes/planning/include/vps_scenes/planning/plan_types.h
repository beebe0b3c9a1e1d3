// SPDX-License-Identifier: BSD-3-Clause
// Input and result types of a plan: steps and their paths, order, contacts, overlaps, faults of paths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/fits/fasteners.h"
#include "vps_scenes/fits/resized.h"

namespace vps::scenes {

/// Intermediate results of a plan that was stopped. A later plan of the same parts reuses these results.
struct PlanFindings {
  std::vector<std::uint64_t> motions;  ///< straight motions of pairs, each with its result
  std::vector<std::string> taken_off;  ///< parts and sets of parts, in the order of removal
};

struct PlanSettings {
  /// Names of the parts that stand still; empty: one part is proposed, out of the largest parts the part with
  /// most neighbours.
  std::vector<std::string> fixed;
  Vec3 up_W = Vec3::UnitZ();  ///< unit vector against gravity
  /// True: the parts start next to each other around the fixed parts, and are lifted over the fixed parts.
  /// False: each part starts on its last leg, just outside the assembly.
  bool has_bench = false;
  OverlapWishes overlaps = {};          ///< as in CheckSettings
  const PlanFindings* known = nullptr;  ///< findings of an earlier plan of the same parts; null: none
  PlanFindings* found =
      nullptr;  ///< receives the findings, also if `progress` throws; null: the findings are dropped
};

enum class WayKind {
  Straight,  ///< one straight motion
  Screw,     ///< a turn out of a thread, then a straight motion
  Legs,      ///< several straight or turning legs
};
VPS_SCENES_API const char* toText(WayKind kind);

/// A part, or a subassembly that moves as one, and its path to its target.
struct PlannedStep {
  std::string name;                ///< name of the part, or of the subassembly
  std::vector<std::string> parts;  ///< the part alone, or all parts of the subassembly
  WayKind kind = WayKind::Straight;
  /// Poses before the target, as world motions applied to the target pose: first the start, outside of the
  /// boxes of all parts in place, then the way points.
  std::vector<Pose> before_W;
  Vec3 insertion_W = Vec3::Zero();  ///< unit direction of the last leg towards the target
  double lead_m = 0;                ///< lead of a screw: its travel in one turn; negative: left-hand
  /// For a straight path that is stopped if facets may overlap no deeper than drawn: the additional depth
  /// that facets may have, from the deviation of meshes from the faces and 5 um. The allowance is non-zero
  /// only if no path without an allowance was found.
  double allowance_m = 0;
  bool is_carried = false;           ///< a part in place keeps the step's part from falling at its target
  std::vector<std::string> falling;  ///< parts in place that nothing else carries until this step is done
  bool is_on_bench = false;          ///< the part starts on the bench, see PlanSettings
  /// Least clearance on the whole path to parts in place that the moved part does not touch or fit at its
  /// target, to a micrometre; empty: no such part is nearer than kNearWay_m.
  std::optional<double> clearance_m;
  std::string nearest;  ///< the part nearest to the path, at clearance_m
  /// Diametral clearance of the step's tightest fit with parts in place; empty: the part has no such fit.
  std::optional<double> fit_clearance_m;
};
/// Clearances above this distance are not reported.
inline constexpr double kNearWay_m = 5e-3;

/// Reason why one step comes before another.
enum class OrderReason {
  Way,      ///< once `after` is in place, `before` has no path
  Carries,  ///< `before` carries `after`
};
VPS_SCENES_API const char* toText(OrderReason reason);
struct PlannedOrder {
  std::string before, after;  ///< names of steps, or of fixed parts
  OrderReason reason = OrderReason::Way;
};

/// A part that was not taken off, and the parts that stop it in the directions that were tried.
struct BlockedPart {
  std::string name;
  std::vector<std::string> by;
  bool is_searched = true;  ///< false: the search for paths of several legs ended at its work limit
  /// A part that `name` is proven to be unable to leave, on any path, whatever other parts do; empty: nothing
  /// is proven. A part without a path and without a proof may still have a path that the search did not find.
  std::string enclosed_by;
  double moves_m = 0, turns_rad = 0;  ///< bounds of what `name` can move and turn relative to enclosed_by
};

/// The assembly, or a subassembly, which is assembled separately beforehand.
struct PlannedAssembly {
  std::string name;
  std::vector<std::string> fixed;  ///< parts with which the assembly begins, including the blocked ones
  std::string fixed_reason;        ///< why the assembly begins with the first of `fixed`, in words
  std::vector<PlannedStep> steps;  ///< in the order of assembly
  std::vector<PlannedOrder> order;
  /// The parts without a path: those that are proven to have none (BlockedPart::enclosed_by) and those for
  /// which none was found.
  std::vector<BlockedPart> blocked;
  /// The parts of `blocked` that are proven to have no path, or those for which no path was found.
  [[nodiscard]] std::vector<BlockedPart> withoutPath(bool is_proven) const {
    std::vector<BlockedPart> out;
    for (const BlockedPart& part : blocked)
      if (part.enclosed_by.empty() != is_proven) out.push_back(part);
    return out;
  }
};

/// Two parts that touch, fit into each other, or are near.
struct PlannedContact {
  std::string a, b;
  PairState state = PairState::Apart;
  double clearance_m = 0;         ///< least distance of the surfaces
  std::vector<std::string> fits;  ///< "shaft H7/g6", "thread M8", ...
  std::vector<Vec3> blocked_W;    ///< likely directions (unit vectors) in which b stops a
  std::vector<Vec3>
      free_W;  ///< likely directions in which b does not stop a; b leaves a in the opposite directions
};

/// Parts of equal geometry, which are interchangeable.
struct EqualParts {
  std::vector<std::string> names;
};

/// Two parts of equal geometry at the same pose.
struct DrawnTwice {
  std::string first, second;
};

/// Classification of an overlap of two parts as drawn.
enum class OverlapKind {
  Thread,      ///< a screw and its nut or hole, drawn as plain cylinders or out of phase
  Insert,      ///< an insert in a smaller hole
  PressFit,    ///< a shaft that is a little larger than its bore
  Twice,       ///< one part drawn twice
  Flexible,    ///< a spring, belt or seal that is drawn undeformed
  LineToLine,  ///< no overlap: a shaft that is drawn exactly as wide as its hole
  NoVolume,    ///< no overlap: a part without a closed volume
  Clash,       ///< nothing explains the overlap
};
VPS_SCENES_API const char* toText(OverlapKind kind);

/// An overlap, a fit without clearance or a part without volume, and the change made to the planned scenes.
struct OverlapChoice {
  std::string a, b;  ///< b is empty for a part without volume
  OverlapKind kind = OverlapKind::Clash;
  std::string words;               ///< the choice in words, for a person
  std::string left_out;            ///< a part that becomes scenery in the planned scenes; empty: none
  std::string changed;             ///< a part whose mesh or fit is changed in the planned scenes; empty: none
  double press_fit_m = 0;          ///< press fit that the changed part gets
  std::optional<Resized> resized;  ///< how the mesh of the changed part is resized
};

struct PlanResult {
  std::string assembly;
  std::vector<Fastener> fasteners;
  /// Parts without volume, overlaps that are not allowed, and shafts drawn line to line; one choice for each.
  std::vector<OverlapChoice> choices;
  std::vector<PlannedAssembly> assemblies;  ///< first the whole assembly, then its subassemblies
  std::vector<PlannedContact>
      contacts;                   ///< the contact graph, with the directions in which parts block each other
  std::vector<EqualParts> equal;  ///< sets of at least two equal parts
  /// Overlaps of the parts as drawn. On their paths, these pairs of parts may overlap as deep as they are
  /// drawn.
  std::vector<CheckedPair> overlaps;
  std::vector<DrawnTwice> twice;       ///< pairs drawn twice, which are also listed in overlaps
  std::vector<CheckedPair> uncertain;  ///< pairs for which the measurement cannot decide whether they overlap
  /// Number of straight motions of a part past another that were too long to follow to their end, and
  /// therefore count as stopped.
  std::size_t cut_motions = 0;
  double check_wall_s = 0, plan_wall_s = 0;
  [[nodiscard]] std::size_t steps() const;
  [[nodiscard]] std::size_t blocked() const;
  /// Number of parts among them that are proven to have no path.
  [[nodiscard]] std::size_t enclosed() const;
  /// Blocked if a part is proven to have no path; NotShown if no path was found for a part; else Fits.
  [[nodiscard]] Verdict verdict() const;
};

enum class WayFaultKind {
  Through,    ///< the path overlaps a part in place
  Order,      ///< the path overlaps a part in place, and would be free if that part were mounted later
  Support,    ///< no part in place carries the moved part when the hand lets go
  Clearance,  ///< the path passes a part nearer than was planned
};
VPS_SCENES_API const char* toText(WayFaultKind kind);

/// A fault of a step of a scene, on the path that the scene states.
struct WayFault {
  WayFaultKind kind = WayFaultKind::Through;
  std::string part, against;
  double depth_m = 0;    ///< greatest overlap of the meshes on the path
  double allowed_m = 0;  ///< overlap of the meshes at the target, plus 10 um
  Vec3 at_W = Vec3::Zero();
  double clearance_m = 0, planned_m = 0;  ///< least and planned clearance of a Clearance fault
  /// Bound of the error of depth_m: distance of both meshes from their true faces. Infinite: unknown.
  double error_m = 0;
  /// Whether the fault is more than the error of the meshes may account for.
  [[nodiscard]] bool isCertain() const { return depth_m == 0 || depth_m - error_m > allowed_m; }
};

}  // namespace vps::scenes
