// SPDX-License-Identifier: BSD-3-Clause
// One random case of the search: bodies, how they move, and for how long.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vps/mesh.h"
#include "vps/mesh_overlap.h"

namespace vps::search {

struct CaseBody {
  std::string name;
  Mesh mesh;   ///< closed: the truth that overlap is measured with
  Mesh given;  ///< the mesh that the engine gets: `mesh`, or `mesh` with faults
  Pose X_WP;   ///< pose of the part's frame at the start
  bool is_fixed = false;
  double friction = 0.15;
  Twist V_WP_W;  ///< velocity at the start; the linear velocity is that of the centre of mass
  std::shared_ptr<const OverlapMesh> exact = nullptr;  ///< built from `mesh` by makeCase()
};

/// A hand that holds one body at the origin of its frame and moves from goal to goal.
struct Hand {
  struct Goal {
    Pose X_WP;
    double speed_m_s, spin_rad_s;  ///< the hand is as slow as the slower of both requires
  };
  std::size_t body = 0;
  std::vector<Goal> goals;
};

struct Case {
  std::string family;
  std::uint64_t seed = 0;
  bool is_faulty = false;
  std::vector<CaseBody> bodies;
  std::optional<Hand> hand;
  double seconds = 1;
};

/// The deepest overlap of any two bodies at these poses, of which at least one can move.
struct CaseOverlap {
  Overlap overlap;
  std::size_t a = 0, b = 0;
};
CaseOverlap deepestOverlap(const Case& made, const std::vector<Pose>& poses);

}  // namespace vps::search
