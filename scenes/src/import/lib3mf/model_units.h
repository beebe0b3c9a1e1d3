// SPDX-License-Identifier: BSD-3-Clause
// What the model files of a 3MF archive say of their unit: lib3mf keeps that of the last one that it reads.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vps::scenes::inline v0::import {

struct ModelFile {
  std::string name;
  std::string unit = "millimeter";  ///< as stated; the default of the specification where it is not
};

struct ModelFiles {
  std::optional<ModelFile> root;  ///< which the build is in; nothing if it is not found
  std::vector<ModelFile> others;
};

/// Reads the beginnings of the files in the archive; never throws.
ModelFiles modelFiles(const std::string& archive);

/// Whether a model file has a number in place of a character, as "&#228;", which lib3mf 1.8.1 refuses.
bool hasNumbersForCharacters(const std::string& archive);

}  // namespace vps::scenes::inline v0::import
