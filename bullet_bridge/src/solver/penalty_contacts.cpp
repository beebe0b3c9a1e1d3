// SPDX-License-Identifier: BSD-3-Clause
#include "solver/penalty_contacts.h"

#include "solver/dispatch_table.h"

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

}  // namespace vps::bullet
