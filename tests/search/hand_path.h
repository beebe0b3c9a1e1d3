// SPDX-License-Identifier: BSD-3-Clause
// The pose of a hand's proxy over time.
#pragma once

#include "case.h"
#include "vps/coupling_law.h"

namespace vps::search {

/// Moves from goal to goal, straight and turning evenly.
class HandPath {
 public:
  HandPath(const Hand& hand, const Pose& X_start);
  /// Advances by dt_s and returns the state at the end of the step.
  CouplingState advance(double dt_s);

 private:
  const std::vector<Hand::Goal>& goals_;
  std::size_t next_ = 0;
  Pose X_W_;
};

}  // namespace vps::search
