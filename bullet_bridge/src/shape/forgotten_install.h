// SPDX-License-Identifier: BSD-3-Clause
// Tells a host that never called install(), whose parts would fall through planes without a message.
#pragma once

namespace vps::bullet {

/// install() was called for any dispatcher of the process.
void setContactInstalled();
[[nodiscard]] bool isContactInstalled();

/// Called with each bounding box that Bullet asks of a Shape while there is no installation. Bodies may be
/// added before install() is called, so it speaks at a later call, once.
void warnOfForgottenInstall();

}  // namespace vps::bullet
