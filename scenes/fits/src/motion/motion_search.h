// SPDX-License-Identifier: BSD-3-Clause
// How far a part can move until it touches a held part.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "motion/motion.h"
#include "motion/pair_step.h"
#include "motion/screw_sector.h"
#include "surface/around_axis.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// Two facets that stopped a motion.
struct Blocker {
  std::size_t held = 0;  ///< index in MotionSearch's list of held parts
  std::uint32_t moving_facet = 0, held_facet = 0;
};

/// How far a part moves.
struct Reach {
  double s = 0;  ///< parameter of the motion that was reached, at most the requested one
  bool is_stopped = false;
  /// With is_stopped: the search ended after too many steps; the part may reach farther.
  bool is_given_up = false;
  Blocker by;
  double rate = 1;  ///< contactRate() of the two facets that stopped the motion
};

/// Parts that do not move, and a tree of their boxes in the world. The parts must outlive the object.
struct StandingParts {
  explicit StandingParts(std::vector<const PlacedSurface*> of_parts);
  std::vector<const PlacedSurface*> parts;
  BoxTree boxes;
};

/// Facets that a motion search may skip: facets of the moving part or of a held part that cannot touch the
/// other part.
struct PassingFacets {
  std::size_t held = 0;  ///< index in MotionSearch's list of held parts
  bool is_of_moving = false;
  /// By facet and by node of the part's tree: 1 if the facet, or all facets of the node, can be skipped.
  std::vector<std::uint8_t> facets, nodes;

  PassingFacets(std::size_t held, bool is_of_moving, std::vector<std::uint8_t> facets, const BoxTree& tree);
};

/// Limit of a search's work, in visited pairs of nodes, which take 1 us each (4 us in a rotation). The limit
/// depends neither on the machine nor on its load.
struct SearchWork {
  std::uint64_t most = 0, done = 0;
  [[nodiscard]] bool isSpent() const { return done >= most; }
};

/// How deep the facets of a pair may penetrate each other.
enum class CrossingDepth {
  AsDrawn,   ///< as deep as at the drawn pose: gives exact play
  UpToMost,  ///< up to the given depth anywhere, as meshes of flush curved faces need on a long path
};

/// Measures motions of one part; the other parts stay at their poses.
///
/// The method is conservative advancement. From a pose, each pair of triangles can move by safeStep() without
/// contact; the least safe step of all pairs is safe for the part. The part moves by this step repeatedly
/// until the step vanishes. Sources: Mirtich 1996; the bound by planes of facets follows Tang, Kim and
/// Manocha, C2A, 2009.
class MotionSearch {
 public:
  /// The rest depth: greatest depth to which the facets of parts in contact may penetrate each other.
  static constexpr double kRest_m = 0.1e-6;

  /// @param part  must outlive the search
  /// @param held the held parts, which several searches may share; `part` itself (same address) may be among
  /// them and is skipped
  /// @param crossing_m for each held part: greatest depth to which facets may cross; 0 for the part itself
  MotionSearch(const PlacedSurface& part, std::shared_ptr<const StandingParts> held,
               const std::vector<double>& crossing_m, CrossingDepth depth = CrossingDepth::AsDrawn);

  /// @param motion in the world
  /// @param work counts the work; the motion ends where the work is spent. If null, only the number of steps
  /// is limited
  [[nodiscard]] Reach reach(const Motion& motion, double most, SearchWork* work = nullptr) const;
  /// The reach of the motion and of its reverse.
  /// @param passing facets to skip, for each of the two motions; null: none
  [[nodiscard]] std::array<Reach, 2> reachBoth(const Motion& motion, double most,
                                               const std::array<const PassingFacets*, 2>& passing = {}) const;
  /// Whether the blocker's two facets alone stop the motion.
  [[nodiscard]] bool isStoppedBy(const Blocker& blocker, const Motion& motion, double most) const;
  /// Sum of the greatest distances of the blocker's two facets from the curved faces that they approximate.
  [[nodiscard]] double chordOf_m(const Blocker& blocker) const;
  [[nodiscard]] const PlacedSurface& held(std::size_t index) const { return *held_->parts[index]; }
  /// Index of the held part with this name, which must exist.
  [[nodiscard]] std::size_t indexOf(const std::string& held) const;
  /// The greatest rest depth of all pairs.
  [[nodiscard]] double rest_m() const;

 private:
  struct Held {
    const PlacedSurface* part;
    Pose X_HM;  ///< drawn pose of the moving part in the held part's frame
    double rest_m;
  };
  /// Where the facets of a part are, as seen from the axis of a rotation. Both parts of a pair measure angles
  /// from one direction.
  struct AroundAxis {
    AxisExtents extents;
    ScrewSectors sectors;
    AroundAxis(const PlacedSurface& part, const Motion& motion_W);
  };
  /// A held part that may come near during a motion.
  struct Near {
    std::size_t index;
    Held held;
    std::optional<AroundAxis> turning;  ///< of the held part; set for a rotation only
  };
  /// For a rotation: its axis, and the moving part as seen from the axis.
  struct Turning {
    Vec3 axis_W;
    AroundAxis moving;
  };
  /// A piece of a motion that starts at a pose and has the length `most` at most.
  struct Piece {
    Motion motion_H;
    Pose X_HM;
    double most = 0, least = 0;  ///< length of the piece; step that counts as zero
    /// Range of a screw's advance along Turning::axis_W, from the drawn pose.
    std::array<double, 2> along_m = {};
    TurnedAngles turned;  ///< the angles of a rotation about Turning::axis_W, from the drawn pose
  };
  [[nodiscard]] Held heldAt(std::size_t index) const;
  [[nodiscard]] std::optional<Turning> turningOf(const Motion& motion) const;
  [[nodiscard]] Reach reach(const Motion& motion, double most, const std::vector<Near>& near,
                            const std::optional<Turning>& turning, const PassingFacets* passing,
                            SearchWork* work) const;
  [[nodiscard]] Reach backedOff(Reach reach, const Motion& motion_W, double speed) const;
  /// The held parts whose boxes may come near during the motion, in ascending order. A rotation and its
  /// reverse have the same parts. O(log n + parts found); for a rotation also O(triangles of the parts
  /// found).
  [[nodiscard]] std::vector<Near> nearOf(const Motion& motion, double most) const;
  /// Greatest distance of the part's box from the centre of a rotation.
  [[nodiscard]] double farthestFrom(const Motion& turn, double most) const;
  /// How far the part moves on the piece before a facet of the held part stops it. `reach` receives the
  /// facets that stop the part, and whether the search was given up.
  double step(const Near& near, const std::optional<Turning>& turning, const Piece& piece,
              const PassingFacets* passing, SearchWork* work, Reach& reach) const;
  /// How far one pair of facets moves on the piece before the facets touch, between two parameters.
  static double pairStops(const MovingPair& pair, std::uint32_t moving, std::uint32_t held,
                          const Piece& piece, const std::array<double, 2>& range, SearchWork* work,
                          bool& is_given_up);

  const PlacedSurface& part_;
  std::shared_ptr<const StandingParts> held_;
  std::vector<double> rest_m_;  // by held part
  double most_rest_m_ = kRest_m;
};

}  // namespace vps::scenes
