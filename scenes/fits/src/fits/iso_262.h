// SPDX-License-Identifier: BSD-3-Clause
// Names of metric screw threads.
#pragma once

#include <string>

namespace vps::scenes {

struct MetricThread {
  std::string name;    ///< "M16", "M16x1.5" for a fine pitch, "M16x1.5-LH" for a left-hand one
  double pitch_m = 0;  ///< the standard one
};

/// The thread of ISO 262 whose pitch is within a hundredth of this one, and in whose tolerance 8g to h the
/// diameter lies; an empty name if there is none.
/// @param major_m  greatest diameter of the screw
/// @param lead_m   of a thread with one start; negative: left-hand
/// Source: ISO 262:1998 (selected sizes), ISO 965-1:2013 (deviations of the major diameter).
MetricThread metricThread(double major_m, double lead_m);

/// "M8" for a plain cylinder that stands for a thread of that size: the nominal diameter, within 8g of it.
/// Empty if there is none.
std::string metricSize(double major_m);

/// "M8" for a plain hole that stands for a thread of that size: with the minor diameter of a nut, D - 1.0825
/// P, or that of its drill, D - P, of a coarse or fine pitch, within 0.1 P. Empty if there is none.
std::string metricHole(double minor_m);

}  // namespace vps::scenes
