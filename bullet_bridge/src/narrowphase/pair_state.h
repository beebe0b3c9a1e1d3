// SPDX-License-Identifier: BSD-3-Clause
// What a pair of bodies remembers from step to step.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "install/context.h"
#include "narrowphase/contact_candidate.h"
#include "narrowphase/manifold_writer.h"
#include "narrowphase/motion.h"
#include "narrowphase/query_state.h"
#include "native_shapes/native_shape_adapter.h"
#include "solver/penalty_pair.h"

namespace vps::bullet {

/// The points chosen in a full query, and where that was.
struct Selection {
  std::vector<Candidate> chosen;
  bool is_valid = false;
  Pose X_01;                       ///< body 1 in body 0
  double reach_m = 0;              ///< how far the query looked
  Pose X_W0;                       ///< of body 0
  Twist V;                         ///< RelativeMotion::V
  ShapeKey key[2];                 ///< of sides that are no Shape
  std::vector<Candidate> springs;  ///< in penalty mode: all that were
};

struct PairState {
  std::shared_ptr<Context> context;
  std::unique_ptr<ManifoldWriter> writer;
  Selection selection;
  std::vector<Candidate> contacts;  ///< of the coming step
  RelativeMotion motion;
  bool is_prepared = false;
  bool has_met = false;                  ///< contacts were looked for before
  PenaltyPair penalty;                   ///< in penalty mode
  bool is_registered = false;            ///< penalty is known to the solver
  std::optional<QueryState> memory[2];   ///< of side 0's points in side 1's map, and the reverse
  std::vector<std::uint32_t> always[2];  ///< ids of the points last chosen, for the query
  unsigned revision[2] = {0, 0};         ///< of the shapes that writer's and selection's ids belong to
};

}  // namespace vps::bullet
