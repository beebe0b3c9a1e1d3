// SPDX-License-Identifier: BSD-3-Clause
// The time limit of reading names the work; reading ends at any call of the callback, and a bad file is found
// first.
#include "vps_scenes/cad/time_limit.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "support/stl_box.h"
#include "support/stop_at.h"
#include "support/temporary_folder.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {
namespace {

std::string messageOfLimited(const std::function<void()>& work) {
  try {
    work();
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(TimeLimit, TheMessageNamesTheFileTheWorkAndTheShareDone) {
  int calls = 0;
  const Progress count = [&](std::string_view, double) { ++calls; };
  TimeLimit limit{60};
  const Progress in_time = withTimeLimit(count, limit, "a.step");
  EXPECT_NO_THROW(in_time("meshing", 0.5));
  limit.begun -= std::chrono::seconds(61);
  const Progress late = withTimeLimit(count, limit, "a.step");
  EXPECT_EQ(messageOfLimited([&] { late("meshing", 0.4); }),
            "a.step: took more than 60 s to read (meshing, 40 % done); export fewer parts into one file, or "
            "read STEP "
            "and IGES with a greater deflection");
  EXPECT_EQ(calls, 2);
  EXPECT_FALSE(withTimeLimit({}, {0}, "a.step")) << "without limit and callback there is nothing to call";
}

TEST(TimeLimit, ABadFileIsFoundBeforeAnyFileIsRead) {
  const test::TemporaryFolder folder;
  const std::string good = (folder.path() / "good.stl").string(),
                    empty = (folder.path() / "empty.stl").string();
  test::write(good, stlBox(Vec3(1, 1, 1)));
  test::write(empty, "");
  ImportSettings settings;
  settings.unit_m = 1e-3;
  int calls = 0;
  const Progress progress = [&](std::string_view, double) { ++calls; };
  EXPECT_EQ(messageOfLimited([&] {
              importCad(std::vector<std::string>{good, empty}, settings, progress);
            }),
            empty + ": is empty; export it again");
  EXPECT_EQ(calls, 0) << "the first file was read";
  settings.unit_m.reset();
  EXPECT_NE(messageOfLimited([&] {
              importCad(std::vector<std::string>{good, good}, settings, progress);
            }).find("do not state their unit"),
            std::string::npos);
  EXPECT_EQ(calls, 0);
}

TEST(TimeLimit, ReadingEndsAtAnyCall) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "box.stl").string();
  test::write(file, stlBox(Vec3(1, 1, 1)));
  ImportSettings settings;
  settings.unit_m = 1e-3;
  EXPECT_GT(test::stopAtEveryCall([&](const Progress& progress) { importCad(file, settings, progress); }), 2);
}

}  // namespace
}  // namespace vps::scenes
