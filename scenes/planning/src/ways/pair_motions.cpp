// SPDX-License-Identifier: BSD-3-Clause
#include "ways/pair_motions.h"

#include <algorithm>
#include <cmath>

#include "surface/placed_surface.h"

namespace vps::scenes {

std::vector<Vec3> ContactProbes::touching(const PlacedSurface& of, const PlacedSurface& other,
                                          double within_m) {
  constexpr std::size_t kPoints = 32;
  const Box near_W = grown(other.box_W, within_m);
  const Pose X_OW = other.X_WP.inverse();
  std::vector<Vec3> points_W;
  const auto add = [&](const Vec3& p_W) {
    if (isWithin(p_W, near_W) && std::abs(other.surface->solid().signedDistance(X_OW * p_W)) <= within_m)
      points_W.push_back(p_W);
  };
  const auto count = static_cast<std::uint32_t>(of.surface->mesh().triangles.size());
  constexpr std::uint32_t kLooked = 4096;
  for (std::uint32_t i = 0; i < count; i += 1 + count / kLooked) {
    const Triangle t = of.surface->triangle(i);
    add(of.X_WP * Vec3((t[0] + t[1] + t[2]) / 3));
    add(of.X_WP * t[0]);
  }
  const std::size_t stride = 1 + points_W.size() / kPoints;
  std::vector<Vec3> some_W;
  for (std::size_t i = 0; i < points_W.size(); i += stride) some_W.push_back(points_W[i]);
  return some_W;
}

ContactProbes::ContactProbes(const PlacedSurface& a, const PlacedSurface& b, double allowed_m)
    : allowed_m_(allowed_m) {
  sides_.push_back({&b, touching(a, b, allowed_m), 1});
  sides_.push_back({&a, touching(b, a, allowed_m), -1});
}

bool ContactProbes::areStopped(const Vec3& d_W) const {
  // Distances of the motion in units of the allowed depth. A point at the other surface is then deeper than
  // twice the allowed depth if the motion's slope against that surface is above 1/4, or above 1/40.
  constexpr double kWays[] = {8, 80};
  return std::ranges::any_of(kWays, [&](double way) {
    return std::ranges::any_of(sides_, [&](const Side& side) {
      const Pose X_OW = side.other->X_WP.inverse();
      const Vec3 step_W = side.sign * way * allowed_m_ * d_W;
      return std::ranges::any_of(side.points_W, [&](const Vec3& p_W) {
        return side.other->surface->solid().signedDistance(X_OW * Vec3(p_W + step_W)) < -2 * allowed_m_;
      });
    });
  });
}

namespace {

/// Work limit for one motion of one pair, about ten seconds. A bolt of 227,717 facets needs 2 million units.
constexpr std::uint64_t kMostWork = 10'000'000;
/// Work limit for the test whether a motion needs more overlap of the parts than drawn
/// (PairMotions::allowanceOf()). The search of a motion that needs more overlap ends early, because the
/// motion is stopped; the search of another motion takes long if faces slide along each other.
constexpr std::uint64_t kMostExactWork = 300'000;
constexpr double kFall_m = 1e-3;  // assumed: a part that sinks by less than kFall_m counts as carried

/// Depth by which parts may overlap on a path, beyond the drawn overlap and its error: facets of curved faces
/// of equal size cross by more than their chord error when they slide along each other. This depth is half of
/// the 10 um that a step may penetrate, or a thousandth of the size of small parts. A search with a depth of
/// 1 um took ten times as long. Facets that approximate nothing do not cross: between parts with flat faces
/// alone, more overlap than contact has is a hole that is too small.
double touchOf(const PlacedSurface& a, const PlacedSurface& b) {
  constexpr double kTouch_m = 5e-6, kFlatTouch_m = 2e-6, kShare = 1e-3;
  const bool is_flat = a.surface->mostChordBound_m() + b.surface->mostChordBound_m() == 0;
  return std::min({is_flat ? kFlatTouch_m : kTouch_m, kShare * a.surface->box().size().norm(),
                   kShare * b.surface->box().size().norm()});
}

/// Whether a plane across an axis of the world separates two boxes, apart from an overlap of depth_m, while
/// one of them moves all the way along d. This test avoids motion searches along faces that lie on each
/// other, which take a second if the faces have many edges.
bool staysBeside(const Box& moving, const Box& held, const Vec3& d, double depth_m, double way_m) {
  for (int axis = 0; axis < 3; ++axis) {
    const double nearer_m = way_m * d[axis];
    if (moving.min[axis] - held.max[axis] + depth_m + std::min(0.0, nearer_m) >= 0) return true;
    if (held.min[axis] - moving.max[axis] + depth_m - std::max(0.0, nearer_m) >= 0) return true;
  }
  return false;
}

}  // namespace

std::size_t Directions::add(const Vec3& d) {
  constexpr double kSameDirection = 1e-10;  // squared
  for (std::size_t i = 0; i < vectors_.size(); ++i)
    if ((vectors_[i] - d).squaredNorm() < kSameDirection) return i;
  vectors_.push_back(d);
  vectors_.emplace_back(-d);
  return vectors_.size() - 2;
}

PlacedSurface displaced(const PlacedSurface& part, const Pose& X_W) {
  PlacedSurface out = part;
  out.X_WP = X_W * part.X_WP;
  out.box_W = Box();
  for (const Vec3& p : part.surface->mesh().vertices) out.box_W.add(out.X_WP * p);
  return out;
}

PairMotions::PairMotions(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                         const Vec3& up_W, const Progress& progress)
    : parts_(parts),
      axes_(parts.size()),
      fits_(parts.size()),
      mates_(parts.size()),
      carriers_(parts.size()),
      carried_(parts.size()) {
  up_ = directions_.add(up_W.normalized());
  Box all;
  for (const PlacedSurface& part : parts) {
    all.add(part.box_W.min);
    all.add(part.box_W.max);
  }
  leave_m_ = 2 * all.size().norm();
  findDirections(checked);
  findNear(checked, progress);
}

void PairMotions::findDirections(const CheckResult& checked) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < parts_.size(); ++i) index[parts_[i].name] = i;
  for (const CheckedFit& fit : checked.fits) {
    const std::size_t shaft = index.at(fit.shaft), bore = index.at(fit.bore);
    for (const auto& [part, mate] : {std::pair(shaft, bore), {bore, shaft}}) {
      fits_[part].push_back(fit);
      mates_[part].push_back(mate);
    }
  }
  for (int axis = 0; axis < 3; ++axis) directions_.add(Vec3::Unit(axis));
  const std::size_t common = directions_.size();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (std::size_t d = 0; d < common; ++d) axes_[i].push_back(d);
    const auto add = [&](const Vec3& v) {
      const std::size_t d = directions_.add(v);
      for (const std::size_t one : {d, Directions::opposite(d)})
        if (std::ranges::find(axes_[i], one) == axes_[i].end()) axes_[i].push_back(one);
    };
    for (const CheckedFit& fit : fits_[i]) {
      add(fit.along_W.normalized());
      if (fit.kind == FitKind::Key) add(fit.axis_W.cross(fit.along_W).normalized());
    }
    for (int axis = 0; axis < 3; ++axis) add(parts_[i].X_WP.R.col(axis));
  }
  for (const Vec3& d : makeSphere(1, 1).vertices) around_.push_back(directions_.add(d.normalized()));
}

