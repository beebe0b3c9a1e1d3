// SPDX-License-Identifier: BSD-3-Clause
// Which part stops which, in which direction.
#pragma once

#include <tbb/concurrent_unordered_map.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "motion/motion_search.h"
#include "ways/contact_probes.h"

namespace vps::scenes {

/// Unit vectors, each with its opposite: 2 k and 2 k + 1.
class Directions {
 public:
  /// The index of d, which is added if no other is within 1e-5 of it.
  std::size_t add(const Vec3& d);
  const Vec3& operator[](std::size_t i) const { return vectors_[i]; }
  [[nodiscard]] std::size_t size() const { return vectors_.size(); }
  static std::size_t opposite(std::size_t i) { return i ^ 1U; }

 private:
  std::vector<Vec3> vectors_;
};

/// Straight motions of each part past each other one. A part leaves several held ones if it passes each, and
/// several parts that move as one leave if each of them does, so that pairs alone need to be searched: the
/// blocking graph of Wilson and Latombe (1994), one for each direction.
class PairMotions {
 public:
  /// Both arguments outlive it.
  PairMotions(const std::vector<PlacedSurface>& parts, const CheckResult& checked, const Vec3& up_W,
              const Progress& progress);

  [[nodiscard]] const std::vector<PlacedSurface>& parts() const { return parts_; }
  [[nodiscard]] const Directions& directions() const { return directions_; }
  [[nodiscard]] std::size_t up() const { return up_; }
  /// Likely directions of a part: up, the world's axes, its own, and those of its fits.
  [[nodiscard]] const std::vector<std::size_t>& axesOf(std::size_t part) const { return axes_[part]; }
  /// The other directions: the vertices of a subdivided icosahedron.
  [[nodiscard]] const std::vector<std::size_t>& around() const { return around_; }
  [[nodiscard]] const std::vector<CheckedFit>& fitsOf(std::size_t part) const { return fits_[part]; }
  /// The other part of each of its fits.
  [[nodiscard]] const std::vector<std::size_t>& matesOf(std::size_t part) const { return mates_[part]; }
  [[nodiscard]] bool areNear(std::size_t a, std::size_t b) const { return near_.contains(std::minmax(a, b)); }

  /// Whether a part that moves away in a direction meets the held one. Kept once it is known. Thread-safe.
  bool stops(std::size_t held, std::size_t part, std::size_t direction) const;
  /// Of a motion that is not stopped: how much of the allowance for meshes it may need [m], beyond what is
  /// drawn; 0 if it needs none. Facets that may be only as deep in each other as they are where the part
  /// stands then stop it. Also 0 where that takes too long to find out. Kept once it is known. Thread-safe.
  double allowanceOf(std::size_t held, std::size_t part, std::size_t direction) const;
  /// The answers of stops() so far, and those of an earlier plan of the same parts. A motion's number is its
  /// slot(), then a bit for its answer and one for whether it was too long to be followed.
  [[nodiscard]] std::vector<std::uint64_t> found() const;
  void take(const std::vector<std::uint64_t>& found);
  /// How many motions of stops() were too long to be followed to their end.
  [[nodiscard]] std::size_t cutMotions() const { return cut_; }
  /// The parts that keep this one from falling by more than 1 mm, ascending.
  [[nodiscard]] const std::vector<std::size_t>& carriersOf(std::size_t part) const { return carriers_[part]; }
  /// The parts that this one carries, ascending.
  [[nodiscard]] const std::vector<std::size_t>& carriedBy(std::size_t part) const { return carried_[part]; }

  /// Motions of a part, which may stand elsewhere, past several others.
  [[nodiscard]] MotionSearch search(const PlacedSurface& placed, std::size_t part,
                                    const std::vector<std::size_t>& held) const;
  /// A way on which every part leaves all others.
  [[nodiscard]] double leave_m() const { return leave_m_; }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;
  struct Near {
    double crossing_m = 0;   ///< how deep they may be in each other
    double allowance_m = 0;  ///< what of that is not drawn
    std::unique_ptr<const MotionSearch> search;
    ContactProbes probes;
    /// Of a straight motion of the first.
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
  /// By slot(): whether the part is stopped. Only of pairs whose boxes do not tell.
  struct Answer {
    bool is_stopped = false, is_cut = false;
  };
  mutable tbb::concurrent_unordered_map<std::uint64_t, Answer> known_;
  mutable tbb::concurrent_unordered_map<std::uint64_t, double> allowance_m_;  ///< by slot()
};

/// A part moved by a motion of the world.
PlacedSurface displaced(const PlacedSurface& part, const Pose& X_W);

}  // namespace vps::scenes
