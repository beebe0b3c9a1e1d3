// SPDX-License-Identifier: BSD-3-Clause
#include "motion/motion_search.h"

#include "motion/pair_step.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr double kMotionSearchForever = std::numeric_limits<double>::infinity();
/// A smaller step than this ends the motion: a tenth of the rest depth.
constexpr double kLeastStep_m = 0.1 * MotionSearch::kRest_m;
constexpr int kMostSteps = 400;
/// Limit of the steps of a rotation. A whole turn in a bore of n facets takes about 2 n steps, and more where
/// the clearance is near the facets' chord error.
constexpr int kMostStepsOfTurn = 4000;
/// Length of the first piece of a motion; each later piece is four times as long. With short first pieces,
/// only near facets are examined where a contact is near.
constexpr double kFirstStep_m = 0.1e-3;

/// The greatest depth to which the facets of a pair penetrate each other as drawn, up to crossing_m, plus
/// kRest_m.
double restOf(const PlacedSurface& part, const PlacedSurface& held, const Pose& X_HM, double crossing_m) {
  const MovingPair pair{*part.surface, *held.surface, X_HM, {}, MotionSearch::kRest_m};
  double needed_m = 0;
  visitPairs(
      held.surface->tree(), part.surface->tree(), [&](const Box& box) { return moved(box, X_HM); }, distance2,
      [] { return std::numeric_limits<double>::min(); },
      [&](std::uint32_t k, std::uint32_t i) { needed_m = std::max(needed_m, crossingDepth(pair, i, k)); });
  return MotionSearch::kRest_m + std::min(needed_m, crossing_m);
}

/// The distance after which a box that moves along d reaches another box; infinite if the moving box passes
/// by.
double entry(const Box& moving, const Box& held, const Vec3& d) {
  double first = 0, last = kMotionSearchForever;
  for (int axis = 0; axis < 3; ++axis) {
    const double before = held.min[axis] - moving.max[axis], behind = held.max[axis] - moving.min[axis];
    if (d[axis] == 0) {
      if (before > 0 || behind < 0) return kMotionSearchForever;
      continue;
    }
    const double from = (d[axis] > 0 ? before : behind) / d[axis],
                 to = (d[axis] > 0 ? behind : before) / d[axis];
    first = std::max(first, from);
    last = std::min(last, to);
  }
  return first <= last ? first : kMotionSearchForever;
}

std::array<Vec3, 8> cornersOf(const Box& box) {
  std::array<Vec3, 8> out;
  for (int i = 0; i < 8; ++i)
    out[static_cast<std::size_t>(i)] =
        Vec3((i & 1) != 0 ? box.max.x() : box.min.x(), (i & 2) != 0 ? box.max.y() : box.min.y(),
             (i & 4) != 0 ? box.max.z() : box.min.z());
  return out;
}

double greatestSpeed(const Motion& motion, const Box& box) {
  double most = 0;
  for (const Vec3& corner : cornersOf(box)) most = std::max(most, motion.velocity(corner).norm());
  return most;
}

/// The parameter up to which a moving box stays above a plane; 0 if it is not above the plane at the start.
double staysAbove(const Motion& motion, const Box& box, const Vec3& n, double least_m) {
  const double lowest_m = n.dot(box.center()) - 0.5 * n.cwiseAbs().dot(box.size());
  if (lowest_m < least_m) return 0;
  double s = kMotionSearchForever;
  for (const Vec3& corner : cornersOf(box)) s = std::min(s, motion.staysAbove(n, corner, least_m));
  return s;
}

