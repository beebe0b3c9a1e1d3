// SPDX-License-Identifier: BSD-3-Clause
// Scripts of gnuplot: their pieces, the look of all plots, and running them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vps_viewer/report/plot.h"

namespace vps::viewer::gnuplot {

/// A string literal of gnuplot: quotes and backslashes are escaped, control characters dropped. Scripts
/// switch enhanced text off, so that an underscore in a part's name is not read as a subscript.
std::string quoted(const std::string& text);

/// The shortest decimal that reads back as the same double; "NaN" for a number that is not finite.
/// Independent of the locale.
std::string number(double value);

/// A named data block of gnuplot with the given rows.
std::string dataBlock(const std::string& name, const std::vector<std::vector<double>>& rows);

/// Reduces a curve to about 2 * bucket_count points: the points with the least and greatest value of each
/// bucket, so that peaks stay.
std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points,
                                               std::size_t bucket_count);

/// Runs the script `body` for file.png and again for file.svg. A file appears only if gnuplot succeeds.
PlotOutcome draw(const std::string& body, const std::string& file, int width, int height);

}  // namespace vps::viewer::gnuplot

namespace vps::viewer {

using Curve = std::vector<std::pair<double, double>>;

// The palette of Okabe and Ito, which colour-blind readers and grey prints can tell apart.
inline constexpr const char* kRed = "#D55E00";
inline constexpr const char* kGreen = "#009E73";
inline constexpr const char* kBlue = "#0072B2";
inline constexpr const char* kInk = "#333333";

/// Commands that set border, tics, grid and key.
std::string plotStyle();

/// Appends a data block of that name, thinned to the plot's resolution.
void addPoints(std::string& script, const std::string& name, const Curve& curve);

/// A curve from a data block.
struct Line {
  std::string name, title, color;
  double width = 1.3;
};

/// A plot command for the lines, followed by the plot elements in `more` (empty, or ended by ", \\\n").
std::string plotLines(const std::vector<Line>& lines, const std::string& more = {});

}  // namespace vps::viewer
