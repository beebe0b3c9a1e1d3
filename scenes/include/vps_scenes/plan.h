// SPDX-License-Identifier: BSD-3-Clause
// Finds an order and ways for the parts of an assembly by taking it apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/check.h"
#include "vps_scenes/fasteners.h"

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

/// Plans the assembly of parts as drawn. The same result on any number of threads. Throws LoadError for parts
/// that cannot be measured (see checkAssembly()), no parts, and names that are none.
VPS_SCENES_API PlanResult planAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                                       const PlanSettings& settings = {}, const Progress& progress = {});
/// The same of the parts of a scene at their targets, without its scenery. Its fixed parts stand still unless
/// the settings name others; its gravity says what is up.
VPS_SCENES_API PlanResult planAssembly(const Scene& scene, PlanSettings settings = {},
                                       const Progress& progress = {});

/// The graph of precedence of all assemblies, in the DOT language of Graphviz; what follows from other edges
/// is left out.
VPS_SCENES_API std::string planDot(const PlanResult& plan);

/// The same graph as a picture (SVG), the steps from left to right.
VPS_SCENES_API std::string planSvg(const PlanResult& plan);

/// The parts of a CAD file as a scene without steps.
VPS_SCENES_API Scene sceneOf(const ImportedCad& cad);

/// A scene for each assembly of a plan, in its order, with the settings of the scene that was planned. The
/// parts of a subassembly are one part of the scene that mounts it.
VPS_SCENES_API std::vector<Scene> plannedScenes(const Scene& scene, const PlanResult& plan);

/// Models of a planned scene take no more than this, where larger voxels can help [bytes].
inline constexpr double kMostModels_bytes = 1e9;
/// Sets voxel and spacing of a planned scene that has those of the preset `normal`: smaller ones where a part
/// that is moved is less than eight voxels across, larger ones where the models would take too much memory
/// (estimated from areas and edges). Depends on the scene alone.
/// @return what was chosen and why, in words; empty: the preset serves
VPS_SCENES_API std::string fitFidelity(Scene& scene, double most_bytes = kMostModels_bytes);

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

/// Follows the ways of all steps: conservative advancement finds what is deeper than allowed however thin it
/// is, along straight legs and threads, and along turning legs within 2 um; the depth is then measured at 24
/// poses of the leg, and where it was stopped. A screw is followed along its thread from its target on. A
/// part that no step holds has to be carried by what is in place. The worst fault of each step, in order;
/// empty: none.
/// @param planned_clearance_m  of the ways, by part, where less is a fault (PlannedStep::clearance_m)
VPS_SCENES_API std::vector<WayFault> checkWays(const Scene& scene, const Progress& progress = {},
                                               const std::map<std::string, double>& planned_clearance_m = {});

}  // namespace vps::scenes
