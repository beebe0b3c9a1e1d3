// SPDX-License-Identifier: BSD-3-Clause
// Registers VPS contact with the dispatcher of an ordinary, unpatched Bullet world.
#pragma once

#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"
#include "vps_bullet/settings.h"
#include "vps_bullet/tune.h"

class btCollisionDispatcher;

namespace vps::bullet {

/// Makes every bullet::Shape collide in worlds that use this dispatcher: with each other and with Bullet's
/// own shapes, in contact and closest-point queries, in both orders, for every shape type (listed in
/// native_shapes.md). Existing pairs are included. A second call replaces the settings. Sets a near callback,
/// which calls the host's near callback. See tuneWorld() for the parameters of the world. Throws
/// std::invalid_argument for settings out of range, Bullet in another precision, and btCollisionDispatcherMt
/// with several threads.
VPS_BULLET_API void install(btCollisionDispatcher& dispatcher, const Settings& settings = {});

/// Restores the functions that were registered before install(), except functions that have been replaced
/// since. Existing pairs keep VPS contact until their bodies separate or are removed; a message (log.h) says
/// so. Does nothing without an installation. A dispatcher may also be destroyed without this call; another
/// dispatcher created later at the same address starts without an installation.
VPS_BULLET_API void uninstall(btCollisionDispatcher& dispatcher);

[[nodiscard]] VPS_BULLET_API bool isInstalled(const btCollisionDispatcher& dispatcher);
/// Counters since install(); all zero without an installation.
[[nodiscard]] VPS_BULLET_API Stats stats(const btCollisionDispatcher& dispatcher);

}  // namespace vps::bullet
