// SPDX-License-Identifier: BSD-3-Clause
// Runs gnuplot on a script.
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

/// A named block of columns.
std::string dataBlock(const std::string& name, const std::vector<std::vector<double>>& rows);

/// Reduces a curve to about 2 * bucket_count points: the least and greatest of each bucket, so that peaks
/// stay.
std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points,
                                               std::size_t bucket_count);

/// Runs the script `body` for file.png and again for file.svg. A file appears only if gnuplot succeeds.
PlotOutcome draw(const std::string& body, const std::string& file, int width, int height);

}  // namespace vps::viewer::gnuplot
