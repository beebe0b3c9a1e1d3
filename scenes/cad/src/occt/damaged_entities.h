// SPDX-License-Identifier: BSD-3-Clause
// Which damaged entities of a STEP or IGES file cost geometry, and which only names, styles or remarks.
#pragma once

#include <string>

#include <Interface_InterfaceModel.hxx>

namespace vps::scenes::import {

struct Damage {
  std::string lost_geometry;  ///< in words; empty: all geometry that the file's parts need is there
  std::string remark;         ///< on entities that are left out without loss of geometry; empty: none are
};

/// Open CASCADE continues with null pointers, zeros or defaults in place of what it could not read. In STEP,
/// an entity costs geometry if a shape of a product refers to it, at any depth, and what could not be read is
/// more than a name, a pcurve beside its curve in space, an uncertainty, or an annotation or placement beside
/// a shape. In IGES, if it is a curve, surface, solid, transformation, or an instance of one of these.
/// O(entities and references).
Damage damageOf(const Handle(Interface_InterfaceModel) & model);

/// Gives predefined colours without a name, on which Open CASCADE 7.6.3 crashes, an empty one.
void nameColors(const Handle(Interface_InterfaceModel) & model);

}  // namespace vps::scenes::import
