// SPDX-License-Identifier: BSD-3-Clause
// Faults of STEP and IGES files that Open CASCADE 7.6.3 does not report or misreads.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <Interface_InterfaceModel.hxx>
#include <XSControl_Reader.hxx>

namespace vps::scenes::import {

// --- The text of a STEP file, before it is read (entity_numbers.cpp, plain_sections.cpp)

/// A STEP file's text with changed entity numbers where Open CASCADE would misread it; empty if no number
/// needs a change.
/// - A reference to an entity that is not in the file gets a number that no entity has: for #45, Open CASCADE
///   takes its own record 45 in that case, so that a lost point can become another one without an error.
/// - Entities with numbers of more than 2000000000, which Open CASCADE reads modulo 2^32, get smaller ones.
/// - A comment between an entity's number and its '=' is removed: Open CASCADE takes it for a syntax error.
/// O(n log n).
std::optional<std::string> withReadableNumbers(std::string_view text);

/// Writes the exponents of reals ("1.e-5") with a capital E, which ISO 10303-21 asks for and Open CASCADE
/// needs. True if an exponent was changed. O(n).
bool capitalizeExponents(std::string& text);

/// The text with one header and one data section; empty if no change is needed. ISO 10303-21 allows several
/// data sections, also with parameters, sections of anchors and references, a signature behind the end, and
/// blanks before a semicolon; Open CASCADE takes these for errors of syntax. A reference to another file
/// becomes a reference to an entity that is not in the file. O(n).
std::optional<std::string> withPlainSections(std::string_view text);

// --- The text of an IGES file (iges_lines.cpp)

/// The text without a byte order mark, empty lines at its end, and blanks behind column 80, which Open
/// CASCADE takes for errors of syntax; empty if no change is needed. O(n).
std::optional<std::string> withPlainLines(std::string_view text);

// --- Damaged entities (damaged_entities.cpp)

struct Damage {
  std::string lost_geometry;  ///< in words; empty: all geometry that the file's parts need was read
  std::string remark;  ///< on entities that are left out without loss of geometry; empty: no such entities
};

/// Finds entities that could not be read and cost geometry. Open CASCADE continues with null pointers, zeros
/// or defaults in their place. In STEP, an entity costs geometry if a shape of a product refers to it, at any
/// depth, unless the unread data is only a name, a pcurve that accompanies a curve in space, an uncertainty,
/// or an annotation or placement that accompanies a shape. In IGES, an entity costs geometry if it is a
/// curve, surface, solid, transformation, or an instance of one of these. O(entities and references).
Damage damageOf(const Handle(Interface_InterfaceModel) & model);

/// Mends colours that Open CASCADE misreads: predefined colours without a name, on which it crashes, get an
/// empty name, names in capitals get small letters, and shares a little outside of 0 to 1, with which it
/// takes all shares for numbers up to 255, are rounded to 0 or 1.
void mendColors(const Handle(Interface_InterfaceModel) & model);

// --- Units of length (length_units.cpp)

/// Open CASCADE assumes millimetres for a file without a unit, and accepts a negative factor.
struct LengthUnits {
  bool is_stated = true;  ///< at least one shape has a unit
  std::string remark;     ///< on shapes without a unit in a file where other shapes have units; empty: none
  std::string fault;      ///< a unit whose factor is not positive, in words; empty: there is none
};

/// Makes units of STEP that are based on other converted units, such as feet of 12 inches, units of the SI
/// unit on which these are based; Open CASCADE takes the first for millimetres without a message. Gives IGES
/// files whose unit has a name in small letters or in words ("mm", "INCHES") the flag of this unit.
/// O(entities).
void mendUnits(const Handle(Interface_InterfaceModel) & model);

/// O(entities).
LengthUnits lengthUnits(const Handle(Interface_InterfaceModel) & model);

// --- Shapes of a STEP file that are in no part (lost_shapes.cpp)

/// Losses in a file that the reader has transferred, in words; a text is empty if there is no such loss.
struct LostShapes {
  /// Instances of products with a shape that have no placement, so that the assembly lacks them.
  std::string unplaced;
  /// Solids that belong to no product, that are of kinds which Open CASCADE does not read, or whose
  /// translation failed.
  std::string left_out;
};

/// O(entities).
LostShapes lostShapes(const XSControl_Reader& reader);

}  // namespace vps::scenes::import
