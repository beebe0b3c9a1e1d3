// SPDX-License-Identifier: BSD-3-Clause
// A solid in two forms: as a set of features, and for exact overlap.
#pragma once

#include <memory>

#include "vps/feature_set.h"
#include "vps/mesh_overlap.h"

namespace vps::test {

struct FeatureBody {
  FeatureSet features;
  OverlapMesh exact;

  explicit FeatureBody(const Mesh& mesh) : exact(std::make_shared<const Solid>(mesh)) {
    features.append(exact.mesh(), Pose(), false);
    features.build();
  }
};

}  // namespace vps::test
