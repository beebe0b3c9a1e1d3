// SPDX-License-Identifier: BSD-3-Clause
// Groups of bodies that clash, and the sets of their bodies that a search for places moves.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "proof/places.h"

namespace vps::scenes {

/// Greatest number of bodies that are moved at once; each body adds six unknowns.
inline constexpr std::size_t kMostBodies = 40;

/// Two parts that are or may come near each other. Parts whose overlap the scene allows are
/// no pair, and neither are pairs that the check leaves out.
struct NearPair {
  std::size_t a = 0, b = 0;
  bool is_clash = false;
  bool is_known = false;  ///< a thread, seal or insert, which may overlap as deep as drawn
  double drawn_depth_m = 0;
  double allowed_m = 0;  ///< drawn overlap of parts in contact, whose facets cross; more depth is not allowed
  bool is_uncertain = false;  ///< CheckedPair::is_uncertain, at the drawn places
  /// Error of the meshes anywhere plus a declared press fit. The error of drawn_depth_m can be smaller than
  /// this error.
  double error_m = std::numeric_limits<double>::infinity();
};

/// Finds the pairs of an assembly and the groups of bodies that are connected by clashes.
class ClashGroups {
 public:
  /// @param bodies must outlive the object
  ClashGroups(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
              const std::vector<MovableBody>& bodies);

  /// Pairs of parts of different bodies.
  [[nodiscard]] const std::vector<NearPair>& pairs() const { return pairs_; }
  /// Clashes between parts of one body.
  [[nodiscard]] const std::vector<NearPair>& tied() const { return tied_; }
  /// Groups of bodies that are connected by clashes; each group is in ascending order.
  [[nodiscard]] std::vector<std::vector<std::size_t>> groups() const;
  /// Whether the pair is a clash between bodies of the group.
  [[nodiscard]] bool isOf(const std::vector<std::size_t>& group, const NearPair& pair) const;
  /// The sets of bodies that are moved to free a group, in the order of the tries.
  [[nodiscard]] std::vector<std::vector<std::size_t>> tries(const std::vector<std::size_t>& group) const;

 private:
  template <class Joins>
  [[nodiscard]] std::vector<std::size_t> reachable(std::vector<std::size_t> bodies, Joins joins,
                                                   std::size_t most) const;
  [[nodiscard]] std::vector<std::size_t> movable(std::vector<std::size_t> bodies) const;
  [[nodiscard]] double size_m(std::size_t body) const { return bodies_[body].loose.arm_m; }

  const std::vector<MovableBody>& bodies_;
  std::vector<std::size_t> body_of_;
  std::vector<NearPair> pairs_, tied_;
};

}  // namespace vps::scenes
