// SPDX-License-Identifier: BSD-3-Clause
// What was read from CAD files, kept between runs.
#pragma once

#include <optional>
#include <string>

#include "import/readers.h"

namespace vps::scenes::import {

/// What determines the parts of a STEP, IGES or BREP file, so that they can be kept by it: the file's bytes,
/// the settings, and versions. Empty for other formats, whose files name others, for a STEP file that does
/// so, and for a file that cannot be read.
/// @param reader  version of the library that reads it
std::string madeFrom(const std::string& file, const std::string& format, const ImportSettings& settings,
                     const std::string& reader);

/// Parts and warnings as bytes, which one machine reads back to the bit.
std::string keptBytes(const ImportedCad& cad);
/// Sets parts and warnings; false for bytes of another kind, which leave `cad` as it was.
bool readKeptBytes(const std::string& bytes, ImportedCad& cad);

}  // namespace vps::scenes::import
