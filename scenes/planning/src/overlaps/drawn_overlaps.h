// SPDX-License-Identifier: BSD-3-Clause
// Classifies parts and overlaps as drawn: threads, press fits, flexible parts, shafts as wide as their holes,
// fasteners.
#pragma once

#include <optional>
#include <vector>

#include "fits/fastener_shape.h"
#include "surface/placed_surface.h"
#include "vps/mesh.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// Radial clearance that a resized shaft or hole gets. With a clearance of 20 um in diameter the virtual hand
/// found the hole in 100 of 100 tries; shafts that pass several holes need more.
inline constexpr double kPassingRoom_m = 25e-6;

/// A choice for each overlapping pair: its OverlapKind and the change to the planned scenes. Pairs with a
/// part that is already left out get no choice.
/// @param shapes of the parts, see fastenerShapes()
/// @param fixed  parts that must not be left out, ascending
std::vector<OverlapChoice> overlapChoices(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                                          const std::vector<std::optional<FastenerShape>>& shapes,
                                          const std::vector<std::size_t>& fixed);

/// A choice for each part that is not a body: a face, or a surface without an inside, which has no mass that
/// a hand could carry. There is no choice if no part is a body.
std::vector<OverlapChoice> noVolumeChoices(const std::vector<PlacedSurface>& parts,
                                           const std::vector<std::size_t>& fixed);

/// The parts that the choices leave out: parts without volume, all but the first of parts drawn twice, and
/// flexible parts. Ascending.
std::vector<std::size_t> leftOut(const std::vector<PlacedSurface>& parts,
                                 const std::vector<OverlapChoice>& choices);

/// The cylinder of the fit's shaft from end to end, including grooves, made thinner; in the part's frame.
/// Empty if the part has no such cylinder.
std::optional<Resized> thinnerShaft(const PlacedSurface& shaft, const CheckedFit& fit, double to_radius_m);

/// A choice for each shaft whose diameter equals that of its hole within the error: as drawn there is neither
/// clearance nor interference, so that a run by contact cannot decide whether it passes. In the planned scene
/// the shaft is thinner by twice kPassingRoom_m.
/// @param others  choices for overlaps; their parts and pairs get no second choice
std::vector<OverlapChoice> lineToLineChoices(const std::vector<PlacedSurface>& parts,
                                             const CheckResult& checked,
                                             const std::vector<OverlapChoice>& others);

/// Fasteners recognised by shape (pins only if they fit a bore), and keys: bars with key fits to two parts.
/// @param shapes of the parts, see fastenerShapes()
std::vector<Fastener> fastenersIn(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                                  const std::vector<std::optional<FastenerShape>>& shapes);

/// Measures of a surface that is cut into bands of equal distance from one of its ends, measured along the
/// surface. A wire has one or two narrow bands at every distance, a shell has bands as wide as itself, and a
/// perforated plate has many bands.
struct WireMeasure {
  double length_m = 0;  ///< length along the centre line; for a loop, its circumference
  double width_m = 0;   ///< mean diagonal of the box of a band
  double bands = 0;     ///< number of bands at one distance, which 95 % of all distances do not exceed
  [[nodiscard]] double slenderness() const { return width_m > 0 ? length_m / width_m : 0; }
};

/// Measures the surface of a mesh on a grid of cells along the surface. A cell is as wide as a quarter of the
/// thickness of a round wire, or wider so that there are at most about 50,000 cells; turns of a spring that
/// are nearer to each other than two cells are merged. All measures are 0 for a mesh without volume or area.
/// O(cells log cells). The result is the same on every machine.
WireMeasure measureWire(const Mesh& mesh);

/// Whether a part is much longer than wide, with at most two bands at each distance from its end.
bool isWireLike(const Mesh& mesh);

}  // namespace vps::scenes
