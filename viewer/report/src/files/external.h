// SPDX-License-Identifier: BSD-3-Clause
// Other programs (gnuplot, ffmpeg, Chromium), and the files of other packages.
#pragma once

#include <string>
#include <vector>

namespace vps::viewer {

/// Runs a program that PATH finds, without a shell. Returns an empty text on success, `missing` if there is
/// no such program, and otherwise the start of the program's output.
/// @param words  the program's name and arguments
/// @param input  the program's standard input
std::string runProgram(const std::vector<std::string>& words, const std::string& input,
                       const std::string& missing);

/// Whether PATH finds a program of this name.
bool hasProgram(const std::string& name);

/// The bytes of a file; empty if it cannot be read.
std::string textOf(const std::string& file);

/// Folder of three.js, which draws in browsers, in Debian's package libjs-three.
inline constexpr const char* kThreeFolder = "/usr/share/javascript/three/";

}  // namespace vps::viewer
