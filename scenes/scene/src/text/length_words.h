// SPDX-License-Identifier: BSD-3-Clause
// Lengths, angles and places in sentences.
#pragma once

#include <string>

#include "vps/pose.h"

namespace vps::scenes {

/// "12.3 um" below a millimetre, "1.23 mm" below a metre, "1.23 m" above.
std::string lengthInWords(double length_m);

/// "1.2 degrees"
std::string degreesInWords(double angle_rad);

/// "(1.00, 2.00, 3.00) mm"
std::string placeInWords(const Vec3& p_W);

}  // namespace vps::scenes
