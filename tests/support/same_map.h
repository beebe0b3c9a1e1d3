// SPDX-License-Identifier: BSD-3-Clause
// Compares voxmaps.
#pragma once

#include <gtest/gtest.h>

#include "support/analytic.h"
#include "vps/voxmap.h"

namespace vps::test {

/// Expects equal readings, to the bit.
inline void expectSame(const VoxMap& a, const VoxMap& b) {
  EXPECT_EQ(a.voxel_m(), b.voxel_m());
  EXPECT_EQ(a.band_m(), b.band_m());
  EXPECT_EQ(a.brickCount(), b.brickCount());
  EXPECT_EQ(a.sampleError_m(), b.sampleError_m());
  EXPECT_EQ(a.bounds().min, b.bounds().min);
  EXPECT_EQ(a.bounds().max, b.bounds().max);
  RandomPoints random(16);
  for (int n = 0; n < 40000; ++n) {
    const Vec3 p = a.bounds().center() + random.inBox(a.bounds().size());
    ASSERT_EQ(a.distance(p), b.distance(p));
    ASSERT_EQ(a.lowerBound(p), b.lowerBound(p));
    ASSERT_EQ(a.leastDistance(p), b.leastDistance(p));
    ASSERT_EQ(a.isInsideCoarse(p), b.isInsideCoarse(p));
    ASSERT_EQ(a.normal(p), b.normal(p));
  }
}

}  // namespace vps::test
