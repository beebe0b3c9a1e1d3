// SPDX-License-Identifier: BSD-3-Clause
// The look of all plots, and pieces of gnuplot scripts that they share.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace vps::viewer {

using Curve = std::vector<std::pair<double, double>>;

// The palette of Okabe and Ito, which colour-blind readers and grey prints can tell apart.
inline constexpr const char* kRed = "#D55E00";
inline constexpr const char* kGreen = "#009E73";
inline constexpr const char* kBlue = "#0072B2";
inline constexpr const char* kInk = "#333333";

/// Sets border, tics, grid and key.
std::string plotStyle();

/// Appends a data block of that name, thinned to the plot's resolution.
void addPoints(std::string& script, const std::string& name, const Curve& curve);

/// A curve of a data block.
struct Line {
  std::string name, title, color;
  double width = 1.3;
};

/// A plot command for the lines, followed by what `more` holds (ended by ", \\\n" or empty).
std::string plotLines(const std::vector<Line>& lines, const std::string& more = {});

}  // namespace vps::viewer
