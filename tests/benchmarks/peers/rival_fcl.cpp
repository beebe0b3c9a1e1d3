// SPDX-License-Identifier: BSD-3-Clause
// FCL may be compiled with other Eigen flags, so only plain numbers are passed to it.
#include "rivals.h"

#ifdef VPS_HAS_FCL
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#endif

namespace vps::bench {

#ifdef VPS_HAS_FCL
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Model> makeModel(const Mesh& mesh) {
  std::vector<fcl::Vector3d> vertices(mesh.vertices.begin(), mesh.vertices.end());
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

PairQuery fclQuery(const Mesh& a, const Mesh& b) {
  return {"FCL", [a = makeModel(a), b = makeModel(b)](const Pose& X_AB) {
            fcl::Transform3d X = fcl::Transform3d::Identity();
            X.linear() = X_AB.R;
            X.translation() = X_AB.p;
            const fcl::CollisionRequestd request(1'000'000, true);
            fcl::CollisionResultd result;
            fcl::collide(a.get(), fcl::Transform3d::Identity(), b.get(), X, request, result);
            PairQuery::Answer answer;
            answer.contacts = static_cast<int>(result.numContacts());
            for (std::size_t i = 0; i < result.numContacts(); ++i)
              answer.deepest_m = std::max(answer.deepest_m, std::abs(result.getContact(i).penetration_depth));
            return answer;
          }};
}
#else
PairQuery fclQuery(const Mesh&, const Mesh&) {
  return {"FCL", {}};
}
#endif

}  // namespace vps::bench
