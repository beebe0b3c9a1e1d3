// SPDX-License-Identifier: BSD-3-Clause
// How far a part can move until it touches what is held.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "motion/motion.h"
#include "motion/pair_step.h"
#include "surface/around_axis.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// Two facets that stopped a motion.
struct Blocker {
  std::size_t held = 0;  ///< index in MotionSearch's list
  std::uint32_t moving_facet = 0, held_facet = 0;
};

struct Reach {
  double s = 0;  ///< as asked for at most
  bool is_stopped = false;
  bool is_given_up = false;  ///< with is_stopped: not stopped, but after too many steps; it reaches farther
  Blocker by;
  double rate = 1;  ///< of a stop: contactRate() of the two facets
};

/// Parts that stand, which must outlive it, and a tree of their boxes in the world.
struct StandingParts {
  explicit StandingParts(std::vector<const PlacedSurface*> of_parts);
  std::vector<const PlacedSurface*> parts;
  BoxTree boxes;
};

/// What need not be looked at in a motion: facets of the moving part or of one that is held, which cannot
/// touch the other of the two.
struct PassingFacets {
  std::size_t held = 0;  ///< index in MotionSearch's list
  bool is_of_moving = false;
  std::vector<std::uint8_t> facets, nodes;  ///< 1: passes; a node of the part's tree if all its facets do

  PassingFacets(std::size_t held, bool is_of_moving, std::vector<std::uint8_t> facets, const BoxTree& tree);
};

/// How much a search may do, in visited pairs of nodes: 1 us each, or 4 us in a turn. A limit that does not
/// depend on the machine or its load.
struct SearchWork {
  std::uint64_t most = 0, done = 0;
  [[nodiscard]] bool isSpent() const { return done >= most; }
};

/// How deep the facets of a pair may be in each other.
enum class CrossingDepth {
  AsDrawn,   ///< as deep as they are where the part stands: exact play
  UpToMost,  ///< up to the given depth anywhere: what meshes of flush curved faces allow on a long way
};

/// The motions of one part, with the others held where they stand.
///
/// Conservative advancement: from a pose, each pair of triangles has a way on which it stays apart
/// (safeStep()); the least of them is safe for the part. It is moved by it, again and again, until it cannot
/// be. Sources: Mirtich 1996; the bound by planes of facets follows Tang, Kim and Manocha, C2A, 2009.
class MotionSearch {
 public:
  /// How deep the facets of parts that rest on each other may be in each other.
  static constexpr double kRest_m = 0.1e-6;

  /// @param part  must outlive the search
  /// @param held  may be shared by searches; the part itself, known by its address, may be among them and is
  ///              not searched
  /// @param crossing_m by pair of the part and each held one: facets may cross by no more than this; 0 for
  ///                   the part itself
  MotionSearch(const PlacedSurface& part, std::shared_ptr<const StandingParts> held,
               const std::vector<double>& crossing_m, CrossingDepth depth = CrossingDepth::AsDrawn);

  /// @param motion in the world
  /// @param work   counts what is done; a motion is stopped where it is spent. Null: no limit but the steps
  [[nodiscard]] Reach reach(const Motion& motion, double most, SearchWork* work = nullptr) const;
  /// Of the motion and of its reverse.
  /// @param passing  for each of the two; null: all facets are looked at
  [[nodiscard]] std::array<Reach, 2> reachBoth(const Motion& motion, double most,
                                               const std::array<const PassingFacets*, 2>& passing = {}) const;
  /// Whether the two facets alone stop the motion.
  [[nodiscard]] bool isStoppedBy(const Blocker& blocker, const Motion& motion, double most) const;
  /// Distance of the two facets from the curved faces that they stand for.
  [[nodiscard]] double chordOf_m(const Blocker& blocker) const;
  [[nodiscard]] const PlacedSurface& held(std::size_t index) const { return *held_->parts[index]; }
  /// Of the held part with this name, which is among them.
  [[nodiscard]] std::size_t indexOf(const std::string& held) const;
  /// The greatest rest depth of all pairs.
  [[nodiscard]] double rest_m() const;

 private:
  struct Held {
    const PlacedSurface* part;
    Pose X_HM;  ///< the moving part, as drawn
    double rest_m;
  };
  /// A held part that may be near on a motion.
  struct Near {
    std::size_t index;
    Held held;
    std::optional<AxisExtents> turning;  ///< of a turn
  };
  /// For a turn: of the part.
  struct Turning {
    Vec3 axis_W;
    AxisExtents moving;
  };
  /// A piece of a motion: from a pose on, `most` at most.
  struct Piece {
    Motion motion_H;
    Pose X_HM;
    double most = 0, least = 0;          ///< how far to look, and the step that counts as none
    std::array<double, 2> along_m = {};  ///< where a screw goes, along Turning::axis_W from the pose as drawn
  };
  [[nodiscard]] Held heldAt(std::size_t index) const;
  [[nodiscard]] std::optional<Turning> turningOf(const Motion& motion) const;
  [[nodiscard]] Reach reach(const Motion& motion, double most, const std::vector<Near>& near,
                            const std::optional<Turning>& turning, const PassingFacets* passing,
                            SearchWork* work) const;
  [[nodiscard]] Reach backedOff(Reach reach, const Motion& motion_W, double speed) const;
  /// The held parts that may be near on the motion, as their boxes tell, ascending. A turn and its reverse
  /// have the same. O(log n + those found); of a turn also their triangles.
  [[nodiscard]] std::vector<Near> nearOf(const Motion& motion, double most) const;
  /// How far the part reaches from the centre of a turn.
  [[nodiscard]] double farthestFrom(const Motion& turn, double most) const;
  /// How far on the piece no facet of a held part stops; where one does, `reach` says which and whether it
  /// was given up.
  double step(const Near& near, const std::optional<Turning>& turning, const Piece& piece,
              const PassingFacets* passing, SearchWork* work, Reach& reach) const;
  /// The same of one pair of facets, which advances by itself.
  static double pairStops(const MovingPair& pair, std::uint32_t moving, std::uint32_t held,
                          const Piece& piece, double most, SearchWork* work, bool& is_given_up);

  const PlacedSurface& part_;
  std::shared_ptr<const StandingParts> held_;
  std::vector<double> rest_m_;  // of each held part
  double most_rest_m_ = kRest_m;
};

}  // namespace vps::scenes
