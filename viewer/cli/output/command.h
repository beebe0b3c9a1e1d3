// SPDX-License-Identifier: BSD-3-Clause
// What a subcommand of `vps` is made of. Each command_*.cpp holds one: its options, its help and the function
// that runs it. command_list.inc names them.
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

/// The command line while the subcommands add themselves, and what the user chose.
struct CommandLine {
  CLI::App app;
  std::function<int()> run;  ///< the chosen subcommand; empty before app.parse()
};

/// Adds a subcommand, to which the caller adds options. It returns an exit status, or throws: main.cpp turns
/// exceptions into a line on stderr and kCouldNot.
/// @param example a command that works, for the help
CLI::App& addCommand(CommandLine& line, const std::string& name, const std::string& summary,
                     const std::string& example, std::function<int()> run);

/// --json FILE.
void addJsonOption(CLI::App& command, std::string& file);

}  // namespace vps::viewer
