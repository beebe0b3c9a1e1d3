// SPDX-License-Identifier: BSD-3-Clause
// The refusal of a format whose library this build lacks.
#pragma once

#include <string>
#include <string_view>

#include "vps/errors.h"

namespace vps::scenes::import {

inline constexpr std::string_view kLacks = ", which this build lacks; install ";

inline LoadError missingLibrary(const std::string& file, const std::string& format,
                                const std::string& library, const std::string& package) {
  return {file, "", (format + " needs " + library).append(kLacks) + package + " and build again"};
}

/// Recognizes the error by its words, since errors come from the reader's process as text.
inline bool isMissingLibrary(const LoadError& error) {
  return std::string_view(error.what()).find(kLacks) != std::string_view::npos;
}

}  // namespace vps::scenes::import
