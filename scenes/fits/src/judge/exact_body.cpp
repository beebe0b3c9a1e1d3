// SPDX-License-Identifier: BSD-3-Clause
#include "judge/exact_body.h"

#include <algorithm>
#include <utility>

namespace vps::scenes {

namespace {

/// A gap is a lower bound of at least this share of the true distance: boxes that could shorten the gap only
/// by less are not opened.
constexpr double kShare = 0.8;

double highestOf(const Box& box, const Vec3& n) {
  return box.center().dot(n) + 0.5 * box.size().dot(n.cwiseAbs());
}

struct Gap {
  double distance_m;
  Vec3 n_A = Vec3::Zero();
  std::size_t boxes = 0;
};

Gap gapOf(const ExactBody& a, const ExactBody& b, const Pose& X_AB, double near_m) {
  Gap best{near_m};
  visitPairs(
      a.tree(), b.tree(),
      [&](const Box& box) {
        ++best.boxes;
        return moved(box, X_AB);
      },
      [](const Box& of_a, const Box& of_b) { return distance2(of_a, of_b); },
      [&] {
        const double least_m = kShare * best.distance_m;
        return best.distance_m <= kOverlapCertain_m ? -1 : least_m * least_m;
      },
      [&](std::uint32_t i, std::uint32_t k) {
        const Triangle of_b = b.triangle(k);
        const TriangleGap gap = triangleGap(a.triangle(i), {X_AB * of_b[0], X_AB * of_b[1], X_AB * of_b[2]});
        if (gap.distance_m >= best.distance_m) return;
        best.distance_m = gap.distance_m;
        best.n_A = gap.distance_m > 0 ? Vec3((gap.p_b - gap.p_a).normalized()) : Vec3(Vec3::Zero());
      });
  best.distance_m = best.distance_m <= kOverlapCertain_m ? 0 : kShare * best.distance_m;
  return best;
}

}  // namespace

ExactBody::ExactBody(std::shared_ptr<const Solid> solid)
    : overlap_(std::move(solid)), tree_(triangleBoxes(overlap_.mesh()), 2) {}

double ExactBody::highest_m(const Vec3& n) const {
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  double highest_m = -1e300;
  std::uint32_t stack[128];  // nodes are halved by count: at most 32 levels, with one waiting child each
  int waiting = 0;
  if (!nodes.empty()) stack[waiting++] = 0;
  while (waiting > 0) {
    const std::uint32_t index = stack[--waiting];
    const BoxTree::Node& node = nodes[index];
    if (highestOf(node.box, n) <= highest_m) continue;
    if (node.isLeaf()) {
      for (std::uint32_t i = node.first; i < node.end; ++i)
        for (const std::uint32_t v : mesh().triangles[tree_.order()[i]])
          highest_m = std::max(highest_m, n.dot(mesh().vertices[v]));
      continue;
    }
    const bool is_left_higher = highestOf(nodes[index + 1].box, n) > highestOf(nodes[node.right].box, n);
    stack[waiting++] = is_left_higher ? node.right : index + 1;
    stack[waiting++] = is_left_higher ? index + 1 : node.right;
  }
  return highest_m;
}

PairMeasure measurePair(const ExactBody& a, const Pose& X_WA, const ExactBody& b, const Pose& X_WB,
                        double near_m) {
  const Overlap found = deepestOverlap(a.overlap(), X_WA, b.overlap(), X_WB, true);
  PairMeasure measure{found.depth_m, found.p_W, Vec3::Zero(), 1 + found.work};
  if (found.depth_m > 0) return measure;
  const Gap gap = gapOf(a, b, X_WA.inverse() * X_WB, near_m);
  measure.depth_m = -gap.distance_m;
  measure.n_W = X_WA.R * gap.n_A;
  measure.work += gap.boxes / kBoxesPerWork;
  return measure;
}

}  // namespace vps::scenes
