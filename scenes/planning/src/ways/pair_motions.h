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

/// Points on the surfaces of two parts where the parts touch, at most 32 points per part. A straight motion
/// is stopped if such a point, moved a little along the motion, lies deeper in the other part than twice the
/// allowed overlap. The converse does not hold: if no point lies so deep, a motion search has to decide. A
/// query of 64 points takes 0.2 ms, and a motion search along flush curved faces 10 to 100 ms.
class ContactProbes {
 public:
  ContactProbes() = default;
  /// @param allowed_m  depth by which the parts may overlap; points at most so far from the other surface are
  ///   taken
  ContactProbes(const PlacedSurface& a, const PlacedSurface& b, double allowed_m);
  /// True if part a is stopped soon after it starts to move along d. False does not mean that a is free.
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
  /// Likely directions of a part: up, the world's axes, the part's axes, the axes of its fits and, for a key,
  /// the direction across its axis and its fit's axis; each with its opposite.
  [[nodiscard]] const std::vector<std::size_t>& axesOf(std::size_t part) const { return axes_[part]; }
  /// Directions to try after the likely directions: the vertices of a subdivided icosahedron.
  [[nodiscard]] const std::vector<std::size_t>& around() const { return around_; }
  [[nodiscard]] const std::vector<CheckedFit>& fitsOf(std::size_t part) const { return fits_[part]; }
  /// For each fit in fitsOf(), the other part of the fit.
  [[nodiscard]] const std::vector<std::size_t>& matesOf(std::size_t part) const { return mates_[part]; }
  [[nodiscard]] bool areNear(std::size_t a, std::size_t b) const { return near_.contains(std::minmax(a, b)); }

  /// Whether the held part stops a part that moves away in a direction. Results are cached. Thread-safe.
  bool stops(std::size_t held, std::size_t part, std::size_t direction) const;
  /// The overlap in excess of the drawn overlap [m] that a motion may need because the meshes are inexact,
  /// for a motion that stops() does not call stopped. The result is 0 if the motion is free even
  /// when facets may be no deeper in each other than at the part's placement; otherwise it is the whole
  /// excess that stops() allows. The result is also 0 if the work limit ends the test. Results are cached.
  /// Thread-safe.
  double allowanceOf(std::size_t held, std::size_t part, std::size_t direction) const;
  /// The answers of stops() so far, and the answers of an earlier plan of the same parts. Each answer is a
  /// number: slot() of the motion in the bits from 2 up; bit 0 is set if the part is stopped; bit 1 is set if
  /// the search ended at the work limit.
  [[nodiscard]] std::vector<std::uint64_t> found() const;
  void take(const std::vector<std::uint64_t>& found);
  /// Number of motions whose search in stops() ended at the work limit.
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
    double allowance_m = 0;  ///< part of crossing_m in excess of the drawn overlap
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
  /// Cached answer of stops(), by slot(). The map known_ has no entry for a motion during which the boxes of
  /// both parts do not overlap at all.
  struct Answer {
    bool is_stopped = false, is_cut = false;
  };
  mutable tbb::concurrent_unordered_map<std::uint64_t, Answer> known_;
  mutable tbb::concurrent_unordered_map<std::uint64_t, double> allowance_m_;  ///< by slot()
};

/// A copy of a part, moved by a motion of the world.
PlacedSurface displaced(const PlacedSurface& part, const Pose& X_W);

}  // namespace vps::scenes
