// SPDX-License-Identifier: BSD-3-Clause
// Which parts stop each other, and in which directions.
#pragma once

#include <tbb/concurrent_unordered_map.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "motion/motion_search.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// Points on the surfaces of two parts where they touch. A straight motion is stopped if such a point, moved
/// a little along the motion, is deeper in the other part than allowed. The converse does not hold: if no
/// point is deeper than allowed, a motion search has to decide. A query of 64 points takes 0.2 ms, and a
/// motion search along flush curved faces 10 to 100 ms.
class ContactProbes {
 public:
  ContactProbes() = default;
  ContactProbes(const PlacedSurface& a, const PlacedSurface& b, double allowed_m);
  /// Whether a is stopped immediately when it moves along d.
  [[nodiscard]] bool areStopped(const Vec3& d_W) const;

 private:
  struct Side {
    const PlacedSurface* other = nullptr;
    std::vector<Vec3> points_W;  ///< points on the surface of the part that is not `other`
    double sign = 1;             ///< sign of the motion of points_W along d
  };
  static std::vector<Vec3> touching(const PlacedSurface& of, const PlacedSurface& other, double within_m);

  std::vector<Side> sides_;
  double allowed_m_ = 0;
};

/// Unit vectors, each stored with its opposite at the indices 2 k and 2 k + 1.
class Directions {
 public:
  /// Returns the index of d; adds d if no stored vector is within 1e-5 of it.
  std::size_t add(const Vec3& d);
  const Vec3& operator[](std::size_t i) const { return vectors_[i]; }
  [[nodiscard]] std::size_t size() const { return vectors_.size(); }
  static std::size_t opposite(std::size_t i) { return i ^ 1U; }

 private:
  std::vector<Vec3> vectors_;
};

/// Straight motions of each part past each other part. A part leaves several held parts if it passes each of
/// them, and a group leaves if each member leaves, so that only pairs are searched: this is the blocking
/// graph of Wilson and Latombe (1994), with one graph for each direction.
class PairMotions {
 public:
  /// `parts` and `checked` have to outlive this object.
  PairMotions(const std::vector<PlacedSurface>& parts, const CheckResult& checked, const Vec3& up_W,
              const Progress& progress);

  [[nodiscard]] const std::vector<PlacedSurface>& parts() const { return parts_; }
  [[nodiscard]] const Directions& directions() const { return directions_; }
  [[nodiscard]] std::size_t up() const { return up_; }
  /// Likely directions of a part: up, the world's axes, the part's axes, and the axes of its fits.
  [[nodiscard]] const std::vector<std::size_t>& axesOf(std::size_t part) const { return axes_[part]; }
  /// Directions to try after the likely directions: the vertices of a subdivided icosahedron.
  [[nodiscard]] const std::vector<std::size_t>& around() const { return around_; }
  [[nodiscard]] const std::vector<CheckedFit>& fitsOf(std::size_t part) const { return fits_[part]; }
  /// For each fit in fitsOf(), the other part of the fit.
  [[nodiscard]] const std::vector<std::size_t>& matesOf(std::size_t part) const { return mates_[part]; }
  [[nodiscard]] bool areNear(std::size_t a, std::size_t b) const { return near_.contains(std::minmax(a, b)); }

  /// Whether the held part stops a part that moves away in a direction. Results are cached. Thread-safe.
  bool stops(std::size_t held, std::size_t part, std::size_t direction) const;
  /// The allowance for meshes [m], beyond the drawn overlap, that a motion that is not stopped may need; 0 if
  /// the motion needs no allowance. A motion needs an allowance if it is stopped when facets may be no deeper
  /// in each other than at the part's placement. The allowance is also 0 if the work limit ends the test.
  /// Results are cached. Thread-safe.
  double allowanceOf(std::size_t held, std::size_t part, std::size_t direction) const;
  /// The answers of stops() so far, and the answers of an earlier plan of the same parts. A motion is encoded
  /// as its slot(), then a bit for the answer and a bit that is set if the motion was too long to follow.
  [[nodiscard]] std::vector<std::uint64_t> found() const;
  void take(const std::vector<std::uint64_t>& found);
  /// Number of motions of stops() that were too long to follow to their end.
  [[nodiscard]] std::size_t cutMotions() const { return cut_; }
  /// The parts that keep `part` from falling by more than 1 mm, ascending.
  [[nodiscard]] const std::vector<std::size_t>& carriersOf(std::size_t part) const { return carriers_[part]; }
  /// The parts that this part carries, ascending.
  [[nodiscard]] const std::vector<std::size_t>& carriedBy(std::size_t part) const { return carried_[part]; }

  /// Prepares a search of motions of a part, from any pose, past several held parts.
  [[nodiscard]] MotionSearch search(const PlacedSurface& placed, std::size_t part,
                                    const std::vector<std::size_t>& held) const;
  /// A distance at which every part has left all others.
  [[nodiscard]] double leave_m() const { return leave_m_; }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;
  struct Near {
    double crossing_m = 0;   ///< depth by which the two parts may overlap
    double allowance_m = 0;  ///< share of crossing_m that exceeds the drawn overlap
    std::unique_ptr<const MotionSearch> search;
    ContactProbes probes;
    /// Whether the second part stops a straight motion of the first part.
    bool stops(const Motion& motion, double most_m, SearchWork& work) const {
      return probes.areStopped(motion.direction) || search->reach(motion, most_m, &work).is_stopped;
    }
  };
  [[nodiscard]] std::uint64_t slot(std::size_t a, std::size_t b, std::size_t direction) const;
  void findDirections(const CheckResult& checked);
  void findNear(const CheckResult& checked, const Progress& progress);

  const std::vector<PlacedSurface>& parts_;
  Directions directions_;
  std::size_t up_ = 0;
  std::vector<std::vector<std::size_t>> axes_;
  std::vector<std::size_t> around_;
  std::vector<std::vector<CheckedFit>> fits_;
  std::vector<std::vector<std::size_t>> mates_;
  std::map<Pair, Near> near_;
  std::vector<std::vector<std::size_t>> carriers_, carried_;
  double leave_m_ = 0;
  mutable std::atomic<std::size_t> cut_ = 0;
  /// By slot(): whether the part is stopped. The map known_ contains only pairs whose boxes do not decide the
  /// answer.
  struct Answer {
    bool is_stopped = false, is_cut = false;
  };
  mutable tbb::concurrent_unordered_map<std::uint64_t, Answer> known_;
  mutable tbb::concurrent_unordered_map<std::uint64_t, double> allowance_m_;  ///< by slot()
};

/// A copy of a part, moved by a motion of the world.
PlacedSurface displaced(const PlacedSurface& part, const Pose& X_W);

}  // namespace vps::scenes
