// SPDX-License-Identifier: BSD-3-Clause
// Runs gnuplot on a script.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vps_viewer/plot.h"

namespace vps::viewer::gnuplot {

/// A string literal of gnuplot's: quotes and backslashes escaped, control characters dropped. Scripts switch
/// enhanced text off, so that an underscore in a part's name stays one.
std::string quoted(const std::string& text);

/// The shortest decimal that reads back as the same double; "NaN" where it is not finite. Never by locale.
std::string number(double value);

/// A named block of columns.
std::string dataBlock(const std::string& name, const std::vector<std::vector<double>>& rows);

/// At most about 2 * bucket_count of the points, with every peak kept: the least and greatest of each bucket.
std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points,
                                               std::size_t bucket_count);

/// Runs the body once for file.png and once for file.svg; files appear only when gnuplot is content.
PlotOutcome draw(const std::string& body, const std::string& file, int width, int height);

}  // namespace vps::viewer::gnuplot
