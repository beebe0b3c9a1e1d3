// SPDX-License-Identifier: BSD-3-Clause
// Random vectors and rotations whose components are drawn in the same order by every compiler. The arguments
// of a call may be evaluated in any order, so in Vec3(draw(), draw(), draw()) one compiler draws x first and
// another one z; within braces the order is that of the text.
#pragma once

#include "vps/pose.h"

namespace vps::test {

/// A vector from three draws, in the order x, y, z.
template <typename Distribution, typename Generator>
Vec3 drawnVector(Distribution& draw, Generator& random) {
  return {draw(random), draw(random), draw(random)};
}

/// A rotation from four draws, w first; uniformly distributed over all rotations if `draw` is a normal
/// distribution.
template <typename Distribution, typename Generator>
Quat drawnRotation(Distribution& draw, Generator& random) {
  return Quat{draw(random), draw(random), draw(random), draw(random)}.normalized();
}

}  // namespace vps::test
