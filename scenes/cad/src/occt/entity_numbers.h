// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a STEP file's text, as Open CASCADE can read them: those of entities, and reals.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vps::scenes::import {

/// A STEP file's text with changed entity numbers where Open CASCADE 7.6.3 would misread it; empty if it
/// would not.
/// - A reference to an entity that is not in the file gets a number that no entity has: for #45, Open CASCADE
///   takes its own record 45 in that case, so that a lost point can become another one without an error.
/// - Entities with numbers of more than 2000000000, which Open CASCADE reads modulo 2^32, get smaller ones.
/// - A comment between an entity's number and its '=' is removed: Open CASCADE takes it for a syntax error.
/// O(n log n).
std::optional<std::string> withReadableNumbers(std::string_view text);

/// Writes the exponents of reals ("1.e-5") with a capital E, which ISO 10303-21 asks for and Open CASCADE
/// needs. True if there was one to change. O(n).
bool capitalizeExponents(std::string& text);

}  // namespace vps::scenes::import
