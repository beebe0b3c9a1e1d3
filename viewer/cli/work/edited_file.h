// SPDX-License-Identifier: BSD-3-Clause
// A person's own TOML file in which a command changes single values.
#pragma once

#include <span>
#include <string>

#include "output/output.h"
#include "vps_scenes/scene/toml_edit.h"

namespace vps::viewer {

/// The edited text stands complete beside the file, with the file's permissions, until commit() replaces the
/// file by it; without commit() the file is as it was.
class EditedFile {
 public:
  /// Throws LoadError when the file cannot be read, edited or replaced.
  EditedFile(const std::string& file, std::span<const scenes::TomlValue> values);
  /// Throws LoadError; the file is then as it was.
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
};

}  // namespace vps::viewer
