// SPDX-License-Identifier: BSD-3-Clause
// The path on which a part leaves the others, its clearance, and its start on a bench.
#pragma once

#include <optional>
#include <vector>

#include "surface/placed_surface.h"
#include "vps/errors.h"
#include "vps_scenes/planning/plan_types.h"
#include "ways/pair_motions.h"

namespace vps::scenes {

/// A piece of a path, in the world.
struct Leg {
  Motion motion;
  double s = 0;  ///< length or angle of the motion; PairMotions::leave_m() for the last leg
};

/// Way::direction of a path that is not straight.
inline constexpr std::size_t kNoDirection = ~std::size_t{0};

/// A path from the target outwards. The last leg is straight.
struct Way {
  WayKind kind = WayKind::Straight;
  std::vector<Leg> legs;
  std::size_t direction = kNoDirection;  ///< of a straight path: index in PairMotions::directions()
  double lead_m = 0;                     ///< of a screw: travel in one turn
  double allowance_m = 0;                ///< of a straight path, see PairMotions::allowanceOf()
};

/// The poses at the ends of all legs but the last, as motions of the world; the first pose is the target.
std::vector<Pose> cornersOf(const Way& way);

/// Distance along d until a moving box has left another box; 0 if the moving box never touches the other box.
double leavingDistance_m(const Box& moving, const Box& held, const Vec3& d);

/// Whether a held part stops another part on its path.
bool stopsWay(const PairMotions& motions, std::size_t held, std::size_t part, const Way& way);

/// A screw motion out of the thread of a fit between the part and one of the held parts, followed by a
/// straight motion.
std::optional<Way> screwWay(const PairMotions& motions, std::size_t part,
                            const std::vector<std::size_t>& held);

/// A path of several legs for parts that move as one. Legs are straight along the parts' axes; a single part
/// may also turn about the axes of its round fits. The search is breadth first: from each place the part
/// moves as far as it can and to stops in between, so that a path with the fewest legs is found first. The
/// search ends when `work` is spent, at 4 legs or at 96 places, so an empty result is not a proof. Source:
/// the search over pushes of Tian et al., Assemble Them All, 2022, with exact motions in place of simulated
/// ones.
std::optional<Way> legWay(const PairMotions& motions, const std::vector<std::size_t>& parts,
                          const std::vector<std::size_t>& held, SearchWork& work);

/// A path of up to 5 legs for a single part that legWay() finds none for, over at most 256 places. Legs are
/// also slides along a contact that stops a straight motion, turns about it, screws that slide along it
/// (helical teeth), straight motions along the axes of the part as it stands, and motions as short as the
/// part's play. An empty result is not a proof.
std::optional<Way> contactWay(const PairMotions& motions, std::size_t part,
                              const std::vector<std::size_t>& held, SearchWork& work);

/// The placed parts of a plan, with which the paths of the plan are measured.
struct Placing {
  const std::vector<PlacedSurface>& parts;
  const CheckResult& checked;
  Vec3 up_W;
};

/// Sets PlannedStep::clearance_m, nearest and fit_clearance_m of each step. A distance between parts changes
/// by no more than the moving surface moves; each leg is therefore bisected until no smaller distance is
/// possible, within a micrometre or a thousandth of the distance. Runs on all cores.
void measureWays(const Placing& placing, PlannedAssembly& assembly, const Progress& progress);

/// Gives each step a start on a bench: a plane below the whole assembly. The parts lie on the bench in rings
/// around the assembly, in the order of the steps and with the orientation of their starts, with gaps of a
/// twentieth of the assembly's size. From the bench a part is lifted above everything, moved across, and
/// lowered to its original start. The boxes of all starts and of the assembly do not overlap. A step whose
/// part cannot be lowered, because parts in place cover its start on all sides, keeps its start.
void layOnBench(const Placing& placing, PlannedAssembly& assembly);

}  // namespace vps::scenes
