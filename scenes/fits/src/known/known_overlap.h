// SPDX-License-Identifier: BSD-3-Clause
// Overlaps that a drawing has on purpose: threads drawn as cylinders, threads out of phase, squashed seals,
// inserts and self-tapping screws. The check, the plan and the run take this knowledge from here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fits/faces.h"
#include "fits/fastener_shape.h"
#include "surface/placed_surface.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// What an overlap of two parts is taken for.
struct KnownOverlap {
  PairState state = PairState::Clash;  ///< Thread, Seal or Insert; Clash: it is none of them
  std::string words = {};              ///< what was assumed, or what is wrong; empty: nothing is known
  std::string fastener = {};           ///< the screw, seal or insert; empty for a clash
  std::string size = {};               ///< nominal size of a thread, "M8"; else empty
  double squash = 0;                   ///< of a seal: largest squash, divided by the width of its section
};

/// One part of an overlapping pair, with its faces and the kind of fastener that it has the shape of.
struct KnownPart {
  const PlacedSurface& part;
  const FitFaces& faces;
  const std::optional<FastenerShape>& shape;
};

/// A shaft that is larger than the hole in which it is, with a common axis.
struct TightHole {
  Vec3 axis_W = Vec3::UnitZ(), p_W = Vec3::Zero();  ///< axis of the hole, unit; a point on it
  double from_m = 0, to_m = 0;                      ///< ends of the shaft along the axis, from p_W
  double shaft_m = 0, hole_m = 0;                   ///< radii
  bool is_threaded = false;                         ///< shaft or hole has a modelled thread
};

/// The shafts of `inner` that are larger than a hole of `outer` in which they are. Where a thread is
/// modelled, its crests count: the major radius of a screw, the minor radius of a nut. O(faces of one x of
/// the other).
std::vector<TightHole> tightHoles(const KnownPart& inner, const KnownPart& outer);

/// The holes of `outer` that have a common axis with any round face or thread of `inner`, with the extent of
/// all of `inner` along the axis; shaft_m is that of the hole. O(faces of one x of the other).
std::vector<TightHole> holesAround(const KnownPart& inner, const KnownPart& outer);

/// Whether the parts overlap nowhere but between the radii of a tight hole: whether they are free of overlap,
/// by exact measure, after the shaft was made thinner than the hole. O(n log n).
bool isOnlyInHole(const PlacedSurface& inner, const PlacedSurface& outer, const TightHole& hole);

/// A thread that is drawn as a cylinder in at least one of the parts: the shaft has the nominal diameter of a
/// thread of ISO 262 and the hole its minor diameter or that of its drill; one part is a screw, a headed
/// pin, a stud or a nut by its shape; and the parts overlap nowhere else. A declared thread may have any
/// shape, and any size whose hole is smaller by 5 to 25 % of the diameter, as from M64x4 to M1.
KnownOverlap drawnThread(const KnownPart& a, const KnownPart& b, bool is_declared);

/// Two modelled threads: out of phase (a turn about the axis, found from the phases of the flanks, is
/// verified by exact measure), of different hand, or of different lead.
KnownOverlap modelledThread(const KnownPart& a, const KnownPart& b);

/// An insert (a bush with a metric hole or thread) or a self-tapping screw, in a smaller hole: `declared` by
/// the user, or named so in the drawing. The overlap may take up to 15 % of the diameter for an insert, and
/// 35 % for a self-tapping screw.
KnownOverlap formedHole(const KnownPart& a, const KnownPart& b, std::optional<OverlapWish> declared);

/// The greatest squash of a static seal, divided by the width of its section. Source: Parker O-Ring Handbook,
/// ORD 5700, section 4: up to about 30 % of the section for static seals (16 % for moving ones).
inline constexpr double kMostSquash = 0.30;

/// A ring of round section.
struct Torus {
  Vec3 axis = Vec3::UnitZ(), p = Vec3::Zero();  ///< in the part's frame
  double ring_m = 0, section_m = 0;             ///< radii: of the centre line, of the section
};
/// The torus that a part is: all its vertices lie on it within 1 % of the section, and it is whole.
std::optional<Torus> torusOf(const PartSurface& part);

/// How far other parts reach into the section of a torus: for angles around the axis and directions across
/// the section, the length of the section's radius that is inside a part [m].
class Squash {
 public:
  static constexpr int kTurns = 48, kDirections = 32;
  /// Measures the intrusion of one part. O(kTurns x kDirections x log n).
  Squash(const PlacedSurface& seal, const Torus& torus, const PlacedSurface& other);
  /// Adds the intrusion of another part into the same seal.
  void add(const Squash& other);
  /// Whether the intrusion goes all around: its least value over the turn is at least half of its greatest.
  [[nodiscard]] bool isAllAround() const;
  /// The greatest intrusion from two opposite sides together, divided by the width of the section; 1 if a
  /// part contains the centre line.
  [[nodiscard]] double share() const;

 private:
  std::vector<double> in_m_;
  double section_m_;
};

}  // namespace vps::scenes
