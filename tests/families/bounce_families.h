// SPDX-License-Identifier: BSD-3-Clause
// The families of bounces under gravity, which restitutionFamilies() returns with others.
#pragma once

#include "family.h"

namespace vps::families {

std::vector<Family> bounceFamilies();

}  // namespace vps::families
