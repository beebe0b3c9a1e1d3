// SPDX-License-Identifier: BSD-3-Clause
// Single values of a TOML file are changed; its comments, order and all other bytes stay.
#pragma once

#include <span>
#include <string>

#include "vps_scenes/export.h"

namespace vps::scenes {

/// A key of one of the file's tables, and its new value as TOML text: {"device", "scale", "0.25"}.
struct TomlValue {
  std::string table, key, value;
};

/// The text of a TOML file with these values in place of the ones it has; a key or table that it lacks is
/// added. Every other byte stays as it is. The result is read again: it differs from the file by these values
/// alone. Throws LoadError when the file cannot be read or is no TOML, and when a value is written in a form
/// that this function cannot replace (as a table of its own, for example).
VPS_SCENES_API std::string editedToml(const std::string& file, std::span<const TomlValue> values);

}  // namespace vps::scenes
