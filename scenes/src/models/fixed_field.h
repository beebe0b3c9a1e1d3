// SPDX-License-Identifier: BSD-3-Clause
// What is fixed, cooked into one field and one body (paper, section 5). Made from immutable parts on any
// thread, so that a run need not stand still for it.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "vps/fidelity.h"
#include "vps/mesh_distance.h"
#include "vps/part.h"
#include "vps_bullet/shape.h"

namespace vps::scenes {

/// A part in place.
struct FixedPart {
  std::size_t part = 0;
  Pose X_WP;
};

/// A part in place with all that cooking reads of it. The mesh outlives the cooking.
struct FieldPart {
  FixedPart placed;
  const Mesh* mesh = nullptr;
  std::shared_ptr<const VoxMap> map;        ///< its own, may be null
  std::shared_ptr<const PointShell> shell;  ///< its own; null where the field gets none
  std::shared_ptr<const MeshDistance> surface;
  std::vector<Box> kept_P;  ///< as PlannedPart::kept_P
};

struct FieldOrder {
  std::vector<FieldPart> parts;         ///< in the field's owner order
  std::shared_ptr<const VoxMap> below;  ///< of the first of them, cooked before; null: none
  std::size_t below_count = 0;          ///< how many
  std::optional<Box> region_W;          ///< where points are needed; none: everywhere
  bool has_shell = true;
  bool has_mesh = false;     ///< triangles too, for rays: nothing in a run asks for them
  bool builds_anew = false;  ///< nothing of the parts' own maps is used
  Fidelity fidelity;
  const std::atomic<bool>* stop = nullptr;  ///< ends it between two parts when set; may be null
};

struct CookedField {
  std::vector<FixedPart> parts;
  std::optional<Box> region_W;
  std::unique_ptr<bullet::Shape> shape;
  double wall_s = 0;  ///< what it took

  /// Beside the parts' own models.
  [[nodiscard]] std::size_t memoryBytes(const std::vector<std::shared_ptr<const VoxMap>>& own) const;
};

/// From the parts' own meshes, never from a field already merged but `below`, to which they are added. O(the
/// surface of what is new) and O(points in the region). Same input, same bits. Throws LoadError as
/// cookVoxMap(). Stopped, it may come without a shape.
CookedField cookField(const FieldOrder& order);

}  // namespace vps::scenes