/// Whether two nodes of the trees pass each other on a straight motion. A patch in one of the nodes provides
/// the separating plane, as besideMotion() does for two facets.
bool passBeside(const PartSurface& held, std::uint32_t k, const PartSurface& moving, std::uint32_t i,
                const Pose& X_HM, const Vec3& d_H, double rest_m) {
  const auto facets = [](const PartSurface& of, std::uint32_t node) {
    return of.tree().nodes()[node].end - of.tree().nodes()[node].first;
  };
  constexpr std::uint32_t kFewPairs = 4;  // up to so many pairs of facets are tested faster one by one
  const std::uint32_t of_held = facets(held, k), of_moving = facets(moving, i);
  if (std::max(of_held, of_moving) > PartSurface::kFacetsOfPatch || of_held * of_moving <= kFewPairs)
    return false;
  const auto isParted = [&](const Vec3& n_H) {  // held part below the plane, moving part above the plane
    const Vec3 n_M = X_HM.R.transpose() * n_H;
    return n_H.dot(X_HM.p) - moving.highest_m(i, -n_M) >= held.highest_m(k, n_H) - rest_m;
  };
  if (const Vec3& n = held.patches()[k]; n != Vec3::Zero())
    if (const std::optional<Vec3> beside = besideMotion(n, d_H); beside && isParted(*beside)) return true;
  const Vec3& n = moving.patches()[i];
  if (n == Vec3::Zero()) return false;
  const std::optional<Vec3> beside = besideMotion(X_HM.R * n, d_H);
  return beside && isParted(-*beside);
}

Box boxOf(const Triangle& t) {
  Box box;
  for (const Vec3& p : t) box.add(p);
  return box;
}

}  // namespace

PassingFacets::PassingFacets(std::size_t of_held, bool of_moving, std::vector<std::uint8_t> of_facets,
                             const BoxTree& tree)
    : held(of_held), is_of_moving(of_moving), facets(std::move(of_facets)), nodes(tree.nodes().size(), 1) {
  for (std::size_t n = nodes.size(); n-- > 0;) {  // child nodes follow their parents
    const BoxTree::Node& node = tree.nodes()[n];
    if (!node.isLeaf()) {
      nodes[n] = nodes[n + 1] & nodes[node.right];
      continue;
    }
    for (std::uint32_t i = node.first; i < node.end; ++i) nodes[n] &= facets[tree.order()[i]];
  }
}

StandingParts::StandingParts(std::vector<const PlacedSurface*> of_parts)
    : parts(std::move(of_parts)), boxes([this] {
        std::vector<Box> all;
        for (const PlacedSurface* part : parts) all.push_back(part->box_W);
        return all;
      }()) {}

MotionSearch::MotionSearch(const PlacedSurface& part, std::shared_ptr<const StandingParts> held,
                           const std::vector<double>& crossing_m, CrossingDepth depth)
    : part_(part), held_(std::move(held)), rest_m_(held_->parts.size(), kRest_m) {
  for (std::size_t i = 0; i < rest_m_.size(); ++i) {
    if (crossing_m[i] == 0) continue;
    rest_m_[i] = depth == CrossingDepth::UpToMost
                     ? kRest_m + crossing_m[i]
                     : restOf(part, *held_->parts[i], heldAt(i).X_HM, crossing_m[i]);
    most_rest_m_ = std::max(most_rest_m_, rest_m_[i]);
  }
}

MotionSearch::Held MotionSearch::heldAt(std::size_t index) const {
  const PlacedSurface* held = held_->parts[index];
  return {held, held->X_WP.inverse() * part_.X_WP, rest_m_[index]};
}

std::size_t MotionSearch::indexOf(const std::string& held) const {
  return static_cast<std::size_t>(
      std::ranges::find(held_->parts, held, [](const PlacedSurface* part) { return part->name; }) -
      held_->parts.begin());
}

double MotionSearch::rest_m() const {
  return most_rest_m_;
}

MotionSearch::AroundAxis::AroundAxis(const PlacedSurface& part, const Motion& motion_W)
    : extents(*part.surface, part.X_WP.R.transpose() * motion_W.direction,
              part.X_WP.inverse() * motion_W.center),
      sectors(*part.surface, motion_W.in(part.X_WP.inverse()),
              part.X_WP.R.transpose() * motion_W.direction.unitOrthogonal(), extents) {}

std::optional<MotionSearch::Turning> MotionSearch::turningOf(const Motion& motion) const {
  if (!motion.is_turn) return std::nullopt;
  return Turning{motion.direction, AroundAxis(part_, motion)};
}

double MotionSearch::farthestFrom(const Motion& turn, double most) const {
  return (part_.box_W.min - turn.center)
             .cwiseAbs()
             .cwiseMax((part_.box_W.max - turn.center).cwiseAbs())
             .norm() +
         std::abs(most * turn.forward_m);
}

