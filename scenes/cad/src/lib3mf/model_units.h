// SPDX-License-Identifier: BSD-3-Clause
// What the model files of a 3MF archive say in their first tag and lib3mf does not tell. Of the unit it keeps
// that of the last model file that it reads.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vps::scenes::import {

struct ModelFile {
  std::string name;
  std::string unit = "millimeter";    ///< as stated; the default of the specification where it is not
  std::vector<std::string> required;  ///< the namespaces of the extensions that are needed to read it
};

struct ModelFiles {
  std::optional<ModelFile> root;  ///< which the build is in; nothing if it is not found
  std::vector<ModelFile> others;
};

/// Reads the beginnings of the files in the archive; never throws.
ModelFiles modelFiles(const std::string& archive);

}  // namespace vps::scenes::import
