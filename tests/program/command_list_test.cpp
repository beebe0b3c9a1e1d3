// SPDX-License-Identifier: BSD-3-Clause
// Every row of viewer/cli/commands/command_list.inc is a command with help, and a row of the table in
// COMMANDS.md. To write that table again after a change:
//   VPS_WRITE_DOCUMENTATION=1 build/release/tests/test_program --gtest_filter='CommandTable.*'
#include <cstdlib>

#include "program.h"

namespace vps {
namespace {

struct CommandRow {
  std::string name, summary, example;
};

const CommandRow kCommands[] = {
#define COMMAND(add, name, summary, example) {name, summary, example},
#include "cli/commands/command_list.inc"
#undef COMMAND
};

TEST_F(Program, EveryCommandHasHelpWithAnExample) {
  const std::string overview = run("--help").out;
  for (const CommandRow& command : kCommands) {
    const Ran ran = run(command.name + " --help");
    EXPECT_EQ(ran.status, 0) << command.name;
    EXPECT_EQ(ran.err, "") << command.name;
    EXPECT_TRUE(command.example.starts_with("vps " + command.name + " ")) << command.example;
    EXPECT_NE(ran.out.find("Example:\n  " + command.example), std::string::npos) << ran.out;
    EXPECT_NE(overview.find(command.name), std::string::npos) << overview;
  }
  for (const char* status : {"0 done", "1 done, but", "2 not done", "3 not shown"})
    EXPECT_NE(overview.find(status), std::string::npos) << overview;
  EXPECT_EQ(run("--version").status, 0);
}

TEST(CommandTable, InTheDocumentationIsMadeFromTheRowsOfTheCommandList) {
  const fs::path file = fs::path(VPS_SOURCE_DIR) / "viewer/cli/COMMANDS.md";
  std::string text = slurp(file);
  const std::string begin = "<!-- commands -->\n";
  const std::size_t at = text.find(begin);
  ASSERT_NE(at, std::string::npos);
  const std::size_t from = at + begin.size(), until = text.find("<!-- end -->", from);
  ASSERT_NE(until, std::string::npos);
  std::string table = "| command | what it does | example |\n|---|---|---|\n";
  for (const CommandRow& command : kCommands)
    table += "| `" + command.name + "` | " + command.summary + " | `" + command.example + "` |\n";
  if (std::getenv("VPS_WRITE_DOCUMENTATION") == nullptr) {
    EXPECT_EQ(text.substr(from, until - from), table);
    return;
  }
  text.replace(from, until - from, table);
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace
}  // namespace vps
