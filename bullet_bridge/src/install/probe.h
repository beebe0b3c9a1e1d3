// SPDX-License-Identifier: BSD-3-Clause
// Looks whether a dispatcher is one that VPS contact can work with.
#pragma once

class btCollisionDispatcher;

namespace vps::bullet {

/// Throws std::invalid_argument where Bullet's library, or the code that made the dispatcher, was compiled in
/// the other precision: the headers of this package were not, and the two would not agree about any type.
void requireSamePrecision(const btCollisionDispatcher& dispatcher);

/// Throws std::invalid_argument for a btCollisionDispatcherMt with a task scheduler of several threads, whose
/// manifolds come in another order in each run.
void requireOneThread(const btCollisionDispatcher& dispatcher);

}  // namespace vps::bullet
