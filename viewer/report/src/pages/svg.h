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

/// Bars one below the other, from a common zero; the longest fills the chart. The caption is below the chart.
std::string barChart(const std::vector<Bar>& bars, const std::string& caption_html);

/// One column of a histogram: two counts, one on top of the other.
struct Column {
  double low = 0, high = 0;  ///< range on the horizontal axis
  double lower = 0, upper = 0;
};

/// Columns of equal width side by side. The caller formats the ends of the axis and the caption. Lower counts
/// are green, upper counts red.
std::string histogram(const std::vector<Column>& columns, const std::string& left_text,
                      const std::string& right_text, const std::string& caption_html);

/// Two pictures side by side: the whole section, and a close-up of the place of the overlap or fit, each with
/// a scale bar. The inner part is blue, the outer part tan, their overlap red, other parts grey. `id` makes
/// names unique within a page.
std::string sectionSvg(const scenes::CheckResult& result, const scenes::CheckedSection& section,
                       std::size_t id);

/// The pictures of all sections of a check, with captions.
std::string sectionPictures(const scenes::CheckResult& result);

/// The pictures of the planes that the user chose, with captions: each part in a colour of its own, overlaps
/// in red, a scale bar and the names of the parts. Empty without such planes.
std::string planeSectionPictures(const scenes::CheckResult& result);

}  // namespace vps::viewer
