// SPDX-License-Identifier: BSD-3-Clause
// The program `vps`: reads the command line, runs the chosen command, and turns exceptions into one line on
// stderr and an exit status.
#include <algorithm>
#include <new>

#include "output/command.h"
#include "output/terminal.h"
#include "vps/version.h"

namespace vps::viewer {

#define COMMAND(add) void add(CommandLine& line);
#include "commands/command_list.inc"
#undef COMMAND

namespace {

int couldNot(const std::string& reason) {
  say(reason);
  return kCouldNot;
}

/// CLI11 reports an unknown command as a missing one, and arguments that are too many in reverse order.
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
  CommandLine line;
  line.app.name("vps");
  line.app.description(
      "Voxmap-PointShell contact on CAD parts: import, assemble, simulate, query, measure, draw.");
  line.app.set_version_flag("--version", std::string("vps ") + VPS_VERSION_STRING);
  line.app.require_subcommand(1);
  line.app.footer(
      "Exit status: 0 done and good; 1 done, but the parts do not fit or a bound was missed; 2 not done;\n"
      "3 not shown: neither that the parts fit nor that they do not.\n"
      "Lengths carry a unit: 0.2mm, 20um, 0.01m. Example:\n"
      "  vps assemble scenes/peg_in_hole/scene.toml --out out");
#define COMMAND(add) add(line);
#include "commands/command_list.inc"
#undef COMMAND
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return line.app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    const auto chosen = line.app.get_subcommands();
    const std::string help = chosen.empty() ? "vps --help" : "vps " + chosen.front()->get_name() + " --help";
    return couldNot(reasonOf(error, line.app) + "; see " + help);
  }
  return line.run();
}

int runSafely(int argc, char** argv) {
  try {
    catchStop();
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return couldNot("not enough memory; use a coarser --voxel and --spacing, or a smaller part");
  } catch (const std::exception& error) {  // LoadError, Stopped, and what libraries throw
    return couldNot(error.what());
  } catch (...) {
    return couldNot("an unknown error; please report it with the command that caused it");
  }
}

}  // namespace

CLI::App& addCommand(CommandLine& line, const std::string& name, const std::string& summary,
                     const std::string& example, std::function<int()> run) {
  CLI::App* command = line.app.add_subcommand(name, summary);
  command->footer("Example:\n  " + example);
  // Only notes the choice: the command runs after the whole command line is parsed.
  command->callback([&line, run = std::move(run)] { line.run = run; });
  return *command;
}

void addJsonOption(CLI::App& command, std::string& file) {
  command.add_option("--json", file, "write the results to this file as JSON")->type_name("FILE");
}

}  // namespace vps::viewer

int main(int argc, char** argv) {
  return vps::viewer::runSafely(argc, argv);
}
