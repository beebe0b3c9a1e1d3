// SPDX-License-Identifier: BSD-3-Clause
#include "overlaps/drawn_overlaps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vps::scenes {

const char* toText(OverlapKind kind) {
  switch (kind) {
    case OverlapKind::Thread:
      return "thread";
    case OverlapKind::Insert:
      return "insert";
    case OverlapKind::PressFit:
      return "press fit";
    case OverlapKind::Twice:
      return "twice";
    case OverlapKind::Flexible:
      return "flexible";
    case OverlapKind::LineToLine:
      return "line to line";
    case OverlapKind::NoVolume:
      return "no volume";
    case OverlapKind::Clash:
      return "clash";
  }
  return "";
}

namespace {

std::string millimetres(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f mm", 1e3 * m);
  return text;
}

/// Whether all vertices of one part lie on the surface of the other.
bool liesOn(const PlacedSurface& a, const PlacedSurface& b) {
  constexpr double kSame_m = 1e-6;
  const Pose X_BA = b.X_WP.inverse() * a.X_WP;
  return std::ranges::all_of(a.surface->mesh().vertices, [&](const Vec3& p) {
    return std::abs(b.surface->solid().signedDistance(X_BA * p)) < kSame_m;
  });
}

/// Whether two parts are equal and at the same pose, possibly with different triangulations.
bool isDrawnTwice(const PlacedSurface& a, const PlacedSurface& b) {
  constexpr double kSame_m = 1e-6, kSameVolume = 1e-4;
  if ((a.box_W.min - b.box_W.min).norm() > kSame_m || (a.box_W.max - b.box_W.max).norm() > kSame_m)
    return false;
  const double of_a_m3 = massProperties(a.surface->mesh()).volume_m3,
               of_b_m3 = massProperties(b.surface->mesh()).volume_m3;
  return std::abs(of_a_m3 - of_b_m3) <= kSameVolume * std::abs(of_a_m3) && liesOn(a, b) && liesOn(b, a);
}

/// Whether the part is a spring, belt or seal: a curved wire that fills little of its box.
bool isSlender(const PartSurface& part) {
  constexpr double kMostThick = 0.1, kMostFilled = 0.35, kMostFlat = 0.6;  // assumed
  if (!part.noInside().empty()) return false;
  const double volume_m3 = std::abs(massProperties(part.mesh()).volume_m3);
  const Vec3 size_m = part.box().size();
  const double thick_m = 2 * volume_m3 / area(part.mesh());
  if (thick_m > kMostThick * size_m.maxCoeff() || volume_m3 > kMostFilled * size_m.prod()) return false;
  double curved_m2 = 0, all_m2 = 0;
  const auto& neighbours = part.neighbours();
  for (std::uint32_t i = 0; i < neighbours.size(); ++i) {
    const Triangle t = part.triangle(i);
    const double own_m2 = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    all_m2 += own_m2;
    const bool is_bent = std::ranges::any_of(neighbours[i], [&](std::uint32_t k) {
      constexpr double kLeast_rad = 1e-3;
      if (k >= neighbours.size()) return false;
      const Vec3 a = part.normal(i), b = part.normal(k);
      const double turn_rad = std::atan2(a.cross(b).norm(), a.dot(b));
      return turn_rad > kLeast_rad && turn_rad < kCurved_rad;
    });
    if (is_bent) curved_m2 += own_m2;
  }
  return curved_m2 > (1 - kMostFlat) * all_m2 && isWireLike(part.mesh());
}

/// Classifies one overlapping pair.
class Explained {
 public:
  Explained(const CheckedPair& pair, const std::vector<PlacedSurface>& parts, const CheckResult& checked,
            const std::vector<std::optional<FastenerShape>>& shapes, const std::vector<std::size_t>& fixed)
      : pair_(pair), parts_(parts), shapes_(shapes), fixed_(fixed) {
    for (const CheckedFit& fit : checked.fits) {
      const bool is_of_pair =
          (fit.shaft == pair.a && fit.bore == pair.b) || (fit.shaft == pair.b && fit.bore == pair.a);
      if (!is_of_pair || fit.kind != FitKind::Shaft || fit.diametral_clearance_m >= -fit.error_m) continue;
      if (!fit_ || fit.diametral_clearance_m < fit_->diametral_clearance_m) fit_ = fit;
    }
    // An overlap deeper than the fit's interference belongs to other faces.
    constexpr double kSlack = 1.1;
    if (fit_ && pair.interference_depth_m - pair.error_m > kSlack * 0.5 * interference_m() + 1e-6)
      fit_.reset();
  }

