// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <deque>
#include <numbers>
#include <optional>

#include "surface/triangle_gap.h"
#include "ways/way.h"

namespace vps::scenes {

namespace {

constexpr double kLeastLeg = 0.02;  // share of the part's size; shorter legs count as play
constexpr double kTurn_rad = 2 * std::numbers::pi;
/// Stops within a leg, as shares of the leg. Assumed: an opening at the side of a leg is wider than an eighth
/// of the leg.
constexpr std::array kStops = {1.0, 0.5, 0.75, 0.25, 0.875, 0.625, 0.375, 0.125};

/// Which motions a search tries from each place.
struct Repertoire {
  std::size_t most_legs, most_places;
  /// Also motions that the contacts suggest, the axes of the part as it stands, and legs as short as play.
  bool follows_contacts;
};
constexpr Repertoire kAlongAxes{4, 96, false};
constexpr Repertoire kByContacts{5, 256, true};

struct Place {
  Pose X_W;  ///< world motion that brings the part from its target to this place
  std::vector<Leg> legs;
};

/// A point at which a held part stopped a motion.
struct Contact {
  Vec3 p_W;
  Vec3 n_W;  ///< unit normal out of the held part
};

class LegSearch {
 public:
  LegSearch(const PairMotions& motions, const std::vector<std::size_t>& parts,
            const std::vector<std::size_t>& held, const Repertoire& repertoire, SearchWork& work)
      : motions_(motions), parts_(parts), held_(held), repertoire_(repertoire), work_(work) {
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
      fit_axes_.push_back({fit.axis_W, fit.at_W, true});
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

  /// The parts at a place, with the searches of their motions. One part may stand for several searches.
  struct Standing {
    std::vector<PlacedSurface> placed;
    std::vector<MotionSearch> searches;
  };
  [[nodiscard]] Standing standingAt(const Pose& X_W) const {
    Standing out;
    for (const std::size_t part : parts_) out.placed.push_back(displaced(motions_.parts()[part], X_W));
    for (std::size_t i = 0; i < parts_.size(); ++i)
      out.searches.push_back(motions_.search(out.placed[i], parts_[i], held_));
    return out;
  }

  /// How far the parts move.
  /// @param contact  receives the point that stopped the parts; null: not wanted
  Reach reachOf(const Standing& standing, const Motion& motion, double most,
                std::optional<Contact>* contact = nullptr) {
    Reach least{most, false, false, {}};
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Reach reach = standing.searches[i].reach(motion, least.s, &work_);
      if (!reach.is_stopped) continue;
      least = reach;
      if (contact != nullptr && !reach.is_given_up)
        *contact = contactOf(standing.placed[i], standing.searches[i], motion, reach);
    }
    return least;
  }

  [[nodiscard]] static Contact contactOf(const PlacedSurface& placed, const MotionSearch& search,
                                         const Motion& motion, const Reach& reach) {
    const PlacedSurface& held = search.held(reach.by.held);
    const Pose X_WM = motion.at(reach.s) * placed.X_WP;
    const auto inWorld = [](const PlacedSurface& of, std::uint32_t facet, const Pose& X) {
      Triangle t = of.surface->triangle(facet);
      for (Vec3& p : t) p = X * p;
      return t;
    };
    const TriangleGap gap = triangleGap(inWorld(placed, reach.by.moving_facet, X_WM),
                                        inWorld(held, reach.by.held_facet, held.X_WP));
    // Of the normals of both facets, the one that the motion meets head-on.
    const Vec3 of_held = held.X_WP.R * held.surface->normal(reach.by.held_facet);
    const Vec3 of_moving = -(X_WM.R * placed.surface->normal(reach.by.moving_facet));
    const Vec3 p_W = 0.5 * (gap.p_a + gap.p_b);
    const Vec3 v_W = motion.velocity(motion.at(reach.s).inverse() * p_W);
    return {p_W, of_held.dot(v_W) <= of_moving.dot(v_W) ? of_held : of_moving};
  }

