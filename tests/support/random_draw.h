// SPDX-License-Identifier: BSD-3-Clause
// Random vectors and rotations that are the same with every compiler. The arguments of a call are evaluated
// in any order, so in Vec3(draw(), draw(), draw()) one compiler draws x first and another z; within braces
// the order is that of the text.
#pragma once

#include "vps/pose.h"

namespace vps::test {

/// Three draws: x, y, z.
template <typename Distribution, typename Generator>
Vec3 drawnVector(Distribution& draw, Generator& random) {
  return {draw(random), draw(random), draw(random)};
}

/// Four draws, w first; even over all rotations if `draw` is a normal distribution.
template <typename Distribution, typename Generator>
Quat drawnRotation(Distribution& draw, Generator& random) {
  return Quat{draw(random), draw(random), draw(random), draw(random)}.normalized();
}

}  // namespace vps::test
