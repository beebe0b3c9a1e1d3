// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_piece.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes {

Vec3 middleOf(const SurfacePiece& piece) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : piece) sum += p;
  return sum / static_cast<double>(piece.size());
}

double reachFrom(const Vec3& p, const SurfacePiece& piece) {
  double most_m2 = 0;
  for (const Vec3& corner : piece) most_m2 = std::max(most_m2, (corner - p).squaredNorm());
  return std::sqrt(most_m2);
}

SurfacePiece placed(const SurfacePiece& piece, const Pose& X) {
  SurfacePiece out = piece;
  for (Vec3& p : out) p = X * p;
  return out;
}

SurfacePiece shifted(const SurfacePiece& piece, const Vec3& by) {
  SurfacePiece out = piece;
  for (Vec3& p : out) p += by;
  return out;
}

SurfacePiece below(const SurfacePiece& piece, const Vec3& n, double level) {
  SurfacePiece kept;
  // A segment has one side; a polygon has as many sides as corners.
  const std::size_t sides = piece.size() > 2 ? piece.size() : piece.size() - 1;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec3 &a = piece[i], &b = piece[(i + 1) % piece.size()];
    const double over_a = n.dot(a) - level, over_b = n.dot(b) - level;
    if (over_a <= 0) kept.push_back(a);
    if (i < sides && (over_a <= 0) != (over_b <= 0) && over_a != 0)
      kept.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  return kept;
}

std::pair<double, double> sharesWithin(std::span<const Vec3> polygon, const Vec3& n, const Vec3& p,
                                       const Vec3& q) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3 inward = n.cross(polygon[(i + 1) % polygon.size()] - a);
    const double at_p = inward.dot(p - a), at_q = inward.dot(q - a);
    if (at_p < 0 && at_q < 0) return {1, 0};
    if ((at_p < 0) == (at_q < 0)) continue;
    const double fraction = at_p / (at_p - at_q);
    if (at_p < 0)
      from = std::max(from, fraction);
    else
      to = std::min(to, fraction);
  }
  return {from, to};
}

namespace {

/// A polygon with quick tests whether a box or a facet can meet it.
class PieceTest {
 public:
  PieceTest(const SurfacePiece& piece, const Vec3& n) : piece_(piece), n_(n), level_(n.dot(piece[0])) {
    for (const Vec3& p : piece) box_.add(p);
  }

  [[nodiscard]] bool mayMeet(const Box& box) const {
    if (distance2(box, box_) > 0) return false;
    return std::abs(n_.dot(box.center()) - level_) <= 0.5 * n_.cwiseAbs().dot(box.size());
  }

  [[nodiscard]] bool meets(const Triangle& t) const {
    std::array<double, 3> above_m{};
    for (std::size_t i = 0; i < 3; ++i) above_m[i] = n_.dot(t[i]) - level_;
    if (std::ranges::all_of(above_m, [](double m) { return m == 0; })) return true;
    std::array<Vec3, 2> ends;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
      const std::size_t k = (i + 1) % 3;
      if ((above_m[i] > 0) != (above_m[k] > 0))
        ends[count++] = t[i] + above_m[i] / (above_m[i] - above_m[k]) * (t[k] - t[i]);
    }
    if (count < 2) return false;
    const auto [from, to] = sharesWithin(piece_, n_, ends[0], ends[1]);
    return from <= to;
  }

 private:
  const SurfacePiece& piece_;
  const Vec3& n_;
  double level_;
  Box box_;
};

bool meetsAny(const PieceTest& test, const PartSurface& surface, std::size_t& work) {
  const std::vector<BoxTree::Node>& nodes = surface.tree().nodes();
  for (std::size_t n = 0; n < nodes.size();) {
    const BoxTree::Node& node = nodes[n];
    ++work;
    const bool may_meet = test.mayMeet(node.box);
    n = may_meet ? n + 1 : node.skip;
    if (!may_meet || !node.isLeaf()) continue;
    for (std::uint32_t i = node.first; i < node.end; ++i, ++work)
      if (test.meets(surface.triangle(surface.tree().order()[i]))) return true;
  }
  return false;
}

}  // namespace

bool isOutside(const SurfacePiece& piece, const Vec3& n, const PartSurface& surface, std::size_t& work) {
  if (surface.solid().isInside(piece[0])) return false;
  if (piece.size() == 1) return true;
  if (piece.size() > 2) return !meetsAny(PieceTest(piece, n), surface, work);
  std::vector<double> crossings;
  surface.solid().appendCrossings(piece[0], piece[1], crossings);
  return crossings.empty();
}

}  // namespace vps::scenes
