// SPDX-License-Identifier: BSD-3-Clause
// The fixed field: all parts in place, merged ("cooked") into one voxmap, one pointshell and one body (paper,
// section 5). Any thread can make it from immutable models, so a run need not stop for it.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "vps/fidelity.h"
#include "vps/part_model.h"
#include "vps_bullet/shape.h"

namespace vps::scenes {

/// The contact parameters of a part of this material. Bullet multiplies the friction values of two bodies.
/// Each value is the square root of a coefficient, so that the product is the geometric mean: two parts of
/// 0.15 have 0.15 between them, as in tables of friction.
bullet::SurfaceMaterial surfaceMaterial(const Material& material);
/// The models of a moving part, with its material.
bullet::ShapeModels shapeModels(const PartModel& model);

/// A part in place, by its index in Scene::parts.
struct FixedPart {
  std::size_t part = 0;
  Pose X_WP;
};

/// A part in place, with its models.
struct FieldPart {
  FixedPart placed;
  std::shared_ptr<const PartModel> model;  ///< mesh and surface; map and shell may be null
  std::vector<Box> kept_P;                 ///< see PartModelPlan::kept_P
};

/// The input of cookField().
struct FieldOrder {
  std::vector<FieldPart> parts;  ///< in the order of the field's owners
  std::shared_ptr<const VoxMap>
      below;  ///< merged map of the first parts, to which the other parts are added; null: none
  std::size_t below_count = 0;  ///< number of parts in `below`
  std::optional<Box> region_W;  ///< region that needs points; none: everywhere
  bool has_shell = true;
  bool has_mesh = false;       ///< the field also has triangles, for ray tests; a run needs no triangles
  bool rebuilds_maps = false;  ///< builds every map from its mesh instead of using the parts' own maps
  Fidelity fidelity;
  const std::atomic<bool>* stop = nullptr;  ///< when set, ends cooking between two parts; may be null
};

struct CookedField {
  std::vector<FixedPart> parts;
  std::optional<Box> region_W;
  std::unique_ptr<bullet::Shape> shape;
  double wall_s = 0;  ///< wall time of cooking the field

  /// Memory in addition to the parts' own models.
  [[nodiscard]] std::size_t memoryBytes(const std::vector<std::shared_ptr<const VoxMap>>& own) const;
};

/// Cooks a field from the parts' own meshes, beginning with FieldOrder::below if this map is given. O(surface
/// of the added parts) and O(points in the region). The same input gives the same bits. Throws LoadError as
/// cookVoxMap() does. The result has no shape for an order without parts, and may have no shape after a stop.
CookedField cookField(const FieldOrder& order);

}  // namespace vps::scenes
