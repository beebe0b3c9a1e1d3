// SPDX-License-Identifier: BSD-3-Clause
#include "rivals.h"

#ifdef VPS_HAS_ODE
#include <ode/ode.h>
#endif

namespace vps::bench {

#ifdef VPS_HAS_ODE
namespace {

/// A trimesh and the arrays that it refers to.
struct OdeMesh {
  std::vector<double> vertices;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data = dGeomTriMeshDataCreate();
  dGeomID geom = nullptr;

  explicit OdeMesh(const Mesh& mesh) {
    for (const Vec3& p : mesh.vertices) vertices.insert(vertices.end(), {p.x(), p.y(), p.z()});
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t v : t) indices.push_back(static_cast<dTriIndex>(v));
    dGeomTriMeshDataBuildDouble(data, vertices.data(), 3 * sizeof(double),
                                static_cast<int>(mesh.vertices.size()), indices.data(),
                                static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
    geom = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
  }
  ~OdeMesh() {
    dGeomDestroy(geom);
    dGeomTriMeshDataDestroy(data);
  }
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;

  void moveTo(const Pose& X) const {
    dMatrix3 R;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) R[4 * i + j] = j < 3 ? X.R(i, j) : 0;
    dGeomSetPosition(geom, X.p.x(), X.p.y(), X.p.z());
    dGeomSetRotation(geom, R);
  }
};

}  // namespace

PairQuery odeQuery(const Mesh& a, const Mesh& b) {
  [[maybe_unused]] static const int started = dInitODE2(0);
  dSetMessageHandler(
      [](int, const char*, va_list) {});  // suppresses a message for each full table of contacts
  const auto mesh_a = std::make_shared<OdeMesh>(a), mesh_b = std::make_shared<OdeMesh>(b);
  return {"ODE", [mesh_a, mesh_b](const Pose& X_AB) {
            constexpr int kMaxContacts = 0xffff;  // limit of dCollide's flags
            static std::vector<dContactGeom> contacts(kMaxContacts);
            // The calls have the order of ODE's own loop, since a trimesh keeps its last pose for its
            // normals.
            mesh_a->moveTo(Pose());
            mesh_b->moveTo(X_AB);
            PairQuery::Answer answer;
            answer.contacts =
                dCollide(mesh_a->geom, mesh_b->geom, kMaxContacts, contacts.data(), sizeof(dContactGeom));
            for (int i = 0; i < answer.contacts; ++i)
              answer.deepest_m = std::max(answer.deepest_m, contacts[static_cast<std::size_t>(i)].depth);
            return answer;
          }};
}
#else
PairQuery odeQuery(const Mesh&, const Mesh&) {
  return {"ODE", {}};
}
#endif

}  // namespace vps::bench
