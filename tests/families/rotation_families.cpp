// SPDX-License-Identifier: BSD-3-Clause
#include "fast_rotation_families.h"

namespace vps::families {

std::vector<Family> rotationFamilies() {
  return fastRotationFamilies();
}

}  // namespace vps::families