void PairMotions::findNear(const CheckResult& checked, const Progress& progress) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < parts_.size(); ++i) index[parts_[i].name] = i;
  for (const CheckedPair& pair : checked.pairs) {
    const Pair key = std::minmax(index[pair.a], index[pair.b]);
    Near& near = near_[key];
    near.allowance_m = pair.error_m + touchOf(parts_[key.first], parts_[key.second]);
    near.crossing_m = pair.interference_depth_m + near.allowance_m;
  }
  std::vector<std::pair<const Pair, Near>*> all;
  for (auto& one : near_) all.push_back(&one);
  const Vec3 down_W = -directions_[up_];
  std::vector<std::array<bool, 2>> falls(all.size());  // whether the first and the second part of a pair fall
  forEachOnCores(all.size(), progress, "preparing motions", [&](std::size_t i) {
    auto& [pair, near] = *all[i];
    near.search = std::make_unique<const MotionSearch>(
        parts_[pair.first],
        std::make_shared<const StandingParts>(std::vector<const PlacedSurface*>{&parts_[pair.second]}),
        std::vector<double>{near.crossing_m}, CrossingDepth::UpToMost);
    near.probes = ContactProbes(parts_[pair.first], parts_[pair.second], near.crossing_m);
    SearchWork down{kMostWork}, up{kMostWork};
    falls[i] = {!near.stops({down_W, Vec3::Zero(), false}, kFall_m, down),
                !near.stops({-down_W, Vec3::Zero(), false}, kFall_m, up)};
  });
  const auto add = [this](std::size_t carrier, std::size_t part) {
    carriers_[part].push_back(carrier);
    carried_[carrier].push_back(part);
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [first, second] = all[i]->first;
    if (!falls[i][0]) add(second, first);
    if (!falls[i][1]) add(first, second);
  }
  for (auto* lists : {&carriers_, &carried_})
    for (std::vector<std::size_t>& list : *lists) std::ranges::sort(list);
}

