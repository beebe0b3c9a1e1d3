// SPDX-License-Identifier: BSD-3-Clause
#include "family.h"

namespace vps::families {

std::vector<Family> openSurfaceFamilies() {
  return {};
}

}  // namespace vps::families
