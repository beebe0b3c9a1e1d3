// SPDX-License-Identifier: BSD-3-Clause
// The fixed field: all parts in place, merged ("cooked") into one voxmap, one pointshell and one body (paper,
// section 5). It is made from immutable models on any thread, so a run need not stop for it.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "vps/fidelity.h"
#include "vps/part_model.h"
#include "vps_bullet/shape.h"

namespace vps::scenes {

/// What contacts with a part of this material take from it. Bullet multiplies the two bodies' values: with
/// square roots the product of friction is the geometric mean, so that two parts of 0.15 have 0.15 between
/// them, as in tables of friction.
bullet::SurfaceMaterial surfaceMaterial(const Material& material);
/// The models of a moving part, with its material.
bullet::ShapeModels shapeModels(const PartModel& model);

/// A part in place.
struct FixedPart {
  std::size_t part = 0;
  Pose X_WP;
};

/// A part in place, with its models.
struct FieldPart {
  FixedPart placed;
  std::shared_ptr<const PartModel> model;  ///< mesh and surface; its map may be null, its shell as well
  std::vector<Box> kept_P;                 ///< as PartModelPlan::kept_P
};

/// All that cookField() reads.
struct FieldOrder {
  std::vector<FieldPart> parts;         ///< in the field's owner order
  std::shared_ptr<const VoxMap> below;  ///< the merged map of the first parts, to build on; null: none
  std::size_t below_count = 0;          ///< how many parts `below` holds
  std::optional<Box> region_W;          ///< where points are needed; none: everywhere
  bool has_shell = true;
  bool has_mesh = false;       ///< triangles for ray tests as well; a run needs none
  bool rebuilds_maps = false;  ///< every map is built from its mesh, and the parts' own maps are not used
  Fidelity fidelity;
  const std::atomic<bool>* stop = nullptr;  ///< ends cooking between two parts when set; may be null
};

struct CookedField {
  std::vector<FixedPart> parts;
  std::optional<Box> region_W;
  std::unique_ptr<bullet::Shape> shape;
  double wall_s = 0;  ///< time to cook

  /// Memory in addition to the parts' own models.
  [[nodiscard]] std::size_t memoryBytes(const std::vector<std::shared_ptr<const VoxMap>>& own) const;
};

/// Cooks a field from the parts' own meshes and, where given, from `below`, to which the other parts are
/// added. O(surface of the added parts) and O(points in the region). Same input, same bits. Throws LoadError
/// as cookVoxMap(). When stopped, the result may have no shape; an order without parts has none.
CookedField cookField(const FieldOrder& order);

}  // namespace vps::scenes
