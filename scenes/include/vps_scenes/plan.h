// SPDX-License-Identifier: BSD-3-Clause
// Finds an order and ways for the parts of an assembly by taking it apart.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/check.h"
#include "vps_scenes/fasteners.h"

namespace vps::scenes::inline v0 {

struct PlanSettings {
  /// Parts that stand still, by name; empty: one is proposed, the part that holds most among the largest.
  std::vector<std::string> fixed;
  Vec3 up_W = Vec3::UnitZ();  ///< unit, against gravity
  /// The parts start beside each other around those that stand still, and are lifted over them. False: each
  /// starts on its last leg, just outside.
  bool has_bench = false;
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
  Vec3 insertion_W = Vec3::Zero();   ///< unit; of the last leg on the way home
  double lead_m = 0;                 ///< of a screw: its way in one turn; negative: left-hand
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
  Clash,       ///< nothing explains it
};
VPS_SCENES_API const char* toText(OverlapKind kind);

/// A cylinder of a part that is made thinner or wider, in the part's frame.
struct Resized {
  Vec3 axis = Vec3::UnitZ(), p = Vec3::Zero();
  double from_m = 0, to_m = 0;  ///< along the axis from p
  double from_radius_m = 0, to_radius_m = 0;
};

/// An overlap, or a fit without clearance, and what is done about it.
struct OverlapChoice {
  std::string a, b;
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
      choices;  ///< one for each overlap that is not allowed, then shafts drawn line to line
  std::vector<PlannedAssembly> assemblies;  ///< the whole first, then its subassemblies
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

/// The parts of a CAD file as a scene without steps.
VPS_SCENES_API Scene sceneOf(const ImportedCad& cad);

/// A scene for each assembly of a plan, in its order, with the settings of the scene that was planned. The
/// parts of a subassembly are one part of the scene that mounts it.
VPS_SCENES_API std::vector<Scene> plannedScenes(const Scene& scene, const PlanResult& plan);

/// Where a step's way, as its scene states it, leads through a part in place.
struct WayFault {
  std::string part, against;
  double depth_m = 0;    ///< of the meshes
  double allowed_m = 0;  ///< what they overlap at the target, and 10 um
  Vec3 at_W = Vec3::Zero();
};

/// Measures the exact overlap along the ways of all steps, at 24 poses of each leg. A screw is followed along
/// its thread from its target on. The deepest fault of each step, in order; empty: all ways are free.
VPS_SCENES_API std::vector<WayFault> checkWays(const Scene& scene, const Progress& progress = {});

}  // namespace vps::scenes::inline v0
