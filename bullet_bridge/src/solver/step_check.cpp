// SPDX-License-Identifier: BSD-3-Clause
#include "solver/step_check.h"

namespace vps::bullet {

void StepChecks::add(const btPersistentManifold* manifold, StepCheck* check) {
  const std::lock_guard lock(mutex_);
  checks_[manifold] = check;
}

void StepChecks::remove(const btPersistentManifold* manifold) {
  const std::lock_guard lock(mutex_);
  checks_.erase(manifold);
}

StepCheck* StepChecks::find(const btPersistentManifold* manifold) const {
  const auto it = checks_.find(manifold);
  return it == checks_.end() ? nullptr : it->second;
}

}  // namespace vps::bullet
