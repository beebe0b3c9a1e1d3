// SPDX-License-Identifier: BSD-3-Clause
// Sections of a check as SVG.
#pragma once

#include <string>

#include "vps_scenes/fits/check_types.h"

namespace vps::viewer {

/// Two pictures beside each other: the whole, and what is near the place, each with a scale bar. Inner part
/// blue, outer part tan, their overlap red, others grey. `id` makes names unique within a page.
std::string sectionSvg(const scenes::CheckResult& result, const scenes::CheckedSection& section,
                       std::size_t id);

/// All sections, with captions.
std::string sectionPictures(const scenes::CheckResult& result);

}  // namespace vps::viewer