  /// The straight motions from a place: along the axes, and along the axes of the part as it stands there.
  [[nodiscard]] std::vector<Motion> straightFrom(const Place& from) const {
    std::vector<Motion> out = straight_;
    if (!repertoire_.follows_contacts || rotationVector(from.X_W.R).norm() < 1e-6) return out;
    for (const Motion& motion : straight_) addStraight(from.X_W.R * motion.direction, out);
    return out;
  }
  static void addStraight(const Vec3& d, std::vector<Motion>& out) {
    const bool is_known =
        std::ranges::any_of(out, [&](const Motion& other) { return (other.direction - d).norm() < 1e-3; });
    if (!is_known) out.push_back({d, Vec3::Zero(), false});
  }

  /// The motions that lead away from a contact which stops a straight motion: a slide along the contact; a
  /// turn about the contact by which the middle of the part continues; and a screw about an axis of the part
  /// or of a fit that slides along the contact, as helical teeth do.
  void addByContact(const Place& from, const Vec3& d, const Contact& at, std::vector<Motion>& straight,
                    std::vector<Motion>& turns) const {
    constexpr double kFlat = 0.1;  // sine below which two directions count as parallel
    const Vec3 slide = d - d.dot(at.n_W) * at.n_W;
    if (slide.norm() > kFlat) addStraight(slide.normalized(), straight);
    // Where faces touch, the contact is any point of them: the turn is also tried about an axis of the part.
    const Vec3 arm = from.X_W * center_W_ - at.p_W;
    if (const Vec3 axis = arm.cross(d); axis.norm() > kFlat * arm.norm()) {
      turns.push_back({axis.normalized(), at.p_W, true});
      const Mat3 R_W = from.X_W.R * motions_.parts()[parts_.front()].X_WP.R;
      Eigen::Index nearest = 0;
      (R_W.transpose() * axis).cwiseAbs().maxCoeff(&nearest);
      const Vec3 along = R_W.col(nearest);
      turns.push_back({along.dot(axis) > 0 ? along : Vec3(-along), at.p_W, true});
    }
    addScrews(from, d, at, turns);
  }

  /// The screws along d that slide along the contact: n . (a x r + forward a) = 0, where r leads from the
  /// axis to the contact.
  void addScrews(const Place& from, const Vec3& d, const Contact& at, std::vector<Motion>& turns) const {
    // Assumed: an advance of less than a fiftieth of the part's size per radian is a thread, see screwWay().
    constexpr double kAlong = 1e-6, kLeastAlong = 1e-3, kLeastForward = 0.02;
    std::vector<Motion> axes = fit_axes_;
    for (int i = 0; i < 3; ++i)
      axes.push_back({motions_.parts()[parts_.front()].X_WP.R.col(i), center_W_, true});
    std::vector<Motion> added;
    for (const Motion& axis : axes) {
      Motion screw{from.X_W.R * axis.direction, from.X_W * axis.center, true};
      if (std::abs(screw.direction.dot(d)) < 1 - kAlong) continue;
      const double along = at.n_W.dot(screw.direction);
      const double around_m = at.n_W.dot(screw.direction.cross(at.p_W - screw.center));
      if (std::abs(along) < kLeastAlong || std::abs(around_m) < kLeastForward * std::abs(along) * size_m_)
        continue;
      screw.forward_m = -around_m / along;
      if (screw.forward_m * screw.direction.dot(d) < 0) screw.direction = -screw.direction;
      // The axes of a fit and of the part are often the same line.
      const bool is_known = std::ranges::any_of(added, [&](const Motion& other) {
        return other.direction.dot(screw.direction) > 1 - kAlong &&
               screw.direction.cross(other.center - screw.center).norm() < kAlong * size_m_;
      });
      if (!is_known) added.push_back(screw);
    }
    // Screws come first: where one slides along helical teeth, turns cost as much and lead nowhere.
    turns.insert(turns.begin(), added.begin(), added.end());
  }

