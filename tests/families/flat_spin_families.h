// SPDX-License-Identifier: BSD-3-Clause
// The families of bodies that spin flat on a plate, which rotationFamilies() returns with others.
#pragma once

#include "family.h"

namespace vps::families {

std::vector<Family> flatSpinFamilies();

}  // namespace vps::families
