// SPDX-License-Identifier: BSD-3-Clause
// The program `vps`: reads the command line, runs the chosen command, and turns exceptions into one line on
// stderr and an exit status.
#include <algorithm>
#include <new>

#include "output/command.h"
#include "output/terminal.h"
#include "vps/version.h"

namespace vps::viewer {

// Each command_NAME.cpp defines one of these functions.
#define COMMAND(add, name, summary, example) std::function<int()> add(CLI::App& command);
#include "commands/command_list.inc"
#undef COMMAND

namespace {

/// A row of command_list.inc.
struct Command {
  std::function<int()> (*add)(CLI::App& command);
  const char *name, *summary, *example;
};

constexpr Command kCommands[] = {
#define COMMAND(add, name, summary, example) {add, name, summary, example},
#include "commands/command_list.inc"
#undef COMMAND
};

int couldNot(const std::string& reason) {
  say(reason);
  return kCouldNot;
}

/// CLI11 reports an unknown command as a missing command, and surplus arguments in reverse order.
std::string reasonOf(const CLI::ParseError& error, const CLI::App& app) {
  const bool has_command = !app.get_subcommands().empty();
  const auto left_over = app.remaining(true);
  const bool is_extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (has_command && !left_over.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
      !app.get_subcommands().front()->get_subcommands({}).empty())
    return "unknown: '" + app.get_subcommands().front()->get_name() + " " + left_over.front() + "'";
  if (left_over.empty() || (has_command && !is_extra)) return error.what();
  const auto option = std::ranges::find_if(left_over, [](const auto& one) { return one.starts_with('-'); });
  if (has_command && option != left_over.end()) return "unknown option '" + *option + "'";
  if (!has_command)
    return (option == left_over.begin() ? "unknown option '" : "unknown command '") + left_over.front() + "'";
  std::string words = left_over.size() == 1 ? "one argument is too many:" : "these arguments are too many:";
  for (const std::string& argument : left_over) words += " '" + argument + "'";
  return words;
}

int run(int argc, char** argv) {
  CLI::App app;
  std::function<int()> run_chosen;
  app.name("vps");
  app.description(
      "Voxmap-PointShell contact on CAD parts: import, assemble, simulate, query, measure, draw.");
  app.set_version_flag("--version", std::string("vps ") + VPS_VERSION_STRING);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done and good; 1 done, but the parts do not fit or a bound was missed; 2 not done;\n"
      "3 not shown: neither that the parts fit nor that they do not.\n"
      "Lengths carry a unit: 0.2mm, 20um, 0.01m. Example:\n"
      "  vps assemble scenes/peg_in_hole/scene.toml --out out");
  for (const Command& row : kCommands) {
    CLI::App* command = app.add_subcommand(row.name, row.summary);
    command->footer(std::string("Example:\n  ") + row.example);
    // Only stores the function: the command runs after the whole command line has been parsed.
    command->callback([&run_chosen, run = row.add(*command)] { run_chosen = run; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const std::string help = chosen.empty() ? "vps --help" : "vps " + chosen.front()->get_name() + " --help";
    return couldNot(reasonOf(error, app) + "; see " + help);
  }
  return run_chosen();
}

int runSafely(int argc, char** argv) {
  try {
    catchStop();
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return couldNot("not enough memory; use a coarser --voxel and --spacing, or a smaller part");
  } catch (const std::exception& error) {  // LoadError, Stopped, and exceptions of libraries
    return couldNot(error.what());
  } catch (...) {
    return couldNot("an unknown error; please report it with the command that caused it");
  }
}

}  // namespace

}  // namespace vps::viewer

int main(int argc, char** argv) {
  return vps::viewer::runSafely(argc, argv);
}
