// SPDX-License-Identifier: BSD-3-Clause
// Who else can tell two meshes' contact: for whole scenes in Bullet, and for one pair at a pose.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/engine.h"

namespace vps::bench {

/// Bullet's own mesh against mesh. @param margin_m  of every shape
dynamics::Engine gimpactEngine(double margin_m);

/// Compounds of convex hulls from HACD; nothing where its library is not installed. Cutting a mesh takes
/// seconds to minutes; results are kept for the engine's life.
/// @param concavity_m  how far the hulls may be off, HACD's main setting
std::optional<dynamics::Engine> hacdEngine(double concavity_m);

/// One pair of meshes, asked at a pose.
struct PairQuery {
  struct Answer {
    int contacts = 0;
    double deepest_m = 0;  ///< 0 when nothing touches
  };
  std::string name;
  std::function<Answer(const Pose& X_AB)> ask;  ///< empty: not built
};

/// Through Bullet's dispatcher, as a step would.
PairQuery bulletQuery(const dynamics::Engine& engine, const dynamics::PartMesh& a,
                      const dynamics::PartMesh& b);
PairQuery fclQuery(const Mesh& a, const Mesh& b);
PairQuery odeQuery(const Mesh& a, const Mesh& b);

}  // namespace vps::bench
