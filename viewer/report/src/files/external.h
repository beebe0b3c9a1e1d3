// SPDX-License-Identifier: BSD-3-Clause
// Other programs (gnuplot, ffmpeg, Chromium), and the files of other packages.
#pragma once

#include <string>
#include <vector>

namespace vps::viewer {

/// Runs a program that is found by PATH, without a shell. Returns nothing on success, and otherwise the
/// reason: `missing` where there is no such program, else with the start of what it printed.
/// @param words  its name and arguments
/// @param input  what it reads on stdin
std::string runProgram(const std::vector<std::string>& words, const std::string& input,
                       const std::string& missing);

/// Whether PATH has it.
bool hasProgram(const std::string& name);

/// Its bytes; empty where it cannot be read.
std::string textOf(const std::string& file);

inline constexpr const char* kThreeFolder =
    "/usr/share/javascript/three/";  // of Debian's package libjs-three

}  // namespace vps::viewer