  [[nodiscard]] OverlapChoice choice() const {
    OverlapChoice out;
    out.a = pair_.a;
    out.b = pair_.b;
    const std::size_t a = indexOf(pair_.a), b = indexOf(pair_.b);
    if (isDrawnTwice(parts_[a], parts_[b])) {
      out.kind = OverlapKind::Twice;
      out.left_out = isFixed(b) && !isFixed(a) ? pair_.a : pair_.b;
      out.words = "'" + pair_.a + "' and '" + pair_.b +
                  "' are equal and at the same pose, probably one part drawn twice; '" + out.left_out +
                  "' becomes scenery";
      return out;
    }
    if (pair_.isKnown()) return known(std::move(out));
    if (fit_ && isPressFit()) {
      out.kind = OverlapKind::PressFit;
      out.changed = fit_->shaft;
      out.press_fit_m = std::ceil((interference_m() + fit_->error_m) * 1e6) * 1e-6;
      out.words = "'" + fit_->shaft + "' is " + millimetres(interference_m()) + " larger than its bore in '" +
                  fit_->bore + "': assumed to be a press fit, and declared as press_fit";
      return out;
    }
    for (const auto& [flexible, other] : {std::pair(a, b), std::pair(b, a)})
      if (!fit_ && !isFixed(flexible) && isSlender(*parts_[flexible].surface) &&
          !isSlender(*parts_[other].surface)) {
        out.kind = OverlapKind::Flexible;
        out.left_out = parts_[flexible].name;
        out.words = "'" + out.left_out + "' overlaps '" + parts_[other].name + "' by " +
                    millimetres(pair_.interference_depth_m) +
                    " and is slender and curved: assumed to be a spring, belt or seal drawn undeformed; it "
                    "becomes scenery";
        return out;
      }
    out.words = "'" + pair_.a + "' and '" + pair_.b + "' overlap by " +
                millimetres(pair_.interference_depth_m) +
                " as drawn; on their paths they may overlap by the same depth";
    return out;
  }

 private:
  [[nodiscard]] bool isFixed(std::size_t part) const { return std::ranges::binary_search(fixed_, part); }
  [[nodiscard]] double interference_m() const { return -fit_->diametral_clearance_m; }
  [[nodiscard]] std::size_t indexOf(const std::string& name) const {
    return static_cast<std::size_t>(std::ranges::find(parts_, name, &PlacedSurface::name) - parts_.begin());
  }
  [[nodiscard]] const std::optional<FastenerShape>& shapeOf(const std::string& name) const {
    return shapes_[indexOf(name)];
  }

  /// Assumed: a press fit is no tighter than H7/u6 of ISO 286, whose interference is about 0.1 % of the
  /// diameter plus 40 um.
  [[nodiscard]] bool isPressFit() const { return interference_m() < 1e-3 * fit_->shaft_m + 40e-6; }

  /// The choice for a thread, seal or insert, which the check has recognised.
  [[nodiscard]] OverlapChoice known(OverlapChoice out) const {
    out.kind = pair_.state == PairState::Seal     ? OverlapKind::Flexible
               : pair_.state == PairState::Insert ? OverlapKind::Insert
                                                  : OverlapKind::Thread;
    out.words = "'" + pair_.a + "' and '" + pair_.b + "': " + pair_.explanation;
    if (pair_.state == PairState::Seal) {
      if (isFixed(indexOf(pair_.fastener))) return out;
      out.left_out = pair_.fastener;
      out.words += "; '" + out.left_out + "' becomes scenery";
      return out;
    }
    return fit_ ? resized(std::move(out)) : out;
  }

