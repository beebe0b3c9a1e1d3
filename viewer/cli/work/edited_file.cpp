// SPDX-License-Identifier: BSD-3-Clause
#include "work/edited_file.h"

#include <filesystem>

#include "vps/errors.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;

/// A rename would replace a file that is write-protected as well. Returns its name.
const std::string& requireWritable(const std::string& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw LoadError(file, "", "is no ordinary file, so it cannot be edited");
  constexpr fs::perms kAnyWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if (fs::exists(status) && (status.permissions() & kAnyWrite) == fs::perms::none)
    throw LoadError(file, "", "is write-protected; allow writing (chmod u+w), or write a copy");
  return file;
}

}  // namespace

EditedFile::EditedFile(const std::string& file, std::span<const scenes::TomlValue> values)
    : out_(requireWritable(file), {}) {
  out_.stage(scenes::editedToml(file, values));
  std::error_code error;
  fs::permissions(out_.partial(), fs::status(file, error).permissions(), error);
  if (error) throw LoadError(file, "", "cannot be written: " + error.message() + "; choose another place");
}

}  // namespace vps::viewer
