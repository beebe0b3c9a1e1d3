// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/mesh_warning.h"

#include <cmath>
#include <cstdio>

#include "vps/mesh_repair.h"

namespace vps::scenes {

std::string meshWarning(const MeshReport& report) {
  if (!report.signed_by_winding && !report.is_union_incomplete) return {};
  const bool has_faults = !report.isClosed() || report.overlapping_shells > 0 || report.internal_facets > 0 ||
                          report.sheet_facets > 0 || report.duplicate_triangles > 0 ||
                          report.united_shells > 0 || report.is_union_incomplete;
  if (!has_faults && report.certain_share >= 1) return {};
  const bool is_as_given = report.is_union_incomplete && !report.signed_by_winding;
  std::string words = !report.isClosed() ? "is not a closed surface: "
                      : is_as_given      ? "has shells that meet: "
                                         : "is repaired: ";
  const std::string found = describe(report);
  words += found.substr(0, found.rfind(';'));
  char certain[96];
  // Rounded down, so that 100 % means all.
  std::snprintf(certain, sizeof certain, "; inside and outside are certain for %.4g %% of the space near it",
                std::floor(1e4 * report.certain_share) / 1e2);
  return words + certain;
}

}  // namespace vps::scenes
