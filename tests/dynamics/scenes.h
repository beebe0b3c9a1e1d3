// SPDX-License-Identifier: BSD-3-Clause
// The scenes, each a function from settings to measured numbers.
#pragma once

#include <cstdint>

#include "world.h"

namespace vps::dynamics {

// -- A 10 x 30 mm steel peg and a blind bore 15 mm deep, with tens of micrometres of clearance.

inline constexpr double kBoreDepth_m = 15e-3, kPegLength_m = 30e-3, kPegRadius_m = 5e-3;

/// Around z, with its chamfered lower end at z = 0.
const PartMesh& pegPart();
/// A block around z with a chamfered mouth at z = 0. @param clearance_m  diameter of the bore minus that of
/// the peg
const PartMesh& borePart(double clearance_m);

struct PegDrop {
  double clearance_m = 50e-6;
  double offset_m = 0.2e-3;  ///< of the peg's lower end from the bore's axis
  double tilt_rad = 8.7e-3;  ///< half a degree
  double height_m = 1e-3;    ///< height of the peg's lower end above the mouth
  double friction = 0.15;
};

struct PegDropResult {
  double height_error_m = 0;  ///< of the lower end above the seat, at the end
  double deepest_m = 0;       ///< greatest penetration during fall and rest
  double jitter_m_s = 0;      ///< greatest speed of any point in the last 2 s (short: 0.4 s)
  double drift_m = 0;         ///< drift in the last 2 s (short: 0.4 s)
  double step_ms = 0;         ///< mean over the steps with contact
  double seated_s = 0;        ///< time at which the peg came within 10 um of its seat; -1: never
  [[nodiscard]] bool isSeated() const { return seated_s >= 0; }
};

/// Drops the peg off-centre and tilted; it falls into the bore and comes to rest.
PegDropResult dropPeg(const SceneSettings& settings, const PegDrop& drop = {});

struct LongRestResult {
  double drift_m = 0;  ///< greatest distance from the place where the peg came to rest
  double rest_s = 0;   ///< duration of the observation
  double step_ms = 0;
};

/// The seated peg at rest for ten minutes (short: ten seconds).
LongRestResult restPeg(const SceneSettings& settings);

// -- A block a thousand times as heavy as the peg, which stands on the peg or falls on it.

struct HeavyBlock {
  double ratio = 1000;     ///< block's mass over the peg's
  double speed_m_s = 0;    ///< 0: placed on the seated peg; otherwise the speed at which it arrives
  double offset_m = 1e-3;  ///< of the block's centre from the peg's axis
};

struct HeavyBlockResult {
  double deepest_m = 0;        ///< greatest penetration, of peg in bore and of block in peg
  double final_m = 0;          ///< penetration at the end
  double energy_gained_J = 0;  ///< greatest increase of kinetic plus potential energy since the start
  double kinetic_J = 0;        ///< greatest kinetic energy in the last half second
  double peg_height_m = 0;     ///< of the peg over its seat at the end
  double block_height_m = 0;   ///< of the block over its right place on the peg's top at the end
  double speed_m_s = 0;        ///< greatest of any point in the last half second
  double step_ms = 0;
};

HeavyBlockResult loadPeg(const SceneSettings& settings, const HeavyBlock& load);

// -- A ring of 20,000 triangles dropped over a peg on a plate, with 0.1 mm of clearance.

struct RingResult {
  double rest_height_m = 0;  ///< of the ring's centre above the plate; right: half the ring's height
  double height_error_m = 0;
  double deepest_m = 0;   ///< greatest penetration
  double jitter_m_s = 0;  ///< greatest speed of any point in the last half second
  double step_ms = 0;     ///< mean over the steps with contact
  int contact_steps = 0;
};

RingResult dropRing(const SceneSettings& settings);

// -- A nut on a vertical threaded rod: gravity turns it downwards, friction locks it.

struct NutSize {
  double major_m = 10e-3;  ///< the rod's diameter over its crests
  double pitch_m = 1.5e-3;
  double height_m = 8e-3;
  double corner_m = 18.5e-3 / 2;  ///< from the axis to the hexagon's corners
};
inline constexpr NutSize kM10{10e-3, 1.5e-3, 8e-3, 18.5e-3 / 2};
inline constexpr NutSize kM16{16e-3, 2e-3, 13e-3, 27.7e-3 / 2};

/// @param columns  facets a turn, a multiple of 6
const PartMesh& nutPart(const NutSize& size, int columns = 384);
const PartMesh& rodPart(const NutSize& size, int columns = 384);

struct NutRunResult {
  double acceleration_m_s2 = 0;  ///< measured along the axis, over the first turn
  double theory_m_s2 = 0;        ///< g / (1 + I / (m r^2)), r = pitch / 2 pi, I of the mesh
  double advance_m = 0;          ///< advance of the nut in one turn
  double tilt_rad = 0;           ///< greatest angle between the axes of nut and rod
  double turns = 0;              ///< in the time simulated
  double deepest_m = 0;          ///< greatest penetration, measured every 50 ms
  double step_ms = 0;            ///< mean
  std::uint64_t hash = 0;        ///< of all states of the run
};

/// Lets a nut without friction turn once under gravity.
NutRunResult runNut(const SceneSettings& settings, const NutSize& size);

/// A nut without friction that is spun downwards after it has settled on its thread.
struct NutSpinResult {
  double end_rad_s = 0, theory_rad_s = 0;  ///< about the axis, after `steps`
};
NutSpinResult spinNut(const SceneSettings& settings, const NutSize& size, double rad_s, int steps);

/// The smallest friction coefficient that holds the nut, by theory: tan(lead angle at the pitch diameter)
/// cos(30 degrees).
double selfLockTheory(const NutSize& size);

/// Rotation [rad] of a nut with this friction in duration_s, after 0.2 s in which it settles on the rod.
double turnWithFriction_rad(const SceneSettings& settings, const NutSize& size, double mu, double duration_s);

/// The smallest friction coefficient that holds the nut, found by bisection to `resolution`.
double selfLockFriction(const SceneSettings& settings, const NutSize& size, double resolution = 1e-3);

// -- Two involute gears of module 2 on hinges, 20 teeth driving 30 against a brake.

struct GearPairResult {
  double turns = 0;  ///< of the driver
  double ratio_error_rad =
      0;  ///< greatest deviation of the driven gear from 20/30 of the driver, since the start
  double ratio_drift_rad = 0;  ///< between the means of the first and the last turn: skipped teeth or creep
  double torque_share = 0;     ///< mean brake torque over mean drive torque times 30/20; 1 without loss
  double deepest_m = 0;        ///< greatest penetration, measured every 50 ms
  double step_ms = 0;          ///< mean
};

/// The driver turns at 1 turn/s for 10 turns (short: half a turn).
GearPairResult runGears(const SceneSettings& settings);

// -- Fifty parts of 5,000 points each, dropped into a box.

struct HeapResult {
  int bodies = 0;
  double points = 0;              ///< mean number of points of a part's shell
  int asleep = 0;                 ///< bodies at the end
  double asleep_s = 0;            ///< time at which the last body fell asleep; -1: never
  int escaped = 0;                ///< bodies outside of the box at the end
  double final_m = 0;             ///< greatest penetration between neighbours at the end
  double step_ms[3] = {0, 0, 0};  ///< median, p99, worst, over all steps
  double our_share = 0;           ///< share of all time in the narrow phase and the solver
};

/// Twenty seconds (short: ten bodies, eight seconds). Sleeping is enabled, below 5 mm/s and 0.2 rad/s.
HeapResult dropHeap(const SceneSettings& settings);

/// Makes one of the two parts of the heap: a gear of 20 teeth.
PartMesh makeHeapGear();
/// The engine for this scene: shells of about 5,000 points.
Engine heapEngine();

// -- Three short scenes for failures that must never happen: overlapping parts that fly apart, a proxy that
// collides, a part that tunnels.

struct CreatedInsideResult {
  double overlap_m = 0;  ///< at the start
  double kinetic_J = 0;  ///< greatest over time
  double speed_m_s = 0;  ///< greatest of any point, also by displacement
  double left_m = 0;     ///< overlap that is left at the end
  double overlap_J = 0;  ///< energy of the overlap in penalty contact: 1/2 k A d^2, half of it from each side
};
/// A 20 x 15 x 10 mm block created `depth_m` deep in a fixed one, without gravity, for one second.
CreatedInsideResult createInside(const SceneSettings& settings, double depth_m);

struct ProxyResult {
  double disturbed_m = 0;  ///< displacement of a part in the proxy's path
  int responses = 0;       ///< greatest number of the proxy's contacts that reached a solver
  double held_m = 0;       ///< height of the part in hand above the plate that stops it, at the end
};
/// A kinematic proxy with the part's own shape is coupled to a part in hand and moved down through a part at
/// rest. A plate above the part at rest stops the part in hand.
ProxyResult leadProxyThrough(const SceneSettings& settings);

struct WallResult {
  double deepest_m = 0;  ///< greatest penetration at any time
  double beyond_m =
      0;  ///< greatest distance of the part's centre beyond the wall's face; negative: it stayed in front
  double speed_m_s = 0;  ///< at the end
};
/// A block flies at a wall 2 mm thick. @param is_turned  corner first; otherwise face on
WallResult shootAtWall(const SceneSettings& settings, double speed_m_s, bool is_turned);

}  // namespace vps::dynamics