std::vector<MotionSearch::Near> MotionSearch::nearOf(const Motion& motion, double most) const {
  const double farthest_m = motion.is_turn ? farthestFrom(motion, most) : 0;
  const Box center{motion.center, motion.center};
  const auto isNear = [&](const Box& box_W, double rest_m) {
    return motion.is_turn ? distance2(center, box_W) <= farthest_m * farthest_m + rest_m
                          : entry(grown(part_.box_W, 2 * rest_m), box_W, motion.direction) <= most;
  };
  std::vector<std::size_t> found;
  held_->boxes.forEach([&](const Box& node_W) { return isNear(node_W, most_rest_m_); },
                       [&](std::uint32_t h) {
                         const PlacedSurface* part = held_->parts[h];
                         if (part != &part_ && isNear(part->box_W, rest_m_[h])) found.push_back(h);
                       });
  std::ranges::sort(found);
  std::vector<Near> near;
  for (const std::size_t h : found) {
    near.push_back({h, heldAt(h), std::nullopt});
    if (!motion.is_turn) continue;
    near.back().turning.emplace(*near.back().held.part, motion);
  }
  return near;
}

double MotionSearch::pairStops(const MovingPair& pair, std::uint32_t moving, std::uint32_t held,
                               const Piece& piece, const std::array<double, 2>& range, SearchWork* work,
                               bool& is_given_up) {
  const int most_steps =
      piece.motion_H.is_turn && piece.motion_H.forward_m == 0 ? kMostStepsOfTurn : kMostSteps;
  const double most = range[1];
  MovingPair there = pair;
  double s = range[0];
  for (int i = 0; i < most_steps && s < most; ++i) {
    pollStop();
    if (s > 0) there.X_HM = piece.motion_H.at(s) * piece.X_HM;
    if (i > 0 && work != nullptr && ++work->done >= work->most) return s;
    const double safe = safeStep(there, moving, held);
    if (safe < std::min(piece.least, most - s)) return s;
    s += safe;
  }
  is_given_up = s < most;
  return s;
}

