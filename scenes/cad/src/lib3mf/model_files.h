// SPDX-License-Identifier: BSD-3-Clause
// The model files in a 3MF archive as texts, read by minizip, for facts that lib3mf 1.8.1 does not report or
// misreads.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vps::scenes::import {

/// A copy of the archive, uncompressed, without two things for which lib3mf 1.8.1 refuses it: the model files
/// have characters in place of their numbers ("&#228;"), and thumbnails that are not in the archive are not
/// named. Empty if there is nothing of these, or beyond 4 GB.
std::string readableArchive(const std::string& archive);

/// The first fault in a model file that lib3mf 1.8.1 does not report, in words; empty if there is none:
/// - a coordinate of a vertex with text after the number, as "4,5" and "4mm", which lib3mf reads as 4;
/// - a model whose XML ends before its root element does, of which lib3mf reads the objects before the end.
/// O(bytes); never throws.
std::string modelFault(const std::string& archive);

/// The first tag of a model file. lib3mf keeps only the unit of the last model file that it reads.
struct ModelFile {
  std::string name;
  std::string unit = "millimeter";    ///< as stated, or the default of the specification
  std::vector<std::string> required;  ///< namespaces of the extensions that a reader needs
};

struct ModelFiles {
  std::optional<ModelFile> root;  ///< the file with the build; empty if it is not found
  std::vector<ModelFile> others;
};

/// Reads the beginning of each model file in the archive; never throws.
ModelFiles modelFiles(const std::string& archive);

}  // namespace vps::scenes::import
