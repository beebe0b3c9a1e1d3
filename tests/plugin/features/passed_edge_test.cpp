// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/feature_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/feature_body.h"
#include "support/fit.h"

namespace vps {
namespace {

const Vec3 kHalf(3e-3, 2e-3, 2e-3);
constexpr double kTolerated_m = 90e-9;

std::uint32_t topFacetAtTheEdge(const FeatureSet& part) {
  for (std::uint32_t i = 0; i < part.facets().size(); ++i) {
    int on_edge = 0;
    for (const std::uint32_t v : part.facets()[i]) on_edge += part.vertices()[v].y() > 0;
    if (part.normal(i).z() > 0.9 && on_edge == 2) return i;
  }
  return FeatureSet::kNone;
}

// A corner is 30 nm above a box's top and 50 nm beside its wall, and moves down. The corner passes the top's
// plane next to the wall, which therefore has the contact, unless the corner's own surface keeps it from
// touching walls.
TEST(BorderOwner, IsAFaceOnlyIfTheCornerCanTouchIt) {
  const test::FeatureBody box(makeBox(2 * kHalf));
  const std::uint32_t top = topFacetAtTheEdge(box.features);
  ASSERT_NE(top, FeatureSet::kNone);
  const Vec3 q(0, kHalf.y(), kHalf.z());
  const auto ownerWith = [&](const std::vector<Vec3>& rays) {
    const PassingCorner corner{Vec3(0, 50e-9, 30e-9), Vec3(0, -1e-6, -10e-6), rays, Mat3::Identity()};
    return ownerAtBorder(box.features, top, q, corner, kTolerated_m);
  };
  EXPECT_EQ(ownerWith({Vec3(0, 0.6, 0.8), Vec3(0.8, 0.1, 0.6)}), BorderOwner::Neighbour);
  EXPECT_EQ(ownerWith({Vec3(0, -0.6, 0.8), Vec3(0.8, 0.1, 0.6)}), BorderOwner::Edge);
}

}  // namespace
}  // namespace vps
