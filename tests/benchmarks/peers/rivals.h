// SPDX-License-Identifier: BSD-3-Clause
// Other contact engines for meshes: in whole scenes with Bullet, and for one pair at a pose.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/engine.h"

namespace vps::bench {

/// Bullet's own mesh against mesh. @param margin_m  margin of every shape
dynamics::Engine gimpactEngine(double margin_m);

/// The convex hull of each part, without margin.
dynamics::Engine hullEngine();
/// btBvhTriangleMeshShape for fixed parts, the convex hull for others; without margin.
dynamics::Engine bvhEngine();

/// Compounds of convex hulls from HACD; empty if its library is not installed. Decomposing a mesh takes
/// seconds to minutes; results are cached as long as the engine exists.
/// @param concavity_m  allowed deviation of the hulls, HACD's main setting
std::optional<dynamics::Engine> hacdEngine(double concavity_m);

/// A contact query of one pair of meshes.
struct PairQuery {
  struct Answer {
    int contacts = 0;
    double deepest_m = 0;  ///< 0 if nothing touches
  };
  std::string name;
  std::function<Answer(const Pose& X_AB)> query;  ///< empty: the rival is not built
};

/// A query through Bullet's dispatcher, as in a step.
PairQuery bulletQuery(const dynamics::Engine& engine, const dynamics::PartMesh& a,
                      const dynamics::PartMesh& b);
PairQuery fclQuery(const Mesh& a, const Mesh& b);
PairQuery odeQuery(const Mesh& a, const Mesh& b);

}  // namespace vps::bench
