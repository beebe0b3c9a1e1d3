// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <deque>
#include <numbers>

#include "ways/way.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostLegs = 4;
constexpr std::size_t kMostPlaces = 96;
constexpr double kLeastLeg = 0.02;  // share of the part's size; shorter legs count as play
constexpr double kTurn_rad = 2 * std::numbers::pi;
/// Stops within a leg, as shares of the leg. Assumed: an opening at the side of a leg is wider than an eighth
/// of the leg.
constexpr std::array kStops = {1.0, 0.5, 0.75, 0.25, 0.875, 0.625, 0.375, 0.125};

struct Place {
  Pose X_W;  ///< world motion that brings the part from its target to this place
  std::vector<Leg> legs;
};

class LegSearch {
 public:
  LegSearch(const PairMotions& motions, const std::vector<std::size_t>& parts,
            const std::vector<std::size_t>& held, SearchWork& work)
      : motions_(motions), parts_(parts), held_(held), work_(work) {
    Box box_W;
    std::vector<std::size_t> axes;
    for (const std::size_t part : parts) {
      box_W.add(motions.parts()[part].box_W.min);
      box_W.add(motions.parts()[part].box_W.max);
      for (const std::size_t d : motions.axesOf(part))
        if (std::ranges::find(axes, d) == axes.end()) axes.push_back(d);
    }
    size_m_ = box_W.size().norm();
    center_W_ = box_W.center();
    for (const std::size_t d : axes) straight_.push_back({motions.directions()[d], Vec3::Zero(), false});
    if (parts.size() > 1) return;
    for (const CheckedFit& fit : motions.fitsOf(parts.front())) {
      if (fit.kind != FitKind::Shaft || hasTurnAbout(fit)) continue;
      for (const double sign : {1.0, -1.0}) turns_.push_back({sign * fit.axis_W, fit.at_W, true});
    }
  }

  std::optional<Way> find() {
    std::deque<Place> waiting{{Pose(), {}}};
    seen_.push_back(Pose());
    while (!waiting.empty() && !work_.isSpent()) {
      const Place place = waiting.front();
      waiting.pop_front();
      if (std::optional<Way> way = expand(place, waiting)) return way;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool hasTurnAbout(const CheckedFit& fit) const {
    return std::ranges::any_of(turns_, [&](const Motion& turn) {
      const Vec3 between = fit.at_W - turn.center;
      return turn.direction.cross(fit.axis_W).norm() < 1e-6 &&
             turn.direction.cross(between).norm() < 1e-6 * size_m_;
    });
  }

  /// Returns a path if the part leaves straight from this place; otherwise adds the places that it can reach.
  std::optional<Way> expand(const Place& from, std::deque<Place>& waiting) {
    std::vector<PlacedSurface> placed;
    for (const std::size_t part : parts_) placed.push_back(displaced(motions_.parts()[part], from.X_W));
    std::vector<MotionSearch> searches;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      searches.push_back(motions_.search(placed[i], parts_[i], held_));
    const auto reachOf = [&](const Motion& motion, double most) {
      Reach least{most, false, false, {}};
      for (const MotionSearch& search : searches)
        if (const Reach reach = search.reach(motion, least.s, &work_); reach.is_stopped) least = reach;
      return least;
    };
    std::vector<std::pair<Motion, double>> legs;
    for (const Motion& motion : straight_) {
      const Reach reach = reachOf(motion, motions_.leave_m());
      if (!reach.is_stopped) {
        Way way{WayKind::Legs, from.legs, kNoDirection, 0};
        giveRoom(from, motion, way);
        way.legs.push_back({motion, motions_.leave_m()});
        return way;
      }
      if (reach.s > kLeastLeg * size_m_) legs.emplace_back(motion, reach.s);
    }
    if (from.legs.size() + 1 >= kMostLegs) return std::nullopt;
    for (const Motion& motion : turns_) {
      const double s = reachOf(motion, kTurn_rad).s;
      if (s > kLeastLeg) legs.emplace_back(motion, s);
    }
    // A stopped part may be as deep as allowed; the leg is shortened to a pose where the part is free.
    double rest_m = 0;
    for (const MotionSearch& search : searches) rest_m = std::max(rest_m, search.rest_m());
    for (auto& [motion, s] : legs) s = std::max(0.0, s - 2 * rest_m / (motion.is_turn ? 0.5 * size_m_ : 1));
    for (const double share : kStops)
      for (const auto& [motion, s] : legs) addPlace(from, {motion, share * s}, waiting);
    return std::nullopt;
  }

  [[nodiscard]] bool isFreeFrom(const Pose& X_W, const Motion& motion) {
    return std::ranges::none_of(parts_, [&](std::size_t part) {
      const PlacedSurface placed = displaced(motions_.parts()[part], X_W);
      return motions_.search(placed, part, held_).reach(motion, motions_.leave_m(), &work_).is_stopped;
    });
  }

  /// Shortens the last leg, which ended at an obstacle, to the middle of the range from which the part can
  /// leave: a hand does not follow a wall to the micrometre.
  void giveRoom(const Place& from, const Motion& leaving, Way& way) {
    if (way.legs.empty() || way.legs.back().motion.is_turn) return;
    constexpr double kMostRoom = 0.05;  // share of the part's size; assumed: more than a hand needs
    constexpr int kHalvings = 10;
    Leg& last = way.legs.back();
    const auto isFreeBefore = [&](double back_m) {
      return isFreeFrom(Pose::translation(-back_m * last.motion.direction) * from.X_W, leaving);
    };
    double free_m = 0, stopped_m = std::min(0.5 * last.s, kMostRoom * size_m_);
    if (isFreeBefore(stopped_m)) free_m = stopped_m;
    for (int i = 0; i < kHalvings && free_m < stopped_m; ++i) {
      const double middle_m = 0.5 * (free_m + stopped_m);
      (isFreeBefore(middle_m) ? free_m : stopped_m) = middle_m;
    }
    // The bisection tested other places in the free range; the middle of the range has to be tested as well.
    if (isFreeBefore(0.5 * free_m)) last.s -= 0.5 * free_m;
  }

  void addPlace(const Place& from, const Leg& leg, std::deque<Place>& waiting) {
    if (seen_.size() >= kMostPlaces) return;
    const Pose X_W = leg.motion.at(leg.s) * from.X_W;
    const bool is_known = std::ranges::any_of(seen_, [&](const Pose& other) {
      return (other * center_W_ - X_W * center_W_).norm() < kLeastLeg * size_m_ &&
             rotationVector(other.R.transpose() * X_W.R).norm() < kLeastLeg;
    });
    if (is_known) return;
    seen_.push_back(X_W);
    waiting.push_back({X_W, from.legs});
    waiting.back().legs.push_back(leg);
  }

  const PairMotions& motions_;
  const std::vector<std::size_t>& parts_;
  const std::vector<std::size_t>& held_;
  SearchWork& work_;
  double size_m_ = 0;
  Vec3 center_W_;
  std::vector<Motion> straight_, turns_;
  std::vector<Pose> seen_;
};

}  // namespace

std::optional<Way> legWay(const PairMotions& motions, const std::vector<std::size_t>& parts,
                          const std::vector<std::size_t>& held, SearchWork& work) {
  return LegSearch(motions, parts, held, work).find();
}

}  // namespace vps::scenes
