// SPDX-License-Identifier: BSD-3-Clause
// Derives the variables of a study from the tolerances of a scene's parts.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "fits/iso_sizes.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/planning/study.h"

namespace vps::scenes {

namespace {

bool isHoleClass(const std::string& zone) {
  return std::isupper(static_cast<unsigned char>(zone.front())) != 0;
}

/// Drawn diameter or width of the part's tightest fit as a hole or as a shaft.
std::optional<double> drawnSize_m(const CheckResult& checked, const std::string& part, bool is_hole) {
  std::optional<double> size_m;
  double tightest_m = 0;
  for (const CheckedFit& fit : checked.fits) {
    if (fit.kind == FitKind::Thread || (is_hole ? fit.bore : fit.shaft) != part) continue;
    if (size_m && fit.diametral_clearance_m >= tightest_m) continue;
    size_m = is_hole ? fit.bore_m : fit.shaft_m;
    tightest_m = fit.diametral_clearance_m;
  }
  return size_m;
}

/// Collects the variables, one part after the other.
class Variables {
 public:
  explicit Variables(const Scene& scene) : scene_(scene) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i) addPart(i);
    if (out_.empty())
      throw LoadError(scene.file, "",
                      "states no tolerance to study; give a [[part]] size_tolerance = \"H7\", size_lower and "
                      "size_upper, position_tolerance, angle_tolerance_deg or friction_tolerance");
  }
  std::vector<StudyVariable> take() { return std::move(out_); }

 private:
  void addPart(std::size_t index) {
    const PartTolerance& tolerance = scene_.parts[index].tolerance;
    addSize(index, tolerance);
    const auto addThree = [&](double limit, StudyQuantity first, const char* const(&words)[3]) {
      for (int axis = 0; axis < 3 && limit > 0; ++axis)
        add(index, words[axis], static_cast<StudyQuantity>(static_cast<int>(first) + axis), -limit, limit);
    };
    addThree(tolerance.position_m, StudyQuantity::X, {"along x", "along y", "along z"});
    addThree(tolerance.angle_rad, StudyQuantity::AboutX, {"about x", "about y", "about z"});
    if (tolerance.friction > 0)
      add(index, "friction", StudyQuantity::Friction, -tolerance.friction, tolerance.friction);
  }

  void addSize(std::size_t index, const PartTolerance& tolerance) {
    const std::string& name = scene_.parts[index].part.name;
    const auto refuse = [&](const std::string& words) { throw LoadError(scene_.file, name, words); };
    if (!tolerance.size_class.empty()) {
      if (tolerance.lower_m != 0 || tolerance.upper_m != 0)
        refuse("states both size_tolerance and size_lower or size_upper; leave out one of them");
      const bool is_hole = isHoleClass(tolerance.size_class);
      const Zone zone = zoneOf(tolerance, name, is_hole);
      add(index, "size", StudyQuantity::Size, zone.lower_m, zone.upper_m).is_hole = is_hole;
      return;
    }
    if (tolerance.lower_m > tolerance.upper_m) refuse("has a size_lower above its size_upper; exchange them");
    if (tolerance.lower_m == tolerance.upper_m) {
      if (tolerance.lower_m != 0)
        refuse("has a size_lower that equals its size_upper; draw the part with that size");
      return;
    }
    add(index, "size", StudyQuantity::Size, tolerance.lower_m, tolerance.upper_m).is_hole =
        tolerance.size_of == SizeOf::Hole;
  }

  /// Limits of the deviation from the drawn size.
  Zone zoneOf(const PartTolerance& tolerance, const std::string& name, bool is_hole) {
    constexpr double kNominalStep_m = 0.5e-3;
    if (!checked_) {
      CheckSettings settings;
      settings.has_play = false;
      checked_ = checkAssembly(scene_.name, drawnParts(scene_), settings);
    }
    const std::optional<double> drawn_m = drawnSize_m(*checked_, name, is_hole);
    if (!drawn_m)
      throw LoadError(
          scene_.file, name,
          std::string("has size_tolerance '")
              .append(tolerance.size_class)
              .append("' of a ")
              .append(is_hole ? "hole" : "shaft")
              .append(", but vps check finds no such fit of this part; state size_lower and size_upper"));
    const double nominal_m = tolerance.nominal_m > 0 ? tolerance.nominal_m
                                                     : kNominalStep_m * std::round(*drawn_m / kNominalStep_m);
    const std::optional<Zone> zone = isoZone(tolerance.size_class, nominal_m);
    if (!zone)
      throw LoadError(
          scene_.file, name,
          std::string("has size_tolerance '")
              .append(tolerance.size_class)
              .append("', which is not known; letters are d to h, k, m, n, p for shafts and D to H "
                      "for holes, grades 5 to 11, up to 500 mm"));
    return {zone->lower_m + nominal_m - *drawn_m, zone->upper_m + nominal_m - *drawn_m};
  }

  StudyVariable& add(std::size_t part, const char* what, StudyQuantity quantity, double lower, double upper) {
    StudyVariable& variable = out_.emplace_back();
    variable.name = std::string(scene_.parts[part].part.name).append(" ").append(what);
    variable.part = part;
    variable.quantity = quantity;
    variable.distribution = scene_.parts[part].tolerance.distribution;
    variable.lower = lower;
    variable.upper = upper;
    return variable;
  }

  const Scene& scene_;
  std::optional<CheckResult> checked_;
  std::vector<StudyVariable> out_;
};

}  // namespace

std::vector<StudyVariable> studyVariables(const Scene& scene) {
  return Variables(scene).take();
}

}  // namespace vps::scenes
