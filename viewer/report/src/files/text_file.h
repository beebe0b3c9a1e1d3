// SPDX-License-Identifier: BSD-3-Clause
// A file's contents.
#pragma once

#include <string>

namespace vps::viewer {

/// Its bytes; empty where it cannot be read.
std::string textOf(const std::string& file);

}  // namespace vps::viewer
