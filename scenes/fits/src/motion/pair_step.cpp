// SPDX-License-Identifier: BSD-3-Clause
#include "motion/pair_step.h"

namespace vps::scenes {

namespace {

constexpr double kPairStepForever = std::numeric_limits<double>::infinity();
/// Distance below which the direction between nearest points is not reliable, because of rounding.
constexpr double kDirection_m = 1e-9;

double lowest(const Vec3& n, const Triangle& t) {
  return std::min({n.dot(t[0]), n.dot(t[1]), n.dot(t[2])});
}
double highest(const Vec3& n, const Triangle& t) {
  return std::max({n.dot(t[0]), n.dot(t[1]), n.dot(t[2])});
}

/// Two triangles in the frame of the held part.
class Step {
 public:
  Step(const MovingPair& pair, std::uint32_t moving, std::uint32_t held)
      : pair_(pair), moving_(moving), held_(held), b_(pair.held.triangle(held)) {
    const Triangle of = pair.moving.triangle(moving);
    for (int i = 0; i < 3; ++i) a_[i] = pair.X_HM * of[i];
  }

  double longest() {
    tryHeld(pair_.held.normal(held_), -pair_.rest_m);
    tryMoving(pair_.X_HM.R * pair_.moving.normal(moving_), -pair_.rest_m);
    if (best_ == kPairStepForever) return best_;
    if (!pair_.motion.is_turn && passesBeside()) return best_ = kPairStepForever;
    gap_ = triangleGap(a_, b_);
    const Vec3 between = gap_.p_a - gap_.p_b;
    if (gap_.distance_m > 2 * pair_.rest_m) {
      tryHeld(between / gap_.distance_m, 0);
      return best_;
    }
    tryFeatures();
    if (best_ <= 0) tryCorners();
    if (best_ <= 0 && gap_.distance_m > kDirection_m && isOutside()) tryHeld(between / gap_.distance_m, 0);
    return best_;
  }

  double closing() {
    gap_ = triangleGap(a_, b_);
    const Vec3 v = pair_.motion.velocity(gap_.p_a);
    return std::max(-v.dot(pair_.held.normal(held_)), v.dot(pair_.X_HM.R * pair_.moving.normal(moving_)));
  }

  double contactRate() {
    gap_ = triangleGap(a_, b_);
    const Vec3 v = pair_.motion.velocity(gap_.p_a);
    const double of_held = std::max(0.0, -v.dot(pair_.held.normal(held_))),
                 of_moving = std::max(0.0, v.dot(pair_.X_HM.R * pair_.moving.normal(moving_)));
    if (gap_.distance_m > kDirection_m) {  // below this distance, rounding decides on the feature
      if (gap_.feature_b == 0) return of_held;
      if (gap_.feature_a == 0) return of_moving;
      if (const Vec3 n = acrossEdges(); !n.isZero(0)) return std::abs(n.dot(v));
    }
    if (of_held == 0 || of_moving == 0) return std::max(of_held, of_moving);
    return std::min(of_held, of_moving);
  }

  double depth() {
    gap_ = triangleGap(a_, b_);
    if (gap_.distance_m > 0) return 0;
    double least_m = kPairStepForever;
    const auto keep = [&](const Vec3& n) { least_m = std::min(least_m, highest(n, b_) - lowest(n, a_)); };
    keep(pair_.held.normal(held_));
    keep(-(pair_.X_HM.R * pair_.moving.normal(moving_)));
    forEachFeatureNormal([&](const Vec3& n) { keep(n); }, [&](const Vec3& n) { keep(-n); });
    return std::max(0.0, least_m);
  }

 private:
  /// Tries a plane of the held part, with the moving triangle above it.
  void tryHeld(const Vec3& n, double least_m) {
    const double above_m = highest(n, b_) + least_m;
    if (lowest(n, a_) < above_m) return;
    double s = kPairStepForever;
    for (const Vec3& p : a_) s = std::min(s, pair_.motion.staysAbove(n, p, above_m));
    best_ = std::max(best_, s);
  }
  /// Tries a plane of the moving part, with the held triangle above it.
  void tryMoving(const Vec3& n, double least_m) {
    const double above_m = highest(n, a_) + least_m;
    if (lowest(n, b_) < above_m) return;
    const Motion motion = pair_.motion.reversed();
    double s = kPairStepForever;
    for (const Vec3& p : b_) s = std::min(s, motion.staysAbove(n, p, above_m));
    best_ = std::max(best_, s);
  }

  /// Whether a plane along a straight motion separates the triangles, so that they never meet. The plane
  /// contains an edge of one triangle, or is perpendicular to an outward normal (with the rest depth). Such
  /// planes are needed for flush curved faces: their facets cross by the chord error wherever they slide
  /// along each other, and the planes of slivers among them are tilted at random.
  [[nodiscard]] bool passesBeside() const {
    const Vec3& d = pair_.motion.direction;
    for (const Triangle* of : {&a_, &b_})
      for (int i = 0; i < 3; ++i) {
        const Vec3 n = d.cross((*of)[(i + 1) % 3] - (*of)[i]);
        if (lowest(n, a_) >= highest(n, b_) || lowest(n, b_) >= highest(n, a_)) return true;
      }
    return isAnyCornerNormal(pair_.held, held_,
                             [&](const Vec3& n) {
                               const std::optional<Vec3> beside = besideMotion(n, d);
                               return beside && lowest(*beside, a_) >= highest(*beside, b_) - pair_.rest_m;
                             }) ||
           isAnyCornerNormal(pair_.moving, moving_, [&](const Vec3& n) {
             const std::optional<Vec3> beside = besideMotion(pair_.X_HM.R * n, d);
             return beside && lowest(*beside, b_) >= highest(*beside, a_) - pair_.rest_m;
           });
  }
  template <class Is>
  static bool isAnyCornerNormal(const PartSurface& of, std::uint32_t triangle, Is is) {
    return std::ranges::any_of(of.mesh().triangles[triangle],
                               [&](std::uint32_t v) { return std::ranges::any_of(of.normalsAround(v), is); });
  }