double MotionSearch::step(const Near& near, const std::optional<Turning>& turning, const Piece& piece,
                          const PassingFacets* passing, SearchWork* work, Reach& reach) const {
  // Structured bindings are not used, because clang 14 does not let a lambda capture a structured binding.
  const Motion& motion_H = piece.motion_H;
  const Pose& X_HM = piece.X_HM;
  const double most = piece.most;
  const std::array<double, 2>& along_m = piece.along_m;
  const Held& held = near.held;
  const PartSurface &moving = *part_.surface, &fixed = *held.part->surface;
  const MovingPair pair{moving, fixed, X_HM, motion_H, held.rest_m};
  const double near_m = 2 * held.rest_m;
  // The parameter at which two boxes can come within the rest depth of each other.
  const auto reaches = [&](const Box& of_moving, const Box& of_held, double radius_m) {
    const Box wide = grown(of_moving, near_m);
    if (!motion_H.is_turn) return entry(wide, of_held, motion_H.direction);
    return std::sqrt(distance2(wide, of_held)) / std::max(std::hypot(radius_m, motion_H.forward_m), 1e-300);
  };
  // The part of the piece during which two nodes or facets can come near, by their angles about the axis.
  const auto timeOf = [&](const std::vector<AxisExtent> AxisExtents::*extents,
                          const std::vector<ScrewSector> ScrewSectors::*sectors, std::uint32_t k,
                          std::uint32_t i) {
    if (!turning) return MeetingTime{};
    const AroundAxis &of_moving = turning->moving, &of_held = *near.turning;
    const AxisExtent &a = (of_moving.extents.*extents)[i], &b = (of_held.extents.*extents)[k];
    if (!a.reaches(b, near_m, along_m)) return MeetingTime{1, 0};
    return meetingTime((of_moving.sectors.*sectors)[i], (of_held.sectors.*sectors)[k], motion_H.forward_m,
                       piece.turned, near_m, std::max(a.nearest_m, b.nearest_m));
  };
  double best = most;
  if (passing != nullptr && passing->held != near.index) passing = nullptr;
  const auto passes = [&](const std::vector<std::uint8_t> PassingFacets::*what, std::uint32_t k,
                          std::uint32_t i) {
    return passing != nullptr && (passing->*what)[passing->is_of_moving ? i : k] != 0;
  };
  const auto visit = [&](std::uint32_t k, std::uint32_t i) {
    if (passes(&PassingFacets::facets, k, i)) return;
    const MeetingTime time = timeOf(&AxisExtents::triangles, &ScrewSectors::triangles, k, i);
    const double last = std::min(best, time.to_rad);
    if (time.isNever() || time.from_rad >= last) return;
    Triangle t = moving.triangle(i);
    for (Vec3& p : t) p = X_HM * p;
    const double radius_m = turning ? turning->moving.extents.triangles[i].farthest_m : 0;
    if (!(reaches(boxOf(t), boxOf(fixed.triangle(k)), radius_m) < best)) return;
    bool is_given_up = false;
    const double stops = pairStops(pair, i, k, piece, {time.from_rad, last}, work, is_given_up);
    if (stops >= last) return;
    best = stops;
    reach.is_given_up = is_given_up;
    reach.by = {near.index, i, k};
  };

  struct Waiting {
    std::uint32_t held, moving;
    double bound;
  };
  const auto &tree = fixed.tree().nodes(), &tree_M = moving.tree().nodes();
  const auto boundOf = [&](std::uint32_t k, std::uint32_t i) {
    if (passes(&PassingFacets::nodes, k, i)) return kMotionSearchForever;
    const MeetingTime time = timeOf(&AxisExtents::nodes, &ScrewSectors::nodes, k, i);
    if (time.isNever() || !(time.from_rad < best)) return kMotionSearchForever;
    const double radius_m = turning ? turning->moving.extents.nodes[i].farthest_m : 0;
    const Box box = moved(tree_M[i].box, X_HM);
    const double bound = std::max(time.from_rad, reaches(box, tree[k].box, radius_m));
    if (!(bound < best)) return bound;
    // The plane of a flat node can separate all facets of both nodes, as safeStep() separates two facets.
    if (const PartSurface::NodePlane& plane = fixed.planes()[k]; plane.isFlat())
      if (staysAbove(motion_H, box, plane.n, plane.highest_m - held.rest_m) >= best)
        return kMotionSearchForever;
    if (const PartSurface::NodePlane& plane = moving.planes()[i]; plane.isFlat()) {
      const Vec3 n = X_HM.R * plane.n;
      if (staysAbove(motion_H.reversed(), tree[k].box, n, plane.highest_m + n.dot(X_HM.p) - held.rest_m) >=
          best)
        return kMotionSearchForever;
    }
    if (!motion_H.is_turn && passBeside(fixed, k, moving, i, X_HM, motion_H.direction, held.rest_m))
      return kMotionSearchForever;
    return bound;
  };
  std::vector<Waiting> stack{{0, 0, boundOf(0, 0)}};
  StridedPoll poll;
  while (!stack.empty() && best > 0) {
    poll();
    if (work != nullptr && work->isSpent()) return 0;
    if (work != nullptr) ++work->done;
    const Waiting now = stack.back();
    stack.pop_back();
    if (!(now.bound < best)) continue;
    const BoxTree::Node &of_held = tree[now.held], &of_moving = tree_M[now.moving];
    if (of_held.isLeaf() && of_moving.isLeaf()) {
      for (std::uint32_t a = of_held.first; a < of_held.end; ++a)
        for (std::uint32_t b = of_moving.first; b < of_moving.end; ++b)
          visit(fixed.tree().order()[a], moving.tree().order()[b]);
      continue;
    }
    const bool halves_held =
        of_moving.isLeaf() ||
        (!of_held.isLeaf() && of_held.box.size().squaredNorm() >= of_moving.box.size().squaredNorm());
    Waiting first = now, second = now;
    (halves_held ? first.held : first.moving) += 1;
    (halves_held ? second.held : second.moving) = halves_held ? of_held.right : of_moving.right;
    first.bound = boundOf(first.held, first.moving);
    second.bound = boundOf(second.held, second.moving);
    if (second.bound < first.bound) std::swap(first, second);
    if (second.bound < best) stack.push_back(second);
    if (first.bound < best) stack.push_back(first);
  }
  return best;
}

