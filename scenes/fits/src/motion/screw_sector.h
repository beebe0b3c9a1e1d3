// SPDX-License-Identifier: BSD-3-Clause
// Where two facets can meet on a turn or a screw motion: bounds by their angles about the axis and by their
// phases.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "motion/motion.h"
#include "surface/around_axis.h"
#include "surface/part_surface.h"

namespace vps::scenes {

/// Bound of |phase(p) - its linear interpolation| [m] on a flat triangle, where the phase of a point is its
/// distance along the axis of a screw minus the advance per radian times its angle about the axis.
/// @param span_rad  range of the angles of the corners, at most 1
/// @param ratio  greatest over least distance of the corners from the axis
double phaseSlack_m(double forward_m, double span_rad, double ratio);

/// Range of the angle about the axis of a screw and range of the phase, see phaseSlack_m(). The angle is
/// continuous within a sector and may be anything modulo a whole turn; the phase belongs to that choice. A
/// screw motion adds the turned angle to the angle of each point and leaves its phase as it is.
struct ScrewSector {
  double from_rad = std::numeric_limits<double>::max(), to_rad = std::numeric_limits<double>::lowest();
  double from_m = std::numeric_limits<double>::max(), to_m = std::numeric_limits<double>::lowest();

  /// A sector all around the axis, of any phase: no motion is bounded by it.
  [[nodiscard]] static ScrewSector all();
  [[nodiscard]] bool isAll() const { return to_rad - from_rad >= 2 * std::numbers::pi; }
  /// Makes this sector contain another one, of a screw with this advance per radian.
  void add(ScrewSector other, double forward_m);
};

/// The sector of a triangle.
/// @param u  unit vector across the axis from which angles are measured; v = axis x u
/// @param nearest_m  least distance of the triangle from the axis
ScrewSector screwSector(const Triangle& t, const Motion& screw, const Vec3& u, const Vec3& v,
                        double nearest_m);

/// A piece of a screw motion, by the angle that was turned since the poses of the sectors. The angle falls
/// along the piece if the motion turns against the axis of the sectors.
struct TurnedAngles {
  double start_rad = 0, end_rad = 0;
};

/// The part of a piece of motion, in radians from its start, outside of which two facets stay apart.
struct MeetingTime {
  double from_rad = 0, to_rad = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool isNever() const { return from_rad > to_rad; }
};

/// When a point of the moving sector can come within a distance of a point of the held sector.
/// @param forward_m  advance of the screw along the axis of the sectors, per radian
/// @param within_m  the distance
/// @param nearest_m  a lower bound of the distance of one of the two points from the axis
MeetingTime meetingTime(const ScrewSector& moving, const ScrewSector& held, double forward_m,
                        const TurnedAngles& turned, double within_m, double nearest_m);

/// The sectors of all nodes and triangles of a part. O(n).
struct ScrewSectors {
  std::vector<ScrewSector> nodes, triangles;
  /// @param screw  in the part's frame
  /// @param zero  unit vector across the axis, in the part's frame, from which angles are measured
  /// @param extents  of the part around the axis of the screw
  ScrewSectors(const PartSurface& part, const Motion& screw, const Vec3& zero, const AxisExtents& extents);
};

}  // namespace vps::scenes