std::uint64_t PairMotions::slot(std::size_t a, std::size_t b, std::size_t direction) const {
  return (static_cast<std::uint64_t>(b) * (b - 1) / 2 + a) * directions_.size() + direction;
}

bool PairMotions::stops(std::size_t held, std::size_t part, std::size_t direction) const {
  // The first part of a pair moves: a motion of the second part is the opposite motion of the first.
  if (held < part) return stops(part, held, Directions::opposite(direction));
  const Motion motion{directions_[direction], Vec3::Zero(), false};
  const Box &moving = parts_[part].box_W, &fixed = parts_[held].box_W;
  if (staysBeside(moving, fixed, motion.direction, 0, leave_m_)) return false;
  const std::uint64_t key = slot(part, held, direction);
  if (const auto known = known_.find(key); known != known_.end()) return known->second.is_stopped;
  const auto near = near_.find({part, held});
  const bool is_near = near != near_.end();
  const double depth_m = is_near ? near->second.crossing_m : touchOf(parts_[part], parts_[held]);
  SearchWork work{kMostWork};
  const bool is_stopped =
      !staysBeside(moving, fixed, motion.direction, depth_m, leave_m_) &&
      (is_near ? near->second.stops(motion, leave_m_, work)
               : search(parts_[part], part, {held}).reach(motion, leave_m_, &work).is_stopped);
  // Another thread may have found the same answer in the meantime.
  if (known_.emplace(key, Answer{is_stopped, work.isSpent()}).second && work.isSpent()) ++cut_;
  return is_stopped;
}

double PairMotions::allowanceOf(std::size_t held, std::size_t part, std::size_t direction) const {
  if (held < part) return allowanceOf(part, held, Directions::opposite(direction));
  const Motion motion{directions_[direction], Vec3::Zero(), false};
  if (staysBeside(parts_[part].box_W, parts_[held].box_W, motion.direction, 0, leave_m_)) return 0;
  const std::uint64_t key = slot(part, held, direction);
  if (const auto known = allowance_m_.find(key); known != allowance_m_.end()) return known->second;
  const auto near = near_.find({part, held});
  const bool is_near = near != near_.end();
  const MotionSearch exact(
      parts_[part], std::make_shared<const StandingParts>(std::vector<const PlacedSurface*>{&parts_[held]}),
      {is_near ? near->second.crossing_m : 0.0}, CrossingDepth::AsDrawn);
  SearchWork work{kMostExactWork};
  const Reach reach = exact.reach(motion, leave_m_, &work);
  const bool is_stopped = reach.is_stopped && !reach.is_given_up && !work.isSpent();
  const double all_m = is_near ? near->second.allowance_m : touchOf(parts_[part], parts_[held]);
  return allowance_m_.emplace(key, is_stopped ? all_m : 0).first->second;
}

std::vector<std::uint64_t> PairMotions::found() const {
  std::vector<std::uint64_t> out;
  for (const auto& [slot, answer] : known_)
    out.push_back(slot << 2U | (answer.is_stopped ? 1U : 0U) | (answer.is_cut ? 2U : 0U));
  std::ranges::sort(out);
  return out;
}

void PairMotions::take(const std::vector<std::uint64_t>& found) {
  for (const std::uint64_t one : found) {
    const Answer answer{(one & 1U) != 0, (one & 2U) != 0};
    if (known_.emplace(one >> 2U, answer).second && answer.is_cut) ++cut_;
  }
}

MotionSearch PairMotions::search(const PlacedSurface& placed, std::size_t part,
                                 const std::vector<std::size_t>& held) const {
  std::vector<const PlacedSurface*> surfaces;
  std::vector<double> crossing_m;
  for (const std::size_t h : held) {
    surfaces.push_back(&parts_[h]);
    const auto near = near_.find(std::minmax(h, part));
    crossing_m.push_back(near == near_.end() ? touchOf(parts_[h], parts_[part]) : near->second.crossing_m);
  }
  return {placed, std::make_shared<const StandingParts>(std::move(surfaces)), crossing_m,
          CrossingDepth::UpToMost};
}

}  // namespace vps::scenes
