// SPDX-License-Identifier: BSD-3-Clause
// The families of rows with a body of another mass, which restitutionFamilies() returns with others.
#pragma once

#include "family.h"

namespace vps::families {

std::vector<Family> massRatioFamilies();

}  // namespace vps::families
