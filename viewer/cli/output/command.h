// SPDX-License-Identifier: BSD-3-Clause
// The parts of a subcommand of `vps`. A source command_NAME.cpp defines one function
//
//   std::function<int()> addName(CLI::App& command);
//
// which adds the options to the command and returns the function that runs it after the command line has been
// parsed. The returned function returns an exit status or throws; main.cpp turns an exception into one line
// on stderr and kCouldNot. A row of commands/command_list.inc names the function and holds the command's
// help.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace vps::viewer {

/// Exit status of the program.
inline constexpr int kGood = 0;      ///< done, and the answer is good
inline constexpr int kBad = 1;       ///< done, and the parts do not fit or a bound was missed
inline constexpr int kCouldNot = 2;  ///< bad input or use; one line on stderr gives the reason
inline constexpr int kNotShown = 3;  ///< done, and neither fit nor misfit was established

/// Adds --json FILE.
inline void addJsonOption(CLI::App& command, std::string& file) {
  command.add_option("--json", file, "write the results to this file as JSON")->type_name("FILE");
}

}  // namespace vps::viewer
