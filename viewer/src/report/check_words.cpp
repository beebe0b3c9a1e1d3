// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/check_words.h"

#include <algorithm>
#include <cmath>

#include "report/html.h"

namespace vps::viewer::inline v0 {

std::string volumeWords(const scenes::CheckedPair& pair) {
  if (pair.volume_error_m3 < pair.interference_volume_m3)
    return html::format(1e9 * pair.interference_volume_m3, "%.4f");
  const double most_m3 = pair.interference_volume_m3 + pair.volume_error_m3;
  return most_m3 > 0 ? "<= " + html::format(1e9 * most_m3, "%.4g") : "not known";
}

std::string playWords(double way, double error, double usual, double scale, const char* form) {
  if (std::isinf(way)) return "free";
  const std::string words = html::format(scale * way, form);
  if (std::isinf(error)) return ">= " + words;
  return error > 2 * usual ? words + " (+- " + html::format(scale * error, form) + ")" : words;
}

std::string playDoubt(const scenes::CheckedPart& part, const scenes::CheckResult& result) {
  if (!part.play || part.is_play_certain) return {};
  constexpr double kEqual_m = 0.1e-6;  // as the check takes sizes for equal
  const bool has_equal = std::ranges::any_of(result.fits, [&](const scenes::CheckedFit& fit) {
    return fit.kind == scenes::FitKind::Shaft && (fit.shaft == part.name || fit.bore == part.name) &&
           std::abs(fit.diametral_clearance_m) <= fit.error_m + kEqual_m;
  });
  return std::string(has_equal ? "round faces of equal size touch" : "facets cross others as drawn")
      .append("; its play is uncertain by ")
      .append(html::format(1e6 * part.play_error_m, "%.1f"))
      .append(" um and ")
      .append(html::format(1e3 * part.play_error_rad, "%.2g"))
      .append(" mrad, and is more where meshes stop what the faces allow");
}

}  // namespace vps::viewer::inline v0
