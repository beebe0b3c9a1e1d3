// SPDX-License-Identifier: BSD-3-Clause
// Charts of bars, and sections of a check, as SVG for pages.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/fits/check_types.h"

namespace vps::viewer {

/// One horizontal bar with its name on the left and its value in words on the right.
struct Bar {
  std::string name;
  double value = 0;  ///< not negative
  std::string text;
  std::string color = "#3b6ea5";
};

/// A bar below the other, from a common zero; the longest fills the chart. A caption stands below.
std::string barChart(const std::vector<Bar>& bars, const std::string& caption_html);

/// One column of a histogram: two counts, one on top of the other.
struct Column {
  double low = 0, high = 0;  ///< of the horizontal axis
  double lower = 0, upper = 0;
};

/// Columns side by side; the ends of the axis and the caption are text that the caller formats. All columns
/// have the same width. Lower counts are green, upper ones red.
std::string histogram(const std::vector<Column>& columns, const std::string& left_text,
                      const std::string& right_text, const std::string& caption_html);

/// Two pictures beside each other: the whole, and what is near the place, each with a scale bar. Inner part
/// blue, outer part tan, their overlap red, others grey. `id` makes names unique within a page.
std::string sectionSvg(const scenes::CheckResult& result, const scenes::CheckedSection& section,
                       std::size_t id);

/// All sections, with captions.
std::string sectionPictures(const scenes::CheckResult& result);

}  // namespace vps::viewer