Reach MotionSearch::reach(const Motion& motion, double most, SearchWork* work) const {
  return reach(motion, most, nearOf(motion, most), turningOf(motion), nullptr, work);
}

std::array<Reach, 2> MotionSearch::reachBoth(const Motion& motion, double most,
                                             const std::array<const PassingFacets*, 2>& passing) const {
  const std::optional<Turning> turning = turningOf(motion);
  const std::vector<Near> near = nearOf(motion, most);
  std::vector<Near> near_back;  // for a translation; a rotation has the same held parts in both directions
  if (!turning) near_back = nearOf(motion.reversed(), most);
  return {reach(motion, most, near, turning, passing[0], nullptr),
          reach(motion.reversed(), most, turning ? near : near_back, turning, passing[1], nullptr)};
}

Reach MotionSearch::reach(const Motion& motion, double most, const std::vector<Near>& near,
                          const std::optional<Turning>& turning, const PassingFacets* passing,
                          SearchWork* work) const {
  std::vector<Motion> in_held;
  for (const Near& one : near) in_held.push_back(motion.in(one.held.part->X_WP.inverse()));
  const double speed = std::max(motion.is_turn ? greatestSpeed(motion, part_.box_W) : 1, 1e-300);
  const double least = kLeastStep_m / speed;
  double longest = kFirstStep_m / speed;
  const double sense = turning ? motion.direction.dot(turning->axis_W) : 0;  // -1 for the reverse motion
  const double forward_m = sense * motion.forward_m;
  Reach reach;
  for (; reach.s < most && !reach.is_stopped; longest *= 4) {
    double free = std::min(longest, most - reach.s);
    for (std::size_t k = 0; k < near.size() && free > 0; ++k) {
      const auto [back_m, front_m] = std::minmax({reach.s * forward_m, (reach.s + free) * forward_m});
      const Piece piece{in_held[k],        in_held[k].at(reach.s) * near[k].held.X_HM, free, least,
                        {back_m, front_m}, {sense * reach.s, sense * (reach.s + free)}};
      const double here = step(near[k], turning, piece, passing, work, reach);
      if (here >= free) continue;
      free = here;
      reach.is_stopped = true;
    }
    reach.s = std::min(most, reach.s + free);
  }
  if (!reach.is_stopped || reach.is_given_up) return reach;
  if (work != nullptr && work->isSpent()) {
    reach.is_given_up = true;
    return reach;
  }
  return backedOff(reach, motion, speed);
}

/// Moves the part back along its path until the facets that stopped it no longer penetrate by the rest depth,
/// kRest_m.
Reach MotionSearch::backedOff(Reach reach, const Motion& motion_W, double speed) const {
  const Held held = heldAt(reach.by.held);
  const Motion motion = motion_W.in(held.part->X_WP.inverse());
  const MovingPair pair{*part_.surface, *held.part->surface, motion.at(reach.s) * held.X_HM, motion,
                        held.rest_m};
  // A contact that closes more slowly than a tenth of the speed is a grazing contact, whose place is
  // uncertain by more than the rest depth.
  const double closing =
      std::max(closingSpeed(pair, reach.by.moving_facet, reach.by.held_facet), 0.1 * speed);
  reach.rate = contactRate(pair, reach.by.moving_facet, reach.by.held_facet);
  reach.s = std::max(0.0, reach.s - kRest_m / closing);
  return reach;
}

double MotionSearch::chordOf_m(const Blocker& blocker) const {
  return part_.surface->chord_m(blocker.moving_facet) +
         held_->parts[blocker.held]->surface->chord_m(blocker.held_facet);
}

bool MotionSearch::isStoppedBy(const Blocker& blocker, const Motion& motion, double most) const {
  const Held held = heldAt(blocker.held);
  const Motion motion_H = motion.in(held.part->X_WP.inverse());
  double s = 0;
  for (int i = 0; i < kMostSteps && s < most; ++i) {
    const MovingPair pair{*part_.surface, *held.part->surface, motion_H.at(s) * held.X_HM, motion_H,
                          held.rest_m};
    const double safe = safeStep(pair, blocker.moving_facet, blocker.held_facet);
    if (safe < kLeastStep_m) return true;
    s += safe;
  }
  return false;
}

}  // namespace vps::scenes
