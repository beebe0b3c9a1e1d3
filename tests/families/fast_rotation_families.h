// SPDX-License-Identifier: BSD-3-Clause
// The families of fast rotation, which rotationFamilies() returns with others.
#pragma once

#include "family.h"

namespace vps::families {

std::vector<Family> fastRotationFamilies();

}  // namespace vps::families
