// SPDX-License-Identifier: BSD-3-Clause
// All models of one part that contact needs, built once and never changed: name, mesh, material, voxmap,
// pointshell and solid.
#pragma once

#include <memory>
#include <string>

#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/pointshell.h"
#include "vps/solid.h"
#include "vps/voxmap.h"

namespace vps {

struct Material {
  double density_kg_m3 = 7850;  ///< steel
  double friction = 0.15;       ///< Coulomb coefficient of the material on itself; see combinedFriction()
  double restitution = 0;       ///< 0 inelastic to 1 elastic
  double stiffness_N_per_m3 = 1e12;  ///< penalty stiffness per area (Tripicchio et al., section 4.1)
};

/// How to read a mesh with a hole that is wider than the spacing of its points. Narrower holes, cracks,
/// T-junctions and single missing facets are faults of a solid in either case.
enum class OpenMesh {
  Sheet,  ///< a surface that other parts touch from both sides; its hole stays open
  Solid,  ///< a solid whose hole is a fault
};

/// The models of one part, all in the part's own frame P. It is held as `std::shared_ptr<const PartModel>` by
/// everything that needs the part's models (collision shape, fixed field, overlap judge), on any thread.
/// Parts of equal geometry share mesh, map, shell and solid and differ in name and material. Each pointer
/// may be null where nothing needs that model.
struct PartModel {
  std::string name;
  std::shared_ptr<const Mesh> mesh;
  Material material;
  std::shared_ptr<const VoxMap> map;  ///< null for a sheet, because a sheet has no inside
  std::shared_ptr<const PointShell> shell;
  std::shared_ptr<const Solid> solid;  ///< what map and shell are built from
};

/// Builds all models of a part, from one Solid. PartModel::mesh is the given mesh, or the solid's mesh if
/// facets had to be turned, so that its volume is positive; for a sheet it is the given mesh. Throws
/// LoadError as buildVoxMap() and buildPointShell().
/// @param open  how to read a mesh with a wide hole; for a sheet, `solid` is a Solid::sheet()
VPS_API std::shared_ptr<const PartModel> buildPartModel(const std::string& name, Mesh mesh,
                                                        const VoxMapSettings& voxels = {},
                                                        const PointShellSettings& points = {},
                                                        const Material& material = {},
                                                        OpenMesh open = OpenMesh::Sheet);

/// The same part with another sampling of its surface. All other models are shared with the given part.
VPS_API std::shared_ptr<const PartModel> withShell(const PartModel& model,
                                                   std::shared_ptr<const PointShell> shell);

}  // namespace vps
