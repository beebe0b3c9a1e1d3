// SPDX-License-Identifier: BSD-3-Clause
// Reports as PDF, as the program prints them.
#include "program.h"

namespace vps {
namespace {

bool hasChromium() {
  return fs::exists("/usr/bin/chromium");
}

TEST_F(Program, ThePageOfACheckIsPrintedAsPdf) {
  if (!hasChromium()) GTEST_SKIP() << "chromium is not installed";
  const Ran ran = run("check scene.toml --pdf check.pdf");
  EXPECT_EQ(ran.status, 0) << "the pin is 0.1 mm above the plate\n" << ran.err;
  const std::string bytes = slurp(folder_ / "check.pdf");
  EXPECT_TRUE(bytes.starts_with("%PDF-"));
  EXPECT_GT(bytes.size(), 5000U) << "a page with tables and a picture";
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().filename().string().find(".unfinished"), std::string::npos) << entry.path();
}

TEST_F(Program, WithoutChromiumPdfIsRefusedBeforeTheWork) {
  // No program is found in this PATH.
  const std::string command =
      "cd '" + folder_.string() + "' && PATH=/nowhere '" VPS_PROGRAM "' check scene.toml --pdf check.pdf";
  EXPECT_NE(std::system((command + " >out.txt 2>err.txt").c_str()), 0);
  const std::string said = slurp(folder_ / "err.txt");
  EXPECT_NE(said.find("--pdf needs Chromium (Debian: apt install chromium)"), std::string::npos) << said;
  EXPECT_EQ(slurp(folder_ / "out.txt"), "");
  EXPECT_FALSE(fs::exists(folder_ / "check.pdf"));
}

TEST_F(Program, APdfThatCannotBePrintedIsSaidAndLosesNothing) {
  // A browser that fails.
  fs::create_directories(folder_ / "bin");
  write("bin/chromium", "#!/bin/sh\necho no display >&2\nexit 1\n");
  fs::permissions(folder_ / "bin/chromium", fs::perms::owner_all);
  const std::string command = "cd '" + folder_.string() +
                              "' && PATH=\"$PWD/bin\" '" VPS_PROGRAM
                              "' check scene.toml --pdf check.pdf --html check.html >out.txt 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
  const std::string said = slurp(folder_ / "err.txt");
  EXPECT_NE(said.find("check.pdf"), std::string::npos) << said;
  EXPECT_NE(said.find("chromium failed: no display"), std::string::npos) << said;
  EXPECT_FALSE(fs::exists(folder_ / "check.pdf"));
  EXPECT_TRUE(fs::exists(folder_ / "check.html"));
  EXPECT_NE(slurp(folder_ / "out.txt"), "") << "the answer is printed";
}

}  // namespace
}  // namespace vps
