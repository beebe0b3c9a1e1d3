// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact_stores.h"

namespace vps::bullet {

void PenaltyContacts::add(const btPersistentManifold* manifold, PenaltyPair* pair) {
  const std::lock_guard lock(mutex_);
  pairs_[manifold] = pair;
}

void PenaltyContacts::remove(const PenaltyPair* pair) {
  const std::lock_guard lock(mutex_);
  std::erase_if(pairs_, [&](const auto& entry) { return entry.second == pair; });
}

PenaltyPair* PenaltyContacts::find(const btPersistentManifold* manifold) const {
  const auto it = pairs_.find(manifold);
  return it == pairs_.end() ? nullptr : it->second;
}

ContactCreateFunction* contactFunctionOf(const btDispatcher* dispatcher) {
  const auto* table = dynamic_cast<const btCollisionDispatcher*>(dispatcher);
  if (!table) return nullptr;
  return dynamic_cast<ContactCreateFunction*>(DispatchTable::contact(*table)[kShapeType][kShapeType]);
}

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