  /// Returns a path if the part leaves straight from this place; otherwise adds the places that it can reach.
  std::optional<Way> expand(const Place& from, std::deque<Place>& waiting) {
    const Standing standing = standingAt(from.X_W);
    std::vector<std::pair<Motion, double>> legs;
    std::vector<Motion> straight = straightFrom(from), turns = turns_;
    const std::size_t usual = straight.size();
    const bool is_last = from.legs.size() + 1 >= repertoire_.most_legs;
    for (std::size_t i = 0; i < straight.size(); ++i) {
      const Motion motion = straight[i];
      std::optional<Contact> contact;
      const bool wants_contact = repertoire_.follows_contacts && i < usual && !is_last;
      const Reach reach = reachOf(standing, motion, motions_.leave_m(), wants_contact ? &contact : nullptr);
      if (!reach.is_stopped) {
        Way way{WayKind::Legs, from.legs, kNoDirection, 0};
        giveRoom(from, motion, way);
        way.legs.push_back({motion, motions_.leave_m()});
        return way;
      }
      if (isLeg(from, reach.s)) legs.emplace_back(motion, reach.s);
      if (contact) addByContact(from, motion.direction, *contact, straight, turns);
    }
    if (is_last) return std::nullopt;
    for (const Motion& motion : turns) {
      // A screw ends where the part has left its mates along the axis.
      const double most =
          motion.forward_m == 0 ? kTurn_rad : std::min(kTurn_rad, 2 * size_m_ / std::abs(motion.forward_m));
      const Reach reach = reachOf(standing, motion, most);
      if (motion.forward_m != 0 && !reach.is_stopped)
        if (std::optional<Way> way = wayBehind(from, {motion, most})) return way;
      if (reach.s > kLeastLeg) legs.emplace_back(motion, reach.s);
    }
    // A stopped part may be as deep as allowed; the leg is shortened to a pose where the part is free.
    double rest_m = 0;
    for (const MotionSearch& search : standing.searches) rest_m = std::max(rest_m, search.rest_m());
    for (auto& [motion, s] : legs) s = std::max(0.0, s - 2 * rest_m / (motion.is_turn ? 0.5 * size_m_ : 1));
    for (const double share : kStops)
      for (const auto& [motion, s] : legs) addPlace(from, {motion, share * s}, waiting);
    return std::nullopt;
  }

  /// The path by a screw that nothing stops, and then straight along its axis.
  std::optional<Way> wayBehind(const Place& from, const Leg& screw) {
    const Vec3 out = screw.motion.forward_m > 0 ? screw.motion.direction : Vec3(-screw.motion.direction);
    const Motion leaving{out, Vec3::Zero(), false};
    if (!isFreeFrom(screw.motion.at(screw.s) * from.X_W, leaving)) return std::nullopt;
    Way way{WayKind::Legs, from.legs, kNoDirection, 0};
    way.legs.push_back(screw);
    way.legs.push_back({leaving, motions_.leave_m()});
    return way;
  }

  /// Whether a straight motion of this length is a leg. The play of a part makes legs too, at the beginning.
  [[nodiscard]] bool isLeg(const Place& from, double s) const {
    constexpr double kLeastPlay_m = 2e-6;
    if (s > kLeastLeg * size_m_) return true;
    return repertoire_.follows_contacts && from.legs.size() < 2 && s > kLeastPlay_m;
  }

  [[nodiscard]] bool isFreeFrom(const Pose& X_W, const Motion& motion) {
    return !reachOf(standingAt(X_W), motion, motions_.leave_m()).is_stopped;
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
    if (seen_.size() >= repertoire_.most_places) return;
    const Pose X_W = leg.motion.at(leg.s) * from.X_W;
    // Places within the play of a part differ by shares of the play.
    const double moved_m = (X_W * center_W_ - from.X_W * center_W_).norm();
    const bool is_play = repertoire_.follows_contacts && !leg.motion.is_turn;
    const double same_m = is_play ? std::min(kLeastLeg * size_m_, 0.3 * moved_m) : kLeastLeg * size_m_;
    const bool is_known = std::ranges::any_of(seen_, [&](const Pose& other) {
      return (other * center_W_ - X_W * center_W_).norm() < same_m &&
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
  const Repertoire& repertoire_;
  SearchWork& work_;
  double size_m_ = 0;
  Vec3 center_W_;
  std::vector<Motion> straight_, turns_, fit_axes_;
  std::vector<Pose> seen_;
};

}  // namespace

std::optional<Way> legWay(const PairMotions& motions, const std::vector<std::size_t>& parts,
                          const std::vector<std::size_t>& held, SearchWork& work) {
  return LegSearch(motions, parts, held, kAlongAxes, work).find();
}

std::optional<Way> contactWay(const PairMotions& motions, std::size_t part,
                              const std::vector<std::size_t>& held, SearchWork& work) {
  const std::vector<std::size_t> parts{part};
  return LegSearch(motions, parts, held, kByContacts, work).find();
}

}  // namespace vps::scenes
