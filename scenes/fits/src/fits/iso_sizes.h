// SPDX-License-Identifier: BSD-3-Clause
// Names and tolerance zones of standard sizes: metric screw threads (ISO 262) and fits (ISO 286).
#pragma once

#include <optional>
#include <string>

namespace vps::scenes {

/// A metric screw thread of ISO 262.
struct MetricThread {
  std::string name;    ///< "M16", "M16x1.5" for a fine pitch, "M16x1.5-LH" for a left-hand thread
  double pitch_m = 0;  ///< the pitch in ISO 262
};

/// The thread of ISO 262 whose pitch differs from the lead by at most 1 % and whose tolerance 8g to h
/// contains the diameter. The name is empty if ISO 262 has no such thread. Source: ISO 262:1998 (selected
/// sizes), ISO 965-1:2013 (deviations of the major diameter).
/// @param major_m greatest diameter of the screw
/// @param lead_m lead of a thread with one start; negative: left-hand
MetricThread metricThread(double major_m, double lead_m);

/// The size ("M8") of a thread that is drawn as a plain cylinder: the nominal diameter within whose tolerance
/// 8g the diameter lies. Empty if no size of ISO 262 matches.
std::string metricSize(double major_m);

/// The size ("M8") of an internal thread that is drawn as a plain hole. The hole has the minor diameter of
/// the nut, D - 1.0825 P, or the diameter of its drill, D - P, within 0.1 P, for a coarse or fine pitch P.
/// Empty if no size of ISO 262 matches.
std::string metricHole(double minor_m);

/// The size ("M8") of a hexagon nut whose thread is drawn as a plain hole: the size whose width across flats
/// the nut has (ISO 4032, ISO 272, and the older widths of DIN 934 and DIN 985), out of the sizes of whose
/// threads the hole has the major or the minor diameter or the drill's. Empty if no size of ISO 262 matches.
std::string metricNut(double hole_m, double across_m);
/// The thread of ISO 262 ("M8", "M8x1") whose nominal diameter the shaft has within tolerance 8g, and whose
/// minor diameter or drill the hole has within 0.1 P; of several pitches the nearest. Empty if there is none.
std::string metricThreadIn(double shaft_m, double hole_m);

/// A tolerance zone: least and greatest deviation from the nominal size [m].
struct Zone {
  double lower_m = 0, upper_m = 0;
};

/// The zone of a tolerance class, as "H7" (a hole) or "g6" (a shaft). Known are the letters d to h, k, m, n,
/// p for shafts and D to H for holes, with grades 5 to 11. The result is empty for other text, and for
/// nominal sizes outside of 0 to 500 mm.
std::optional<Zone> isoZone(const std::string& zone, double nominal_m);

/// The first of the recommended fits, as "H7/g6", whose zones contain both diameters for a nominal size that
/// is a multiple of 0.5 mm; empty if there is none.
std::string isoFit(double bore_m, double shaft_m);

}  // namespace vps::scenes