  /// Visits the outward normals around the nearest features of both triangles, in the frame of the held part.
  template <class OfHeld, class OfMoving>
  void forEachFeatureNormal(OfHeld ofHeld, OfMoving ofMoving) const {
    forEachNormal(pair_.held, held_, gap_.feature_b, ofHeld);
    forEachNormal(pair_.moving, moving_, gap_.feature_a, [&](const Vec3& n) { ofMoving(pair_.X_HM.R * n); });
  }
  template <class Visit>
  static void forEachNormal(const PartSurface& of, std::uint32_t triangle, int feature, Visit visit) {
    if (feature == 0) return;  // the normal of the facet itself was tried before
    visit(of.solid().featureNormal(triangle, feature));
    if (feature > 3) {
      for (const Vec3& n : of.normalsAround(of.mesh().triangles[triangle][feature - 4])) visit(n);
      return;
    }
    const std::uint32_t other = of.neighbours()[triangle][feature - 1];
    if (other != kNoFacet) visit(of.normal(other));
  }

  void tryFeatures() {
    forEachFeatureNormal([&](const Vec3& n) { tryHeld(n, -pair_.rest_m); },
                         [&](const Vec3& n) { tryMoving(n, -pair_.rest_m); });
    Vec3 n = acrossEdges();
    if (n.isZero(0)) return;
    const Vec3 out_b = pair_.held.solid().featureNormal(held_, gap_.feature_b),
               out_a = pair_.X_HM.R * pair_.moving.solid().featureNormal(moving_, gap_.feature_a);
    if (n.dot(out_b) < 0) n = -n;
    if (n.dot(out_a) < 0) tryHeld(n, -pair_.rest_m);
  }

  /// The common perpendicular of the two nearest edges, unit. Zero if the nearest features are not two edges,
  /// or if the edges are parallel.
  [[nodiscard]] Vec3 acrossEdges() const {
    const auto isEdge = [](int feature) { return feature >= 1 && feature <= 3; };
    if (!isEdge(gap_.feature_a) || !isEdge(gap_.feature_b)) return Vec3::Zero();
    const int i = gap_.feature_a - 1, k = gap_.feature_b - 1;
    const Vec3 n = (a_[(i + 1) % 3] - a_[i]).cross(b_[(k + 1) % 3] - b_[k]);
    const double length = n.norm();
    if (!(length > 1e-9 * (a_[(i + 1) % 3] - a_[i]).norm() * (b_[(k + 1) % 3] - b_[k]).norm()))
      return Vec3::Zero();
    return n / length;
  }

  /// Tries the planes around all corners, for triangles that touch along a line and have many nearest points.
  void tryCorners() {
    for (const std::uint32_t v : pair_.held.mesh().triangles[held_])
      for (const Vec3& n : pair_.held.normalsAround(v)) tryHeld(n, -pair_.rest_m);
    for (const std::uint32_t v : pair_.moving.mesh().triangles[moving_])
      for (const Vec3& n : pair_.moving.normalsAround(v)) tryMoving(pair_.X_HM.R * n, -pair_.rest_m);
  }

  /// Whether the nearest points are outside the other part and one of the facets faces the other triangle.
  /// The nearest points of flush faces lie on side walls, where rounding decides between inside and outside.
  [[nodiscard]] bool isOutside() const {
    const Vec3 between = gap_.p_a - gap_.p_b;
    const bool is_faced = between.dot(pair_.held.normal(held_)) > 0 ||
                          between.dot(pair_.X_HM.R * pair_.moving.normal(moving_)) < 0;
    return is_faced && !pair_.held.solid().isInside(gap_.p_a) &&
           !pair_.moving.solid().isInside(pair_.X_HM.inverse() * gap_.p_b);
  }

  const MovingPair& pair_;
  std::uint32_t moving_, held_;
  Triangle a_, b_;
  TriangleGap gap_;
  double best_ = 0;
};

}  // namespace

double safeStep(const MovingPair& pair, std::uint32_t moving, std::uint32_t held) {
  return Step(pair, moving, held).longest();
}

double closingSpeed(const MovingPair& pair, std::uint32_t moving, std::uint32_t held) {
  return Step(pair, moving, held).closing();
}

double contactRate(const MovingPair& pair, std::uint32_t moving, std::uint32_t held) {
  return Step(pair, moving, held).contactRate();
}

double crossingDepth(const MovingPair& pair, std::uint32_t moving, std::uint32_t held) {
  return Step(pair, moving, held).depth();
}

}  // namespace vps::scenes
