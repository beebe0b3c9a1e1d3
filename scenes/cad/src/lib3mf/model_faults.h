// SPDX-License-Identifier: BSD-3-Clause
// Faults in the model files of a 3MF archive that lib3mf 1.8.1 reads over without a word.
#pragma once

#include <string>

namespace vps::scenes::import {

/// The first fault, in words; empty if there is none:
/// - a coordinate of a vertex that is not a number as a whole, as "4,5" and "4mm", of which lib3mf takes 4;
/// - a model whose XML ends before its root element does, of which lib3mf takes the objects before the end.
/// O(bytes); never throws.
std::string modelFault(const std::string& archive);

}  // namespace vps::scenes::import
