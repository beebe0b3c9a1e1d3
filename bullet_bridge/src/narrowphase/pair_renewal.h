// SPDX-License-Identifier: BSD-3-Clause
// Frees a pair's algorithm when the shapes of its bodies have been swapped, so that Bullet makes a new one.
#pragma once

struct btBroadphasePair;
class btCollisionDispatcher;

namespace vps::bullet {

/// Bullet keeps a pair's algorithm while its bodies are near each other, whatever shapes they get. Frees it
/// where it was made for other shapes, or before install(), or by a function that GImpact registered over
/// ours. Does nothing for pairs that VPS contact has no part in, and without an installation.
void renewIfSwapped(btBroadphasePair& pair, btCollisionDispatcher& dispatcher);

}  // namespace vps::bullet
