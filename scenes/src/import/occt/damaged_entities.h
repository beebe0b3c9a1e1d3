// SPDX-License-Identifier: BSD-3-Clause
// Which damaged entities of a STEP or IGES file cost geometry, and which only names, styles or remarks.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <Interface_InterfaceModel.hxx>
#include <XSControl_Reader.hxx>

namespace vps::scenes::inline v0::import {

struct Damage {
  std::string lost_geometry;  ///< in words; empty: all geometry that the file's parts need is there
  std::string remark;         ///< on what was left out without loss of geometry; empty: nothing
};

/// Open CASCADE continues with null pointers, zeros or defaults in place of what it could not read. In STEP,
/// an entity costs geometry if a shape of a product refers to it, at any depth, and what could not be read is
/// more than a name, a pcurve beside its curve in space, an uncertainty, or an item that no topology belongs
/// to. In IGES, if it is a curve, surface, solid, transformation, or an instance of some.
/// A predefined colour without a name, on which Open CASCADE 7.6.3 crashes, gets an empty one.
/// O(entities and references).
Damage damageOf(const Handle(Interface_InterfaceModel) & model);

/// On solids of a STEP file that the reader transferred of which no shape was made, in words; empty if there
/// are none.
std::string unplacedShapes(const XSControl_Reader& reader);

/// A STEP file's text with #2000000000 in place of each reference to an entity that is not in the file; empty
/// if there is none. Open CASCADE 7.6.3 takes #45 for its own record 45 in that case, whatever this is, so
/// that a point that is missing can become another one without an error.
std::optional<std::string> withPlainlyLostReferences(std::string_view text);

}  // namespace vps::scenes::inline v0::import
