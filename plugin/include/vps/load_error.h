// SPDX-License-Identifier: BSD-3-Clause
// The exception of loading and saving: in which file and part, what was found, and what would help.
#pragma once

#include <stdexcept>
#include <string>

#include "vps/export.h"

namespace vps {

/// Thrown while loading or saving files and while building models; never in the haptic loop. what() is one
/// line for a person: "gear.stl: part 'hub': vertex 17 is not a number; export it again".
class VPS_API LoadError : public std::runtime_error {
 public:
  LoadError(const std::string& file, const std::string& part, const std::string& found_and_remedy)
      : std::runtime_error((file.empty() ? std::string() : file + ": ") +
                           (part.empty() ? std::string() : "part '" + part + "': ") + found_and_remedy) {}
};

}  // namespace vps