  /// Makes room along the fit: a nut's hole wider, or the shaft thinner.
  [[nodiscard]] OverlapChoice resized(OverlapChoice out) const {
    const auto& nut = shapeOf(fit_->bore);
    const bool is_hole = nut && nut->kind == FastenerKind::Nut;
    const std::string& name = is_hole ? fit_->bore : fit_->shaft;
    const auto& shape = shapeOf(name);
    const double to_m = is_hole ? 0.5 * fit_->shaft_m + kPassingRoom_m : 0.5 * fit_->bore_m - kPassingRoom_m;
    if (is_hole || (shape && shape->kind != FastenerKind::Washer && shape->kind != FastenerKind::Nut))
      out.resized = Resized{shape->axis, shape->p, shape->from_m, shape->to_m, shape->radius_m, to_m};
    else
      out.resized = thinnerShaft(parts_[indexOf(name)], *fit_, to_m);
    if (!out.resized) return out;
    out.changed = name;
    out.words += "; " + std::string(is_hole ? "the hole of '" : "the shank of '") + name + "' is made " +
                 millimetres(2 * to_m) + " wide so that it can pass";
    return out;
  }

  const CheckedPair& pair_;
  const std::vector<PlacedSurface>& parts_;
  const std::vector<std::optional<FastenerShape>>& shapes_;
  const std::vector<std::size_t>& fixed_;
  std::optional<CheckedFit> fit_;
};

}  // namespace

std::vector<OverlapChoice> overlapChoices(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                                          const std::vector<std::optional<FastenerShape>>& shapes,
                                          const std::vector<std::size_t>& fixed) {
  std::vector<OverlapChoice> out;
  const auto isLeftOut = [&](const std::string& name) {
    return std::ranges::find(out, name, &OverlapChoice::left_out) != out.end();
  };
  for (const CheckedPair& pair : checked.pairs)
    if ((pair.isClash() || pair.isKnown()) && !isLeftOut(pair.a) && !isLeftOut(pair.b))
      out.push_back(Explained(pair, parts, checked, shapes, fixed).choice());
  return out;
}

std::vector<OverlapChoice> noVolumeChoices(const std::vector<PlacedSurface>& parts,
                                           const std::vector<std::size_t>& fixed) {
  const auto isBody = [](const PlacedSurface& part) {
    constexpr double kThinnest_m = 1e-6;  // the accuracy with which import tessellates curved faces
    const Mesh& mesh = part.surface->mesh();
    return part.surface->solid().report().sheet_facets < mesh.triangles.size() &&
           2 * std::abs(massProperties(mesh).volume_m3) > kThinnest_m * area(mesh);
  };
  std::vector<OverlapChoice> out;
  if (std::ranges::none_of(parts, isBody)) return out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (isBody(parts[i]) || std::ranges::binary_search(fixed, i)) continue;
    OverlapChoice choice;
    choice.a = choice.left_out = parts[i].name;
    choice.kind = OverlapKind::NoVolume;
    choice.words =
        "'" + parts[i].name + "' has no volume, so that a hand cannot carry it: it becomes scenery";
    out.push_back(std::move(choice));
  }
  return out;
}

std::vector<std::size_t> leftOut(const std::vector<PlacedSurface>& parts,
                                 const std::vector<OverlapChoice>& choices) {
  std::vector<std::size_t> out;
  for (const OverlapChoice& choice : choices) {
    if (choice.left_out.empty()) continue;
    out.push_back(static_cast<std::size_t>(std::ranges::find(parts, choice.left_out, &PlacedSurface::name) -
                                           parts.begin()));
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace vps::scenes
